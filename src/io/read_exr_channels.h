// Any float channels of an OpenEXR file by name: lightmap pages and other images without colours. Safe on any bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

struct ReadChannelsOptions {
    /// The channels to read, in this order; an error if one is missing. Empty: all, sorted by name.
    std::vector<std::string> wanted = {};
    /// Limits; larger files are refused before anything is allocated for them.
    std::size_t most_pixels = std::size_t{1} << 28;
    std::size_t most_channels = 4096;
    std::size_t most_values = std::size_t{1} << 31;  ///< pixels times channels that are read
};

/// Planes of width * height floats, row by row from the top left. Any float may occur, NaN included.
struct ExrPlanes {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::string> names;
    std::vector<std::vector<float>> planes;
};

/// Reads channels of the first part, of halves, floats or whole numbers, as floats; scan lines or tiles (level 0). The
/// planes cover the display window; pixels outside the data window are 0. Errors name the file and the channel or
/// place.
[[nodiscard]] Result<ExrPlanes> read_exr_channels(const std::filesystem::path& path,
                                                  const ReadChannelsOptions& options = {});
[[nodiscard]] Result<ExrPlanes> read_exr_channels(std::span<const std::byte> bytes, std::string_view name,
                                                  const ReadChannelsOptions& options = {});

}  // namespace lobelia
