#include "bake/write/probe_textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/math/octahedral_map.h"
#include "core/storage/layout_text.h"
#include "io/texture/container.h"
#include "lobelia/codec.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

/// The largest side of a 2D texture that all devices have.
constexpr std::size_t k_most_side = 16384;

/// Planes of coefficients whose rows are those of all layers, one below the other.
std::vector<std::vector<float>> planes_of(const ProbeSet& probes) {
    const std::size_t n = probes.coefficients_per_probe;
    std::vector<std::vector<float>> planes(3 * n, std::vector<float>(probes.size()));
    for (std::size_t i = 0; i < probes.size(); ++i)
        for (std::size_t p = 0; p < planes.size(); ++p) planes[p][i] = (&probes.coefficients[i * n].r)[p];
    return planes;
}

TextureFile volume(const ProbeGrid& grid, PixelFormat format, const TextureOptions& options) {
    TextureFile file{format, grid.count[0], grid.count[1]};
    file.depth = grid.count[2];
    file.compressed = options.zstd == Switch::on;
    return file;
}

Status add_coefficients(FilesTogether& files, const ProbeSet& probes, const TextureOptions& options,
                        const TextureContainer& container) {
    const Codec codec = make_codec(probes.codec).value();
    const CoefficientTraits traits = coefficient_traits(*codec.encoder());
    const auto planes = planes_of(probes);
    const auto [nx, ny, nz] = probes.grid->count;
    for (const std::string& name : options.storages.value_or(std::vector<std::string>{"float16"})) {
        const auto storage = find_storage(name);
        if (!storage) return storage.error();
        if (!suits(**storage, traits) || shares_texels((*storage)->layout(traits))) continue;
        const auto take = [&](const TextureLayout::Texture& layout, const PackedTexture& packed) {
            TextureFile file = volume(*probes.grid, packed.format, options);
            file.levels = {packed.data};
            file.metadata = {{"lobelia.storage", name},
                             {"lobelia.format", std::string(info(layout.format).name)},
                             {"lobelia.channels", channels_text(layout)},
                             {"lobelia.scale", fmt::format("{}", packed.scale)},
                             {"lobelia.origin", probes.codec + ", world frame"}};
            return files.add(fmt::format("probes.{}.{}.{}", name, layout.name, container.name),
                             [&](StagedFile& staged) { return write_texture(container, staged, file); });
        };
        const CoefficientPlanes page(nx, std::size_t{ny} * nz, std::span(planes), traits.count);
        if (Status status = pack_each((*storage)->layout(traits), page, take, files.stop().flag()); !status)
            return status;
    }
    return Done{};
}

Status add_validity(FilesTogether& files, const ProbeSet& probes, const TextureOptions& options,
                    const TextureContainer& container) {
    std::vector<std::byte> bytes(probes.size());
    const float* validity = probes.validity.data();
    encode_texels(PixelFormat::r8, probes.size(), 1, {&validity, 1}, bytes);
    TextureFile file = volume(*probes.grid, PixelFormat::r8, options);
    file.levels = {bytes};
    file.metadata = {{"lobelia.channels", "validity"}};
    return files.add(fmt::format("probes.validity.{}", container.name),
                     [&](StagedFile& staged) { return write_texture(container, staged, file); });
}

Status add_visibility(FilesTogether& files, const ProbeSet& probes, const TextureOptions& options,
                      const TextureContainer& container) {
    const std::size_t side = probes.visibility_side, tile = side + 2;
    const auto [nx, ny, nz] = probes.grid->count;
    const std::size_t width = tile * nx, height = tile * ny * nz;
    if (side == 0 || std::max(width, height) > k_most_side) return Done{};
    std::array<std::vector<float>, 2> moments = {std::vector<float>(width * height),
                                                 std::vector<float>(width * height)};
    for (std::size_t i = 0; i < width * height; ++i) {
        const std::size_t x = i % width, y = i / width, probe = x / tile + nx * (y / tile);
        const std::size_t texel =
            OctahedralMap{side}.index_at(static_cast<int>(x % tile) - 1, static_cast<int>(y % tile) - 1);
        for (std::size_t k = 0; k < 2; ++k) moments[k][i] = probes.visibility[probe * side * side + texel][k];
    }
    const std::array<const float*, 2> channels = {moments[0].data(), moments[1].data()};
    std::vector<std::byte> bytes(byte_size(PixelFormat::rg16f, width, height));
    encode_texels(PixelFormat::rg16f, width, height, channels, bytes);
    TextureFile file{PixelFormat::rg16f, width, height};
    file.levels = {bytes};
    file.compressed = options.zstd == Switch::on;
    file.metadata = {{"lobelia.channels", "mean distance\nmean squared distance"}};
    return files.add(fmt::format("probes.visibility.{}", container.name),
                     [&](StagedFile& staged) { return write_texture(container, staged, file); });
}

}  // namespace

Status add_probe_textures(FilesTogether& files, const ProbeSet& probes, const TextureOptions& options) {
    if (!probes.grid || (options.storages && options.storages->empty())) return Done{};
    const auto container = find_texture_container(options.container);
    if (!container) return container.error();
    auto status = add_coefficients(files, probes, options, **container);
    if (status) status = add_validity(files, probes, options, **container);
    if (status) status = add_visibility(files, probes, options, **container);
    return status;
}

}  // namespace lobelia
