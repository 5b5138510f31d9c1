// The table of reflection lobes as a texture.
#include "bake/write/ggx_table_file.h"

#include "core/math/half.h"
#include "lobelia/specular.h"

namespace lobelia {

Status write_ggx_table(const TextureContainer& container, StagedFile& file) {
    const SpecularTable table = ggx_table();
    std::vector<std::uint16_t> halves;
    for (const float value : table.texels) halves.push_back(half_from_float(value));
    TextureFile texture{PixelFormat::rgba16f, table.width, table.height};
    texture.layers = table.layers;
    texture.levels = {std::as_bytes(std::span(halves))};
    texture.metadata = {{"lobelia.channels", "GGX lobes by n.v and alpha, for specular() of lobelia shader"}};
    return write_texture(container, file, texture);
}

Result<StagedFile> stage_ggx_table(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    const auto container = find_texture_container(extension.substr(std::min<std::size_t>(1, extension.size())));
    if (!container) return Error{path.string() + ": " + container.error().message};
    auto file = StagedFile::create(path);
    if (!file) return file;
    Status status = write_ggx_table(**container, *file);
    if (status) status = file->flush();
    if (!status) return status.error();
    return file;
}

}  // namespace lobelia
