// OpenEXR environments: channels are read straight into the image, which is all the memory that a large one needs.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "io/exr_checks.h"
#include "io/exr_chunks.h"
#include "io/exr_envmap.h"
#include "io/exr_windows.h"
#include "io/image_checks.h"

namespace lobelia {

namespace {

using namespace io;

/// The channels to read: prefix.R and so on.
struct Choice {
    enum class Kind { rgb, luminance, luminance_chroma };
    Kind kind = Kind::rgb;
    int part = 0;
    std::string prefix;
};

bool has_rgb(const Imf::ChannelList& channels, const std::string& prefix) {
    return channels.findChannel(prefix + "R") && channels.findChannel(prefix + "G") &&
           channels.findChannel(prefix + "B");
}

/// Returns the channels of a part without a prefix, if they are colour or luminance.
std::optional<Choice> plain_channels(const Imf::Header& header, int part) {
    const Imf::ChannelList& channels = header.channels();
    if (has_rgb(channels, "")) return Choice{Choice::Kind::rgb, part, ""};
    if (!channels.findChannel("Y")) return std::nullopt;
    const bool chroma = channels.findChannel("RY") && channels.findChannel("BY");
    return Choice{chroma ? Choice::Kind::luminance_chroma : Choice::Kind::luminance, part, ""};
}

/// Returns the first layer of a part, by name, that has R, G and B.
std::optional<Choice> layered_channels(const Imf::Header& header, int part) {
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const std::string name = c.name();
        const std::size_t dot = name.rfind('.');
        if (dot != std::string::npos && has_rgb(header.channels(), name.substr(0, dot + 1)))
            return Choice{Choice::Kind::rgb, part, name.substr(0, dot + 1)};
    }
    return std::nullopt;
}

Result<Choice> choose(const Imf::MultiPartInputFile& file, std::string_view name) {
    bool deep = false;
    for (const auto& channels_of : {plain_channels, layered_channels}) {
        for (int part = 0; part < file.parts(); ++part) {
            deep = deep || is_deep(file.header(part));
            if (is_deep(file.header(part))) continue;
            if (const auto choice = channels_of(file.header(part), part)) return *choice;
        }
    }
    if (deep) return Error{fmt::format("{}: a deep OpenEXR image; flatten it first", name)};
    return Error{fmt::format("{}: no part of the OpenEXR file has the channels R, G, B or Y", name)};
}

/// Returns true for compressions that may turn 0 into a small negative number.
bool crosses_zero(Imf::Compression compression) {
    return compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION ||
           compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

Status check_choice(const Imf::Header& header, const Choice& choice, std::string_view name, std::uint64_t file_bytes,
                    const ReadOptions& options) {
    const std::uint64_t channels = choice.kind == Choice::Kind::rgb ? 3 : 1;
    if (const Status status = check_part(header, name, file_bytes, channels, options); !status) return status;

    // Only chroma may be sampled at a lower rate.
    const bool chroma = choice.kind == Choice::Kind::luminance_chroma;
    for (const char* channel : {"R", "G", "B", "Y", "RY", "BY"}) {
        const int rate = chroma && (channel[1] == 'Y') ? 2 : 1;
        if (const Status status = check_sampling(header, choice.prefix + channel, name, rate); !status) return status;
    }
    if (chroma && choice.part != 0)
        return Error{fmt::format("{}: luminance and chroma are read from the first part only, not from part {}", name,
                                 choice.part)};
    return Done{};
}

/// Reads R, G, B, or Y into r alone, in place.
void read_planes(Imf::InputPart& part, const Choice& choice, Image& image) {
    const auto& window = part.header().dataWindow();
    const std::size_t row = image.width * sizeof(Rgb);
    Imf::FrameBuffer target;
    const auto insert = [&](const char* channel, float& first) {
        target.insert(choice.prefix + channel, Imf::Slice::Make(Imf::FLOAT, &first, window, sizeof(Rgb), row));
    };
    if (choice.kind == Choice::Kind::luminance) {
        insert("Y", image.pixels[0].r);
    } else {
        insert("R", image.pixels[0].r);
        insert("G", image.pixels[0].g);
        insert("B", image.pixels[0].b);
    }
    part.setFrameBuffer(target);
    part.readPixels(window.min.y, window.max.y);
}

/// Reads luminance and chroma through OpenEXR's own conversion, a scanline at a time.
void read_luminance_chroma(ExrInput& in, Image& image) {
    in.seekg(0);
    Imf::RgbaInputFile file(in);
    const auto& window = file.dataWindow();
    std::vector<Imf::Rgba> line(image.width);
    file.setFrameBuffer(line.data() - window.min.x, 1, 0);
    for (std::size_t y = 0; y < image.height; ++y) {
        file.readPixels(window.min.y + static_cast<int>(y));
        for (std::size_t x = 0; x < image.width; ++x) image.at(x, y) = {line[x].r, line[x].g, line[x].b};
    }
}

std::vector<std::string> warnings_about(const Imf::MultiPartInputFile& file, const Choice& choice) {
    std::vector<std::string> warnings;
    const Imf::Header& header = file.header(choice.part);
    if (file.parts() > 1)
        warnings.push_back(fmt::format("read part {} (\"{}\") of {}", choice.part,
                                       header.hasName() ? header.name() : std::string(), file.parts()));
    if (!choice.prefix.empty())
        warnings.push_back(fmt::format("there are no plain R, G, B; read {0}R, {0}G and {0}B", choice.prefix));
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities given = Imf::chromaticities(header), rec709;
        const auto differ = [](const auto& a, const auto& b) { return !(std::hypot(a.x - b.x, a.y - b.y) < 0.002f); };
        if (differ(given.red, rec709.red) || differ(given.green, rec709.green) || differ(given.blue, rec709.blue) ||
            differ(given.white, rec709.white))
            warnings.emplace_back(
                "the chromaticities are not those of Rec. 709; pixels are taken as Rec. 709 unchanged");
    }
    return warnings;
}

/// Moves the stored pixels to where they are displayed.
LoadedImage on_display(LoadedImage loaded, const Imf::Header& header) {
    const ExrWindow data = data_window(header), display = display_window(header);
    if (data == display) return loaded;
    for (std::string& warning : warnings_about_windows(header)) loaded.warnings.push_back(std::move(warning));
    Image image;
    image.width = static_cast<std::size_t>(display.width());
    image.height = static_cast<std::size_t>(display.height());
    image.pixels = placed(std::move(loaded.image.pixels), data, display);
    loaded.image = std::move(image);
    return loaded;
}

/// Decodes an environment; OpenEXR reports faults of the file as exceptions.
Result<LoadedImage> decode(ExrInput& in, const ExrHeaders& headers, std::string_view name, const ReadOptions& options) {
    // Choose the channels. A missing table of chunks is not reconstructed: such files are incomplete.
    Imf::MultiPartInputFile file(in, Imf::globalThreadCount(), false);
    const Result<Choice> choice = choose(file, name);
    if (!choice) return choice.error();
    const Imf::Header& header = file.header(choice->part);
    if (const Status status = check_choice(header, *choice, name, in.size(), options); !status) return status.error();

    // Read them as stored.
    const ExrWindow data = data_window(header);
    LoadedImage loaded{Image(static_cast<std::size_t>(data.width()), static_cast<std::size_t>(data.height())),
                       warnings_about(file, *choice),
                       {}};
    Imf::InputPart part(file, choice->part);
    if (const Status status = check_chunks(in, headers, part, name); !status) return status.error();
    if (choice->kind == Choice::Kind::luminance_chroma) {
        read_luminance_chroma(in, loaded.image);
        clip_negatives(loaded, "rounding of luminance and chroma");
    } else {
        read_planes(part, *choice, loaded.image);
        if (choice->kind == Choice::Kind::luminance)
            for (Rgb& pixel : loaded.image.pixels) pixel = {pixel.r, pixel.r, pixel.r};
        if (crosses_zero(header.compression())) clip_negatives(loaded, "rounding of its lossy compression");
    }

    // Bring them to the display window, check them, and convert to Lobelia's latitude-longitude map.
    loaded = on_display(std::move(loaded), header);
    if (const Status status = check_pixels(loaded, name, options); !status) return status.error();
    return to_latitude_longitude(std::move(loaded), header, name, options);
}

Result<LoadedImage> read(ExrInput& in, std::string_view name, const ReadOptions& options) {
    const auto headers = check_exr_headers(in, name, options);
    if (!headers) return headers.error();
    auto loaded = without_exceptions(in, name, [&] { return decode(in, *headers, name, options); });
    if (loaded) warn_of_shape(*loaded);
    return loaded;
}

}  // namespace

void allow_reader_threads(int count) { Imf::setGlobalThreadCount(count); }

Result<LoadedImage> read_exr(InputFile file, const ReadOptions& options) {
    const std::string name = file.name();
    FileInput in(std::move(file));
    return read(in, name, options);
}

Result<LoadedImage> read_exr(std::span<const std::byte> bytes, std::string_view name, const ReadOptions& options) {
    MemoryInput in(bytes, std::string(name));
    return read(in, name, options);
}

}  // namespace lobelia
