// Every codec through every finishing step: the irradiance that its coefficients give still agrees with the irradiance
// that the paths measured, which takes the same steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/solve/page_irradiance.h"
#include "lobelia/bake.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

/// RMS of E by the codec minus E by the paths at the normals of valid texels, over the mean of E.
double codec_error(const Bake& bake) {
    const auto codec = *make_codec(bake.manifest.options.codec);
    const PageChannels channels = bake.channels();
    double squared = 0, sum = 0, count = 0;
    for (std::size_t p = 0; p < bake.pages.size(); ++p) {
        const LightmapPage& page = bake.pages[p];
        const auto by_codec =
            page_irradiance(page, channels, bake.normals[p], bake.manifest.options.frame, codec.evaluator());
        for (std::size_t i = 0; i < page.size(); ++i) {
            if (page.chart[i] == 0 || page.validity[i] < 0.5f) continue;
            const auto plane = [&](std::size_t k) { return page.planes[channels.irradiance(k)][i]; };
            const Rgb by_paths{plane(0), plane(1), plane(2)};
            const double off = luminance(by_codec[i] - by_paths);
            squared += off * off;
            sum += luminance(by_paths);
            ++count;
        }
    }
    return std::sqrt(squared / count) / (sum / count);
}

Bake finished(const std::string& codec, const FinishOptions& steps) {
    static const Scene scene = cornell_scene();
    BakeJob job;
    job.bake.codec = codec;
    job.bake.atlas.width = job.bake.atlas.height = 32;
    job.bake.samples = 32;
    job.bake.paths.bounces = 3;
    job.finish = steps;
    job.textures.storages.emplace();
    BakeSession session;
    auto result = bake(scene, job, session);
    EXPECT_TRUE(result) << codec << ": " << result.error().message;
    return *std::move(result);
}

/// One codec of each basis: an encoder of moments where there is one, and the most accurate evaluator. Running averages
/// are left out: they cannot hold direct light, which arrives from single directions.
std::vector<std::string> one_codec_of_each_basis() {
    std::vector<std::string> codecs;
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        if (basis->size() > 25) continue;
        const auto encoders = encoder_names(*basis);
        if (std::find(encoders.begin(), encoders.end(), "moments") == encoders.end()) continue;
        codecs.push_back(name + "/moments/" + basis->evaluator_names().back());
    }
    return codecs;
}

TEST(Finish, KeepsWhatEveryCodecSaysOfTheIrradiance) {
    constexpr Switch on = Switch::on, off = Switch::off;
    const auto codecs = one_codec_of_each_basis();
    EXPECT_GT(codecs.size(), 12u);
    for (const auto& codec : codecs) {
        const double solved = codec_error(finished(codec, {off, off, off}));
        // Each step averages coefficients and irradiance alike, so that the error of their averages is no larger; the
        // denoiser filters ratios to the brightness, which costs half a percent.
        const double denoised = codec_error(finished(codec, {on, off, off})),
                     all = codec_error(finished(codec, {on, on, on}));
        EXPECT_LT(denoised, solved + 0.006) << codec;
        EXPECT_LT(all, solved + 0.006) << codec;
    }
}

}  // namespace
}  // namespace lobelia
