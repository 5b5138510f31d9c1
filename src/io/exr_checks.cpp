// Checks of OpenEXR files before OpenEXR sees them, after "The OpenEXR File Layout" (openexr.com).
#include "io/exr_checks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/exr_windows.h"
#include "io/image_checks.h"

namespace lobelia::io {

namespace {

constexpr std::size_t k_most_parts = 256, k_most_name = 255;
constexpr std::uint32_t k_tiled = 0x200, k_multi_part = 0x1000;

// Attribute types of fixed size. OpenEXR reads these without checking the size that the file states, so a wrong size
// would make it parse other attributes than this inspection does.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 24> k_fixed_sizes{{
    {"box2i", 16},
    {"box2f", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
}};

/// A fault of the file; caught in check_exr_headers.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Walker {
  public:
    Walker(ExrInput& in, std::string_view name, const ReadOptions& options, std::size_t most_channels)
        : in_(in), name_(name), options_(options), most_channels_(most_channels) {}

    ExrHeaders file() {
        if (u32() != 20000630) refuse("not an OpenEXR file");
        const std::uint32_t version = u32();
        if ((version & 0xff) != 2) refuse(fmt::format("OpenEXR file version {}, not 2", version & 0xff));
        tiled_ = (version & k_tiled) != 0;
        const bool multi_part = (version & k_multi_part) != 0;
        for (std::size_t parts = 0; part() && multi_part; ++parts)
            if (parts == k_most_parts) refuse(fmt::format("more than {} parts", k_most_parts));
        return {in_.tellg(), multi_part};
    }

  private:
    struct Attribute {
        std::string name, type;
        std::uint32_t size = 0;
    };

    [[noreturn]] void refuse(std::string_view problem) {
        throw Refusal(fmt::format("{}, at byte {}", problem, place_));
    }

    template <std::size_t N>
    std::array<char, N> bytes() {
        place_ = in_.tellg();
        std::array<char, N> result;
        in_.read(result.data(), N);
        return result;
    }
    std::uint32_t u32() {
        std::uint32_t value = 0;
        const std::array<char, 4> stored = bytes<4>();
        for (std::size_t i = 0; i < 4; ++i)
            value |= static_cast<std::uint32_t>(static_cast<unsigned char>(stored[i])) << (8 * i);
        return value;
    }
    std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
    std::string text() {
        std::string result;
        for (char c = bytes<1>()[0]; c != 0; c = bytes<1>()[0]) {
            if (result.size() == k_most_name) refuse("a name longer than 255 characters");
            result.push_back(c);
        }
        return result;
    }

    /// The attributes of one part; false for the empty header that ends a list of parts.
    bool part() {
        bool has_window = false, has_tiles = false, has_channels = false;
        for (bool first = true;; first = false) {
            Attribute attribute;
            attribute.name = text();
            if (attribute.name.empty()) {
                if (first) return false;
                if (!has_window || !has_channels) refuse("a part without dataWindow or channels");
                if (tiled_ && !has_tiles) refuse("a tiled part without tile description");
                return true;
            }
            attribute.type = text();
            attribute.size = u32();
            const std::uint64_t begin = in_.tellg();
            if (attribute.size > in_.size() - begin) refuse("an attribute larger than the rest of the file");
            check(attribute, begin + attribute.size);
            has_window |= attribute.name == "dataWindow";
            has_channels |= attribute.name == "channels";
            has_tiles |= attribute.name == "tiles";
            in_.seekg(static_cast<StreamPosition>(begin + attribute.size));
        }
    }

    void check(const Attribute& attribute, std::uint64_t end) {
        for (const auto& [type, size] : k_fixed_sizes)
            if (attribute.type == type && attribute.size != size)
                refuse(fmt::format("attribute of type {}: {} bytes instead of {}", type, attribute.size, size));
        if (attribute.name == "dataWindow" || attribute.name == "displayWindow") window(attribute);
        if (attribute.name == "tiles") tiles(attribute);
        if (attribute.name == "channels" && attribute.type != "chlist")
            refuse("the attribute channels is not a channel list");
        if (attribute.type == "chlist") channels(end);
        if (attribute.type == "preview") preview(attribute);
        if (attribute.type == "stringvector") strings(end);
        if (attribute.type == "floatvector" && attribute.size % 4 != 0)
            refuse("float vector: attribute size is not a multiple of 4");
        if (attribute.type == "idmanifest" && attribute.size < 8) refuse("ID manifest: shorter than 8 bytes");
    }

