// Lengths of decoded OpenEXR chunks, after "The OpenEXR File Layout" (openexr.com).
#include "io/exr_chunks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "io/exr_windows.h"

namespace lobelia::io {
namespace {

using Bytes = std::span<const unsigned char>;

/// Multiples of `rate` in [begin, end).
std::int64_t samples_within(std::int64_t begin, std::int64_t end, int rate) {
    const auto before = [rate](std::int64_t x) { return x >= 0 ? (x + rate - 1) / rate : -(-x / rate); };
    return before(end) - before(begin);
}

/// Bytes of the pixels of a rectangle.
std::size_t bytes_of(const Imf::ChannelList& channels, const ExrWindow& area) {
    std::int64_t bytes = 0;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        const Imf::Channel& channel = c.channel();
        bytes += samples_within(area.left, area.right, channel.xSampling) *
                 samples_within(area.top, area.bottom, channel.ySampling) * (channel.type == Imf::HALF ? 2 : 4);
    }
    return static_cast<std::size_t>(bytes);
}

/// Number of bytes that runs decode to; those of a damaged one, up to where it ends.
std::size_t run_length(Bytes data) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < data.size();) {
        const auto count = static_cast<signed char>(data[i]);
        const std::size_t length = count < 0 ? static_cast<std::size_t>(-count) : static_cast<std::size_t>(count) + 1;
        const std::size_t stored = count < 0 ? length : 1;
        if (i + 1 + stored > data.size()) break;
        total += length;
        i += 1 + stored;
    }
    return total;
}

/// Number of bytes that a deflated chunk inflates to, at most one more than `expected`.
class Inflater {
  public:
    Inflater() { ready_ = inflateInit(&stream_) == Z_OK; }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    std::size_t length(Bytes data, std::size_t expected) {
        if (!ready_ || inflateReset(&stream_) != Z_OK) return 0;
        stream_.next_in = const_cast<unsigned char*>(data.data());  // NOLINT: zlib does not write to it
        stream_.avail_in = static_cast<uInt>(data.size());
        int result = Z_OK;
        while (result == Z_OK && stream_.total_out <= expected) {
            stream_.next_out = buffer_->data();
            stream_.avail_out = static_cast<uInt>(buffer_->size());
            result = inflate(&stream_, Z_NO_FLUSH);
        }
        return stream_.total_out;
    }

  private:
    z_stream stream_{};
    bool ready_ = false;
    std::unique_ptr<std::array<unsigned char, 1 << 16>> buffer_ =
        std::make_unique<std::array<unsigned char, 1 << 16>>();
};

class Checker {
  public:
    Checker(const Imf::Header& header, std::string_view name)
        : channels_(header.channels()), compression_(header.compression()), name_(name) {}

    /// Compares the length of a chunk with that of its pixels. Chunks that compression does not make smaller are stored
    /// as they are.
    Status check(const ExrWindow& area, std::span<const char> data, const std::string& place) {
        const std::size_t expected = bytes_of(channels_, area);
        const Bytes bytes(reinterpret_cast<const unsigned char*>(data.data()), data.size());
        const std::size_t length = bytes.size() >= expected ? bytes.size() : decoded(bytes, expected);
        if (length == expected) return Done{};
        return Error{fmt::format("{}: damaged OpenEXR: {} holds {} bytes of pixels, not {}", name_, place,
                                 length > expected ? "more" : std::to_string(length), expected)};
    }

  private:
    /// OpenEXR itself compares lengths for the other compressions, but for chunks of no bytes at all.
    std::size_t decoded(Bytes bytes, std::size_t expected) {
        switch (compression_) {
            case Imf::NO_COMPRESSION:
                return bytes.size();
            case Imf::RLE_COMPRESSION:
                return run_length(bytes);
            case Imf::ZIPS_COMPRESSION:
            case Imf::ZIP_COMPRESSION:
                return inflater_.length(bytes, expected);
            default:
                return bytes.empty() ? 0 : expected;
        }
    }

