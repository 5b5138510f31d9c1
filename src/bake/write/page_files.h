// Lightmap pages as OpenEXR files with named channels.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "io/write_image.h"
#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"

namespace lobelia {

inline constexpr std::array k_precision_names = {"half", "float"};

/// The channels of a page's file: the layout's planes, then validity, chart, and the shading normal N.x, N.y, N.z. The
/// file sorts them by name.
[[nodiscard]] std::vector<std::string> page_channel_names(const PageChannels& channels);

/// `normals`: of each texel, in the world; zero where nothing was baked. All has the precision asked for but charts,
/// which are whole numbers in float32 (an error above 2^24).
[[nodiscard]] Status write_page(StagedFile& file, const LightmapPage& page, const PageChannels& channels,
                                std::span<const Vec3> normals, const ExrOptions& options = {});

/// A page as it was written, and its normals, of unit length again.
struct PageContent {
    LightmapPage page;
    std::vector<Vec3> normals;
};

/// Of the size of `width` x `height` texels and no other. Every value is finite, charts are whole numbers, validities
/// lie in [0, 1].
[[nodiscard]] Result<PageContent> read_page(const std::filesystem::path& path, const PageChannels& channels,
                                            std::size_t width, std::size_t height);

}  // namespace lobelia
