// DDS files: a header of 124 bytes, one of 20 for Direct3D 10, and the texels.
#include "io/texture/dds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/texture/bytes.h"

namespace lobelia {
namespace {

/// DXGI_FORMAT of each VkFormat that pixel formats have.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 13> k_dxgi_formats = {{
    {9, 61},    // R8_UNORM
    {16, 49},   // R8G8_UNORM
    {37, 28},   // R8G8B8A8_UNORM
    {64, 24},   // R10G10B10A2_UNORM
    {76, 54},   // R16_FLOAT
    {83, 34},   // R16G16_FLOAT
    {97, 10},   // R16G16B16A16_FLOAT
    {100, 41},  // R32_FLOAT
    {103, 16},  // R32G32_FLOAT
    {109, 2},   // R32G32B32A32_FLOAT
    {123, 67},  // R9G9B9E5_SHAREDEXP
    {143, 95},  // BC6H_UF16
    {144, 96},  // BC6H_SF16
}};

Bytes header(const TextureFile& texture, std::uint32_t dxgi_format) {
    // Flags of the header: what it states, which is required but for the pitch or the size of all blocks.
    constexpr std::uint32_t k_caps_height_width_format = 0x1 | 0x2 | 0x4 | 0x1000, k_pitch = 0x8,
                            k_linear_size = 0x80000, k_levels = 0x20000, k_depth = 0x800000;
    constexpr std::uint32_t k_four_characters = 0x4, k_texture = 0x1000, k_complex = 0x8, k_mipmap = 0x400000;
    constexpr std::uint32_t k_all_cube_faces = 0xfe00, k_volume = 0x200000;
    constexpr std::uint32_t k_2d = 3, k_3d = 4, k_cube = 0x4, k_straight_alpha = 1;
    const FormatInfo& format = info(texture.format);
    const bool blocks = format.block > 1, is_cube = texture.faces == 6, is_3d = texture.depth > 0;
    const bool has_levels = texture.levels.size() > 1;
    Bytes bytes;
    bytes.text("DDS ");
    bytes.u32(124);
    bytes.u32(k_caps_height_width_format | (blocks ? k_linear_size : k_pitch) | (has_levels ? k_levels : 0) |
              (is_3d ? k_depth : 0));
    bytes.u32(texture.height);
    bytes.u32(texture.width);
    bytes.u32(blocks ? byte_size(texture.format, texture.width, texture.height) : texture.width * format.block_bytes);
    bytes.u32(texture.depth);
    bytes.u32(has_levels ? texture.levels.size() : 0);
    for (int i = 0; i < 11; ++i) bytes.u32(0);  // reserved
    bytes.u32(32);                              // the pixel format: see the header of Direct3D 10
    bytes.u32(k_four_characters);
    bytes.text("DX10");
    for (int i = 0; i < 5; ++i) bytes.u32(0);
    bytes.u32(k_texture | (has_levels ? k_complex | k_mipmap : 0) | (is_cube || is_3d ? k_complex : 0));
    bytes.u32(is_cube ? k_all_cube_faces : is_3d ? k_volume : 0);
    for (int i = 0; i < 3; ++i) bytes.u32(0);

    // The header of Direct3D 10.
    bytes.u32(dxgi_format);
    bytes.u32(is_3d ? k_3d : k_2d);
    bytes.u32(is_cube ? k_cube : 0);
    bytes.u32(std::max<std::size_t>(texture.layers, 1));
    bytes.u32(k_straight_alpha);
    return bytes;
}

}  // namespace

Status write_dds(StagedFile& file, const TextureFile& texture) {
    const FormatInfo& format = info(texture.format);
    const auto entry = std::find_if(k_dxgi_formats.begin(), k_dxgi_formats.end(),
                                    [&](const auto& pair) { return pair.first == format.vk_format; });
    if (entry == k_dxgi_formats.end())
        return Error{fmt::format("DDS has no number for the pixel format {}", format.name)};
    if (auto status = file.write(header(texture, entry->second).data()); !status) return status;

    // Image after image, each with all its levels; a container of KTX 2 has it the other way round.
    for (std::size_t image = 0; image < texture.images(); ++image)
        for (std::size_t level = 0; level < texture.levels.size(); ++level) {
            const std::size_t size = image_bytes(texture, level);
            if (auto status = file.write(texture.levels[level].subspan(image * size, size)); !status) return status;
        }
    return Done{};
}

}  // namespace lobelia
