// Checks of OpenEXR files before OpenEXR parses their headers and before it allocates memory for their pixels.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <fmt/format.h>

#include "io/exr_stream.h"
#include "io/read_image.h"

namespace lobelia::io {

/// The headers of a file as a whole.
struct ExrHeaders {
    std::uint64_t end = 0;  ///< where they end and the tables of offsets begin
    bool multi_part = false;
};

/// Walks the attributes of every part without OpenEXR, which allocates whatever they ask for. Refuses attributes that
/// do not match their stated sizes or exceed the file, windows and tiles beyond the limits of `options`, and more than
/// `most_channels` channels. Leaves `in` at its beginning.
[[nodiscard]] Result<ExrHeaders> check_exr_headers(ExrInput& in, std::string_view name, const ReadOptions& options,
                                                   std::size_t most_channels = 256);

/// An error if OpenEXR would buffer more than is reasonable for an image of options.most_pixels, if data window or
/// display window exceed that or do not overlap, or if `file_bytes` cannot hold `channels` channels of the data window
/// at the best compression.
[[nodiscard]] Status check_part(const Imf::Header& header, std::string_view name, std::uint64_t file_bytes,
                                std::uint64_t channels, const ReadOptions& options);

/// An error if the channel exists and is not sampled at 1 / `rate` in both directions.
[[nodiscard]] Status check_sampling(const Imf::Header& header, const std::string& channel, std::string_view name,
                                    int rate);

/// Number of scan lines that are compressed together.
[[nodiscard]] std::int64_t lines_per_chunk(Imf::Compression compression);

[[nodiscard]] bool is_deep(const Imf::Header& header);

/// Returns the result of `decode()`, or an error for what OpenEXR throws there: a fault of the file.
template <class Decode>
auto without_exceptions(ExrInput& in, std::string_view name, const Decode& decode) -> decltype(decode()) {
    try {
        return decode();
    } catch (const std::exception& error) {
        return Error{fmt::format("{}: damaged or incomplete OpenEXR: {} (near byte {} of {})", name, error.what(),
                                 in.tellg(), in.size())};
    }
}

}  // namespace lobelia::io