    void window(const Attribute& attribute) {
        if (attribute.type != "box2i") refuse(fmt::format("{} is not of type box2i", attribute.name));
        std::array<std::int64_t, 4> box{};
        for (std::int64_t& side : box) side = i32();
        // OpenEXR multiplies coordinates by bytes per pixel in 32 bits in places; far-off windows are of no use here.
        constexpr std::int64_t k_farthest = 1 << 24;
        if (std::any_of(box.begin(), box.end(), [](std::int64_t c) { return c < -k_farthest || c > k_farthest; }))
            refuse(fmt::format("{} has coordinates beyond 2^24", attribute.name));
        const Status status = check_size(name_, box[2] - box[0] + 1, box[3] - box[1] + 1, options_);
        if (!status) throw std::length_error(status.error().message);
    }

    void tiles(const Attribute& attribute) {
        if (attribute.type != "tiledesc") refuse("the attribute tiles is not a tile description");
        const Status status = check_size(name_, u32(), u32(), options_);
        if (!status) refuse("a tile size that is 0 or larger than the largest image");
    }

    void channels(std::uint64_t end) {
        std::size_t count = 0;
        while (!text().empty()) {
            if (++count > most_channels_) refuse(fmt::format("more than {} channels", most_channels_));
            bytes<8>();  // pixel type, linearity, padding
            if (i32() < 1 || i32() < 1) refuse("a channel with a sampling rate below 1");
        }
        if (in_.tellg() != end) refuse("channel list: attribute size does not match its contents");
    }

    void preview(const Attribute& attribute) {
        const std::uint64_t width = u32(), height = u32();
        if (width > 65536 || height > 65536 || 8 + 4 * width * height != attribute.size)
            refuse("preview image: attribute size does not match its contents");
    }

    void strings(std::uint64_t end) {
        while (in_.tellg() < end) {
            const std::uint32_t length = u32();
            if (in_.tellg() > end || length > end - in_.tellg()) refuse("a string larger than its list");
            in_.seekg(in_.tellg() + length);
        }
        if (in_.tellg() != end) refuse("list of strings: attribute size does not match its contents");
    }

    ExrInput& in_;
    std::string_view name_;
    const ReadOptions& options_;
    std::size_t most_channels_;
    bool tiled_ = false;
    std::uint64_t place_ = 0;
};

/// Number of samples that OpenEXR buffers at once for a part.
std::int64_t buffered_samples(const Imf::Header& header) {
    std::int64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) ++channels;
    const std::int64_t width = data_window(header).width();
    if (!header.hasTileDescription()) return width * lines_per_chunk(header.compression()) * channels;
    // Tiles are buffered by rows, whole at the right edge.
    const Imf::TileDescription& tile = header.tileDescription();
    return (width + tile.xSize) * tile.ySize * channels;
}

}  // namespace

Result<ExrHeaders> check_exr_headers(ExrInput& in, std::string_view name, const ReadOptions& options,
                                     std::size_t most_channels) {
    try {
        const ExrHeaders headers = Walker(in, name, options, most_channels).file();
        in.seekg(0);
        return headers;
    } catch (const std::length_error& error) {
        return Error{error.what()};
    } catch (const Refusal& refusal) {
        return Error{fmt::format("{}: damaged OpenEXR header: {}", name, refusal.what())};
    } catch (const std::exception& error) {
        return Error{fmt::format("{}: {}, at byte {} of its OpenEXR header", name, error.what(), in.tellg())};
    }
}

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

bool is_deep(const Imf::Header& header) {
    return header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE);
}

Status check_part(const Imf::Header& header, std::string_view name, std::uint64_t file_bytes, std::uint64_t channels,
                  const ReadOptions& options) {
    // Check both windows against the limits.
    const ExrWindow data = data_window(header), display = display_window(header);
    for (const ExrWindow& window : {data, display})
        if (const Status status = check_size(name, window.width(), window.height(), options); !status) return status;
    const ExrWindow common = common_window(data, display);
    if (common.width() <= 0 || common.height() <= 0)
        return Error{fmt::format("{}: the data window lies outside the display window: no pixel can be seen", name)};

    // Bound what OpenEXR buffers for one chunk.
    constexpr std::size_t k_most_buffered = std::size_t{1} << 28, k_always = std::size_t{1} << 20;
    const auto most_buffered = static_cast<std::int64_t>(
        std::min(k_most_buffered, k_always + 4 * std::min(options.most_pixels, k_most_buffered)));
    if (buffered_samples(header) > most_buffered)
        return Error{fmt::format("{}: one chunk of the image would take more than {} samples", name, most_buffered)};

    // DWA compresses best: 64 equal samples are two symbols of 16 bits, deflated at most 1032 : 1.
    constexpr std::uint64_t k_most_samples_per_byte = 64 * 1032 / 4;
    if (data.pixels() * channels / k_most_samples_per_byte > file_bytes)
        return Error{
            fmt::format("{}: {} bytes cannot hold {} x {} pixels", name, file_bytes, data.width(), data.height())};
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
