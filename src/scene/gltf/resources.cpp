// Resources of a glTF file by URI: data URIs (RFC 2397), and files in its own folder.
#include "scene/gltf/resources.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "io/read_file.h"

namespace lobelia::gltf {
namespace {

constexpr std::size_t k_most_shown = 120;

/// Returns a URI in the form for messages.
std::string shown(std::string_view uri) {
    std::string text;
    for (const char c : uri.substr(0, k_most_shown)) text += c >= 0x20 && c < 0x7f ? c : '?';
    return "\"" + text + (uri.size() > k_most_shown ? "...\"" : "\"");
}

std::optional<unsigned> hex_digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
    return std::nullopt;
}

/// Decodes %XX to the byte XX (RFC 3986).
Result<std::string> percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text += uri[i];
            continue;
        }
        const auto high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : std::nullopt;
        const auto low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : std::nullopt;
        if (!high || !low) return Error{fmt::format("{}: a percent sign without two hexadecimal digits", shown(uri))};
        text += static_cast<char>(16 * *high + *low);
        i += 2;
    }
    return text;
}

/// Values of the base64 alphabet (RFC 4648); 64 for all other characters.
constexpr std::array<std::uint8_t, 256> k_base64 = [] {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(64);
    for (std::size_t i = 0; i < alphabet.size(); ++i)
        values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    return values;
}();

Result<std::vector<std::byte>> base64_decoded(std::string_view text) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) return Error{"base64 data that ends too early"};
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::uint8_t value = k_base64[static_cast<unsigned char>(c)];
        if (value == 64) return Error{"a character that is not base64"};
        bits = (bits << 6) | value;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::byte>((bits >> count) & 0xff));
    }
    return bytes;
}

}  // namespace

Result<std::string> relative_path(std::string_view uri) {
    const auto refused = [&](std::string_view why) { return Error{fmt::format("{} is refused: {}", shown(uri), why)}; };
    const Result<std::string> path = percent_decoded(uri);
    if (!path) return path.error();
    if (path->empty()) return refused("it is empty");
    for (const char c : *path)
        if (static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':' || c == 0x7f)
            return refused("it holds a colon, a backslash or a control character; only plain relative paths are read");
    if (path->front() == '/') return refused("an absolute path; only files in the scene's folder are read");
    const std::filesystem::path normal = std::filesystem::path(*path).lexically_normal();
    if (*normal.begin() == "..") return refused("it leads out of the scene's folder");
    return normal.generic_string();
}

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    const std::string_view head = uri.substr(0, comma == std::string_view::npos ? 0 : comma);
    if (!head.starts_with("data:") || !head.ends_with(";base64"))
        return Error{fmt::format("{}: a data URI that is not base64", shown(uri))};
    auto bytes = base64_decoded(uri.substr(comma + 1));
    if (!bytes) return Error{fmt::format("{}: {}", shown(uri), bytes.error().message)};
    return bytes;
}

ResourceReader files_in(const std::filesystem::path& folder) {
    return [folder](const std::string& relative, std::size_t most_bytes) -> Result<std::vector<std::byte>> {
        // Follow all links, and check that the file is still below the folder.
        std::error_code code;
        const std::filesystem::path base = std::filesystem::canonical(folder.empty() ? "." : folder, code);
        if (code) return Error{fmt::format("{}: {}", folder.string(), code.message())};
        const std::filesystem::path file = std::filesystem::canonical(base / relative, code);
        if (code) return Error{fmt::format("{}: {}", (folder / relative).string(), code.message())};
        const auto [end, rest] = std::mismatch(base.begin(), base.end(), file.begin(), file.end());
        if (end != base.end())
            return Error{fmt::format("{} is refused: it leads out of the scene's folder", shown(relative))};
        // Open it without following links any more: it may be another file by now.
        std::filesystem::path below;
        for (auto component = rest; component != file.end(); ++component) below /= *component;
        const auto opened = InputFile::open_below(base, below, most_bytes);
        return opened ? read_file(*opened) : opened.error();
    };
}

Result<std::span<const std::byte>> Resources::keep(const std::string& key, std::vector<std::byte> bytes) {
    if (bytes.size() > bytes_left_) return Error{"the files that the scene refers to are too large together"};
    bytes_left_ -= bytes.size();
    bytes_ += bytes.size();
    if (key.empty()) return std::span<const std::byte>(data_.emplace_back(std::move(bytes)));
    return std::span<const std::byte>(files_[key] = std::move(bytes));
}

Result<std::span<const std::byte>> Resources::get(const std::string& uri) {
    if (uri.starts_with("data:")) {
        auto bytes = decode_data_uri(uri);
        if (!bytes) return bytes.error();
        return keep("", *std::move(bytes));
    }
    const auto path = relative_path(uri);
    if (!path) return path.error();
    if (const auto found = files_.find(*path); found != files_.end()) return std::span<const std::byte>(found->second);
    if (!reader_) return Error{fmt::format("{}: other files cannot be read here", shown(uri))};
    auto bytes = reader_(*path, bytes_left_);
    if (!bytes) return bytes.error();
    return keep(*path, *std::move(bytes));
}

}  // namespace lobelia::gltf
