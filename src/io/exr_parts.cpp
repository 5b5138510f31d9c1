// What the readers of OpenEXR files ask about a part before they allocate for it.
#include "io/exr_parts.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>

#include <algorithm>

#include "io/image_checks.h"

namespace lobelia::io {

namespace {

std::int64_t lines_per_chunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
        case Imf::RLE_COMPRESSION:
        case Imf::ZIPS_COMPRESSION:
            return 1;
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 16;
        case Imf::DWAB_COMPRESSION:
            return 256;
        default:
            return 32;
    }
}

/// How many samples OpenEXR buffers at once for a part.
std::int64_t buffered_samples(const Imf::Header& header) {
    std::int64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) ++channels;
    const std::int64_t width = size_of(header).width;
    if (!header.hasTileDescription()) return width * lines_per_chunk(header.compression()) * channels;
    // Tiles are buffered by rows, whole at the right edge.
    const Imf::TileDescription& tile = header.tileDescription();
    return (width + tile.xSize) * tile.ySize * channels;
}

}  // namespace

ExrSize size_of(const Imf::Header& header) {
    const auto& window = header.dataWindow();
    return {std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1};
}

bool is_deep(const Imf::Header& header) {
    return header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE);
}

Status check_part(const Imf::Header& header, std::string_view name, std::uint64_t file_bytes, std::uint64_t channels,
                  const ReadOptions& options) {
    const ExrSize size = size_of(header);
    if (const Status status = check_size(name, size.width, size.height, options); !status) return status;
    constexpr std::size_t k_most_buffered = std::size_t{1} << 28, k_always = std::size_t{1} << 20;
    const auto most_buffered = static_cast<std::int64_t>(
        std::min(k_most_buffered, k_always + 4 * std::min(options.most_pixels, k_most_buffered)));
    if (buffered_samples(header) > most_buffered)
        return Error{fmt::format("{}: one chunk of the image would take more than {} samples", name, most_buffered)};

    // DWA compresses best: 64 equal samples are two symbols of 16 bits, deflated at most 1032 : 1.
    constexpr std::uint64_t k_most_samples_per_byte = 64 * 1032 / 4;
    if (static_cast<std::uint64_t>(size.width * size.height) * channels / k_most_samples_per_byte > file_bytes)
        return Error{fmt::format("{}: {} bytes cannot hold {} x {} pixels", name, file_bytes, size.width, size.height)};
    return Done{};
}

Status check_sampling(const Imf::Header& header, const std::string& channel, std::string_view name, int rate) {
    const Imf::Channel* found = header.channels().findChannel(channel);
    if (found && (found->xSampling != rate || found->ySampling != rate))
        return Error{fmt::format("{}: channel {} is sampled at 1/{} x 1/{}; 1/{} was expected", name, channel,
                                 found->xSampling, found->ySampling, rate)};
    return Done{};
}

}  // namespace lobelia::io
