// Evaluates a bake's irradiance, texel by texel.
#include "bake/write/irradiance_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/solve/page_irradiance.h"
#include "bake/write/files_together.h"
#include "io/write_image.h"

namespace lobelia {
namespace {

Status write_page_irradiance(StagedFile& file, const LightmapPage& page, std::span<const Vec3> normals,
                             std::span<const Rgb> irradiance) {
    const auto is_finite = [](Rgb e) { return std::isfinite(e.r) && std::isfinite(e.g) && std::isfinite(e.b); };
    if (!std::all_of(irradiance.begin(), irradiance.end(), is_finite))
        return Error{"the irradiance of a texel is not finite: its coefficients are too large for float32"};
    std::vector<float> validity(page.size());
    for (std::size_t i = 0; i < page.size(); ++i)
        if (!(normals[i] == Vec3{})) validity[i] = page.validity[i];
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const std::span floats(&irradiance[0].r, 3 * irradiance.size());
    const std::vector<ExrChannel> channels{
        {"R", floats, 3}, {"G", floats.subspan(1), 3}, {"B", floats.subspan(2), 3}, {"validity", validity}};
    return write_exr(file, page.width, page.height, channels);
}

/// The irradiance planes.
std::vector<Rgb> plain_irradiance(const LightmapPage& page, const PageChannels& channels) {
    std::vector<Rgb> result(page.size());
    for (std::size_t i = 0; i < page.size(); ++i)
        result[i] = {page.planes[channels.irradiance(0)][i], page.planes[channels.irradiance(1)][i],
                     page.planes[channels.irradiance(2)][i]};
    return result;
}

}  // namespace

Result<std::vector<std::filesystem::path>> write_irradiance(const std::filesystem::path& folder, const Bake& bake,
                                                            const IrradianceOptions& options) {
    // Find the reading; without a codec, irradiance is there as it is.
    std::shared_ptr<const Evaluator> evaluator;
    if (const std::string& name = bake.manifest.options.codec; !name.empty()) {
        const auto codec = make_codec(name);
        if (!codec) return codec.error();
        auto made =
            make_evaluator(options.evaluator.empty() ? codec->name().evaluator : options.evaluator, codec->basis());
        if (!made) return made.error();
        evaluator = std::move(*made);
    } else if (!options.evaluator.empty()) {
        return Error{"--evaluator: this bake holds irradiance only and has no coefficients to evaluate"};
    }

    // Write it for each page.
    auto files = FilesTogether::in(folder);
    if (!files) return files.error();
    std::vector<std::filesystem::path> paths;
    for (std::size_t i = 0; i < bake.pages.size(); ++i) {
        const auto irradiance = evaluator ? page_irradiance(bake.pages[i], bake.channels(), bake.normals[i],
                                                            bake.manifest.options.frame, *evaluator)
                                          : plain_irradiance(bake.pages[i], bake.channels());
        const std::string& file_name = bake.manifest.pages[i].file;
        paths.push_back(folder / file_name);
        auto status = files->add(file_name, [&](StagedFile& file) {
            return write_page_irradiance(file, bake.pages[i], bake.normals[i], irradiance);
        });
        if (!status) return status.error();
    }
    if (auto status = files->commit(); !status) return status.error();
    return paths;
}

}  // namespace lobelia