    const Imf::ChannelList& channels_;
    Imf::Compression compression_;
    std::string_view name_;
    Inflater inflater_;
};

Status check_scan_lines(Imf::InputPart& part, Checker& checker) {
    const ExrWindow data = data_window(part.header());
    const std::int64_t lines = lines_per_chunk(part.header().compression());
    for (std::int64_t top = data.top; top < data.bottom; top += lines) {
        const char* bytes = nullptr;
        int size = 0;
        part.rawPixelData(static_cast<int>(top), bytes, size);
        const ExrWindow area{data.left, top, data.right, std::min(top + lines, data.bottom)};
        const std::span data_of(bytes, static_cast<std::size_t>(std::max(size, 0)));
        if (Status status = checker.check(area, data_of, fmt::format("scan line {}", top)); !status) return status;
    }
    return Done{};
}

/// Gives the stored bytes of the tiles of full resolution.
class TileReader {
  public:
    TileReader(ExrInput& in, const ExrHeaders& headers, Imf::InputPart& part, int columns)
        : in_(in), headers_(headers), part_(part), columns_(columns) {}

    std::span<const char> tile(int x, int y) {
        if (!headers_.multi_part) return at_offset(x, y);
        const char* bytes = nullptr;
        int size = 0, level_x = 0, level_y = 0;
        part_.rawTileData(x, y, level_x, level_y, bytes, size);
        return {bytes, static_cast<std::size_t>(std::max(size, 0))};
    }

  private:
    /// In files of one part rawTileData() gives whatever tile comes next, and not the one that pixels are read from.
    std::span<const char> at_offset(int x, int y) {
        in_.seekg(headers_.end + 8 * (static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(columns_) +
                                      static_cast<std::uint64_t>(x)));
        const std::uint64_t offset = number(8);
        in_.seekg(offset);
        for (int i = 0; i < 4; ++i) number(4);  // OpenEXR checks column, row and level
        const std::uint64_t size = number(4);
        if (size > in_.size()) throw std::runtime_error("a tile is larger than the file");
        bytes_.resize(size);
        if (size > 0) in_.read(bytes_.data(), static_cast<int>(size));
        return bytes_;
    }
    std::uint64_t number(std::size_t bytes) {
        std::array<char, 8> stored{};
        in_.read(stored.data(), static_cast<int>(bytes));
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i)
            value |= static_cast<std::uint64_t>(static_cast<unsigned char>(stored[i])) << (8 * i);
        return value;
    }

    ExrInput& in_;
    const ExrHeaders& headers_;
    Imf::InputPart& part_;
    int columns_;
    std::vector<char> bytes_;
};

Status check_tiles(ExrInput& in, const ExrHeaders& headers, Imf::InputPart& part, Checker& checker) {
    const ExrWindow data = data_window(part.header());
    const Imf::TileDescription& tile = part.header().tileDescription();
    const std::int64_t width = tile.xSize, height = tile.ySize;
    const auto columns = static_cast<int>((data.width() + width - 1) / width);
    const auto rows = static_cast<int>((data.height() + height - 1) / height);
    TileReader reader(in, headers, part, columns);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const std::int64_t left = data.left + x * width, top = data.top + y * height;
            const ExrWindow area{left, top, std::min(left + width, data.right), std::min(top + height, data.bottom)};
            if (Status status = checker.check(area, reader.tile(x, y), fmt::format("tile ({}, {})", x, y)); !status)
                return status;
        }
    return Done{};
}

}  // namespace

Status check_chunks(ExrInput& in, const ExrHeaders& headers, Imf::InputPart& part, std::string_view name) {
    Checker checker(part.header(), name);
    if (!part.header().hasTileDescription()) return check_scan_lines(part, checker);
    // OpenEXR knows the position in the file and does not look again.
    const auto position = in.tellg();
    Status status = check_tiles(in, headers, part, checker);
    in.seekg(position);
    return status;
}

}  // namespace lobelia::io
