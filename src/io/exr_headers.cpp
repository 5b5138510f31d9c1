// An inspection of OpenEXR headers before OpenEXR itself parses them, after "The OpenEXR File Layout" (openexr.com).
#include "io/exr_headers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/image_checks.h"

namespace lobelia::io {

namespace {

constexpr std::size_t k_most_parts = 256, k_most_name = 255;
constexpr std::uint32_t k_tiled = 0x200, k_multi_part = 0x1000;

// Attribute types of one size. OpenEXR reads these without looking at the size that the file states, so a wrong one
// would let it see other attributes than this inspection does.
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

/// A fault of the file; caught where the inspection began.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Walker {
  public:
    Walker(ExrInput& in, std::string_view name, const ReadOptions& options, std::size_t most_channels)
        : in_(in), name_(name), options_(options), most_channels_(most_channels) {}

    void file() {
        if (u32() != 20000630) refuse("no OpenEXR file");
        const std::uint32_t version = u32();
        if ((version & 0xff) != 2) refuse(fmt::format("OpenEXR file version {}, not 2", version & 0xff));
        tiled_ = (version & k_tiled) != 0;
        if ((version & k_multi_part) == 0) {
            part();
            return;
        }
        for (std::size_t parts = 0; part(); ++parts)
            if (parts == k_most_parts) refuse(fmt::format("more than {} parts", k_most_parts));
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
            if (result.size() == k_most_name) refuse("a name without an end");
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
                refuse("an attribute whose size is not that of its type");
        if (attribute.name == "dataWindow") window(attribute);
        if (attribute.name == "tiles") tiles(attribute);
        if (attribute.name == "channels" && attribute.type != "chlist") refuse("channels that are no channel list");
        if (attribute.type == "chlist") channels(end);
        if (attribute.type == "preview") preview(attribute);
        if (attribute.type == "stringvector") strings(end);
        if (attribute.type == "floatvector" && attribute.size % 4 != 0) refuse("a vector of a broken number of floats");
        if (attribute.type == "idmanifest" && attribute.size < 8) refuse("an ID manifest too short to be one");
    }

    void window(const Attribute& attribute) {
        if (attribute.type != "box2i") refuse("a dataWindow that is no box");
        std::array<std::int64_t, 4> box{};
        for (std::int64_t& side : box) side = i32();
        // OpenEXR multiplies coordinates by bytes per pixel in 32 bits in places; far-off windows are of no use here.
        constexpr std::int64_t k_farthest = 1 << 24;
        if (std::any_of(box.begin(), box.end(), [](std::int64_t c) { return c < -k_farthest || c > k_farthest; }))
            refuse("a data window with coordinates beyond 2^24");
        const Status status = check_size(name_, box[2] - box[0] + 1, box[3] - box[1] + 1, options_);
        if (!status) throw std::length_error(status.error().message);
    }

    void tiles(const Attribute& attribute) {
        if (attribute.type != "tiledesc") refuse("tiles without tile description");
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
        if (in_.tellg() != end) refuse("a channel list whose size is not its own");
    }

    void preview(const Attribute& attribute) {
        const std::uint64_t width = u32(), height = u32();
        if (width > 65536 || height > 65536 || 8 + 4 * width * height != attribute.size)
            refuse("a preview image whose size is not its own");
    }

    void strings(std::uint64_t end) {
        while (in_.tellg() < end) {
            const std::uint32_t length = u32();
            if (in_.tellg() > end || length > end - in_.tellg()) refuse("a string larger than its list");
            in_.seekg(in_.tellg() + length);
        }
        if (in_.tellg() != end) refuse("a list of strings whose size is not its own");
    }

    ExrInput& in_;
    std::string_view name_;
    const ReadOptions& options_;
    std::size_t most_channels_;
    bool tiled_ = false;
    std::uint64_t place_ = 0;
};

}  // namespace

Status check_exr_headers(ExrInput& in, std::string_view name, const ReadOptions& options, std::size_t most_channels) {
    try {
        Walker(in, name, options, most_channels).file();
        in.seekg(0);
        return Done{};
    } catch (const std::length_error& error) {
        return Error{error.what()};
    } catch (const Refusal& refusal) {
        return Error{fmt::format("{}: a damaged OpenEXR header: {}", name, refusal.what())};
    } catch (const std::exception& error) {
        return Error{fmt::format("{}: {}, at byte {} of its OpenEXR header", name, error.what(), in.tellg())};
    }
}

}  // namespace lobelia::io
