// Splits a glTF file into container, JSON and buffers.
#include "scene/gltf/document.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "scene/gltf/extensions.h"

namespace lobelia::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of a glTF file are read as they lie in memory");

std::uint32_t word_at(Bytes bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

/// Splits a GLB file: a header of 12 bytes, then chunks of a length, a type and that many bytes.
Container split_glb(Bytes bytes, std::string_view name) {
    constexpr std::uint32_t k_json = 0x4E4F534A, k_binary = 0x004E4942;
    const auto refuse = [&](std::string_view what) { throw JsonRefusal(fmt::format("{}: {}", name, what)); };
    if (bytes.size() < 12) refuse("a GLB file that ends within its header");
    if (const std::uint32_t version = word_at(bytes, 4); version != 2)
        refuse(fmt::format("GLB version {} is not supported; use version 2", version));
    const std::uint32_t length = word_at(bytes, 8);
    if (length > bytes.size()) refuse(fmt::format("the file is truncated: {} bytes of {}", bytes.size(), length));
    if (length < 12) refuse("a GLB file of fewer bytes than its header");
    bytes = bytes.first(length);

    // Take the first chunk as JSON, the second as the binary buffer, and skip others.
    Container parts;
    std::size_t offset = 12;
    for (int chunk = 0; bytes.size() - offset >= 8; ++chunk) {
        const std::uint32_t size = word_at(bytes, offset), type = word_at(bytes, offset + 4);
        offset += 8;
        if (size > bytes.size() - offset)
            refuse(fmt::format("chunk {} is truncated: {} bytes of {}", chunk, bytes.size() - offset, size));
        const Bytes content = bytes.subspan(offset, size);
        if (chunk == 0 && type != k_json) refuse("the first chunk of the GLB file is not JSON");
        if (chunk == 0) parts.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        if (chunk == 1 && type == k_binary) parts.binary = content;
        // Chunks end at multiples of four, but the last one's padding is sometimes forgotten.
        offset = std::min(bytes.size(), offset + (std::size_t{size} + 3) / 4 * 4);
    }
    if (parts.json.data() == nullptr) refuse("a GLB file without chunks");
    return parts;
}

}  // namespace

Container split(Bytes bytes, std::string_view name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.empty()) throw JsonRefusal(fmt::format("{}: the file is empty", name));
    if (text.starts_with("glTF")) return split_glb(bytes, name);
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first == std::string_view::npos || text[first] != '{')
        throw JsonRefusal(fmt::format("{}: neither a .glb nor a .gltf file", name));
    return Container{text, std::nullopt};
}

namespace {

/// Parses "2.0" as (2, 0).
std::optional<std::array<int, 2>> parse_version(std::string_view text) {
    std::array<int, 2> version{};
    const char *at = text.data(), *end = at + text.size();
    const auto [dot, major_code] = std::from_chars(at, end, version[0]);
    if (major_code != std::errc() || dot == end || *dot != '.') return std::nullopt;
    const auto [rest, minor_code] = std::from_chars(dot + 1, end, version[1]);
    if (minor_code != std::errc() || rest != end) return std::nullopt;
    return version;
}

/// Refuses other versions than 2.x, and files whose minVersion is above 2.0.
void check_version(const Document& document, const JsonPlace& root) {
    const auto asset = root.find("asset");
    if (!asset || !asset->has("version")) document.refuse("asset.version", "missing; not a glTF 2.0 file");
    for (const char* key : {"version", "minVersion"}) {
        const auto place = asset->find(key);
        if (!place) continue;
        const auto version = parse_version(place->long_text());
        const bool is_minimum = std::string_view(key) == "minVersion";
        if (!version || (*version)[0] != 2 || (is_minimum && (*version)[1] > 0))
            place->refuse(fmt::format("glTF \"{:.20}\" is not supported; use 2.0", place->long_text()));
    }
}

/// Refuses null members: JSON.stringify writes NaN as null, so such a value is damaged, not missing.
void refuse_nulls(const JsonPlace& value) {
    if (value.is_null()) value.refuse("null");
    if (value.is_list())
        for (const JsonPlace& entry : value.list(value.size())) refuse_nulls(entry);
    if (value.is_object())
        for (const auto& [key, member] : value.members())
            if (key != "extras") refuse_nulls(member);
}

}  // namespace

std::vector<JsonPlace> objects(const JsonPlace& parent, const char* key) {
    const auto found = parent.find(key);
    if (!found) return {};
    std::vector<JsonPlace> entries = found->list(found->size());
    for (const JsonPlace& entry : entries)
        if (!entry.is_object()) entry.refuse("not an object");
    return entries;
}

namespace {

void read_arrays(Document& document, const JsonPlace& root) {
    document.accessors = objects(root, "accessors");
    document.buffer_views = objects(root, "bufferViews");
    document.cameras = objects(root, "cameras");
    document.images = objects(root, "images");
    document.materials = objects(root, "materials");
    document.meshes = objects(root, "meshes");
    document.nodes = objects(root, "nodes");
    document.samplers = objects(root, "samplers");
    document.scenes = objects(root, "scenes");
    document.skins = objects(root, "skins");
    document.textures = objects(root, "textures");
    if (const auto punctual = extension(root, "KHR_lights_punctual")) document.lights = objects(*punctual, "lights");
}

/// Fetches each buffer, and checks its length.
void read_buffers(Document& document, const JsonPlace& root, const std::optional<Bytes>& binary) {
    for (const JsonPlace& buffer : objects(root, "buffers")) {
        const bool is_binary = document.buffers.empty() && binary && !buffer.has("uri");
        const std::size_t length = buffer.at("byteLength").whole(0, ~std::uint64_t{0});
        Bytes bytes;
        if (const auto uri = buffer.find("uri")) {
            const auto found = document.resources.get(std::string(uri->long_text()));
            if (!found) uri->refuse(found.error().message);
            bytes = *found;
        } else if (is_binary) {
            bytes = *binary;
        } else {
            // Buffers that only an extension fills are placeholders for files with a fallback.
            if (!buffer.has("extensions")) buffer.refuse("no uri, and no binary chunk for it");
            document.buffers.emplace_back();
            continue;
        }
        if (length > bytes.size()) buffer.refuse(fmt::format("{} bytes, but byteLength is {}", bytes.size(), length));
        document.buffers.push_back(bytes.first(length));
    }
}

/// Checks the source of every image, used or not: other programs would open it.
void check_images(const Document& document) {
    for (const JsonPlace& image : document.images) {
        const auto uri = image.find("uri");
        if (image.has("bufferView") == uri.has_value()) image.refuse("must have either a uri or a bufferView");
        if (!uri || uri->long_text().starts_with("data:")) continue;
        if (const auto path = relative_path(uri->long_text()); !path) uri->refuse(path.error().message);
    }
}

}  // namespace

void Document::warn(std::string_view place, std::string_view what) {
    constexpr std::size_t k_most = 24;
    if (warnings.size() < k_most) {
        warnings.push_back(fmt::format("{}: {}", place, what));
    } else {
        ++more_warnings;
    }
}

void Document::warn(const JsonPlace& place, std::string_view what) {
    // Look up the path only for warnings that are kept, because that takes time.
    warn(more_warnings == 0 ? place.path() : std::string(), what);
}

std::size_t Document::scene_memory() const {
    return options.scene_memory.value_or(default_scene_memory(file_bytes + resources.bytes()));
}

namespace {

std::string mebibytes(std::size_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

/// Names the limit, and how to raise it.
std::string limit_text(const Document& document) {
    const bool chosen = document.options.scene_memory.has_value();
    return fmt::format("{}{}; --scene-memory (GltfReadOptions::scene_memory) allows more",
                       mebibytes(document.scene_memory()),
                       chosen ? "" : ", which is 1 GiB and 256 times the size of its files");
}

}  // namespace

void Document::keep(const JsonPlace& place, std::size_t count, std::size_t bytes_each) {
    const std::size_t left = scene_memory() - std::min(scene_memory(), kept_bytes);
    if (count > left / std::max<std::size_t>(bytes_each, 1))
        place.refuse(fmt::format("the scene would take {}, and more may follow; it may take {}",
                                 mebibytes(kept_bytes + count * bytes_each), limit_text(*this)));
    kept_bytes += count * bytes_each;
}

void Document::work(const JsonPlace& place, std::size_t count) {
    constexpr std::size_t k_bytes_per_element = 8;
    stop().check();
    elements += count;
    if (elements > scene_memory() / k_bytes_per_element)
        place.refuse(fmt::format("more than {} elements would be read, one for {} bytes that the scene may take: {}",
                                 scene_memory() / k_bytes_per_element, k_bytes_per_element, limit_text(*this)));
}

Document open_document(Bytes bytes, const std::string& name, const ResourceReader& resources,
                       const GltfReadOptions& options) {
    const Container container = split(bytes, name);
    const auto json = JsonDocument::parse(container.json, name, {.stop = options.stop});
    if (!json) StopFlag(options.stop).check();
    if (!json) throw JsonRefusal(json.error().message);
    Document document(*json, Resources(resources, options.most_bytes), options);
    document.file_bytes = bytes.size();
    const JsonPlace root(document.json);
    check_version(document, root);
    check_extensions(document, root);
    refuse_nulls(root);
    read_arrays(document, root);
    read_buffers(document, root, container.binary);
    check_images(document);
    if (!objects(root, "animations").empty())
        document.warn("animations", "not supported; nodes keep their static transforms");
    return document;
}

Bytes view_bytes(const Document& document, const JsonPlace& index) {
    const std::size_t i = whole(index);
    if (i >= document.buffer_views.size())
        index.refuse(fmt::format("bufferView {} of {}", i, document.buffer_views.size()));
    const JsonPlace& view = document.buffer_views[i];
    const std::size_t b = whole(view.at("buffer"));
    if (b >= document.buffers.size()) view.refuse(fmt::format("buffer {} of {}", b, document.buffers.size()));
    const Bytes buffer = document.buffers[b];
    for (const char* compression : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (buffer.empty() && extension(view, compression)) view.refuse(compressed(compression));
    const auto size = [&](const char* key, std::size_t otherwise) {
        const auto found = view.find(key);
        return found ? found->whole(0, ~std::uint64_t{0}) : otherwise;
    };
    const std::size_t offset = size("byteOffset", 0), length = view.at("byteLength").whole(0, ~std::uint64_t{0});
    if (offset > buffer.size() || length > buffer.size() - offset)
        view.refuse(fmt::format("bytes {} + {} of a buffer of {}", offset, length, buffer.size()));
    return buffer.subspan(offset, length);
}

std::string compressed(std::string_view extension) {
    return fmt::format("{} is not supported; decompress the file first: gltf-transform copy IN.glb OUT.glb", extension);
}

std::string name_of(const JsonPlace& object) {
    const auto found = object.find("name");
    if (!found) return {};
    // Cut between characters of UTF-8.
    const std::string_view name = found->long_text();
    std::size_t end = std::min<std::size_t>(name.size(), 200);
    while (end > 0 && end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
    return std::string(name.substr(0, end));
}

std::optional<JsonPlace> extension(const JsonPlace& object, const char* name) {
    const auto extensions = object.find("extensions");
    const auto found = extensions ? extensions->find(name) : std::nullopt;
    if (found && !found->is_object()) found->refuse("not an object");
    return found;
}

double number_or(const JsonPlace& object, const char* key, double otherwise) {
    const auto found = object.find(key);
    return found ? found->number() : otherwise;
}

std::size_t index_below(const JsonPlace& value, std::size_t count) {
    const std::size_t index = whole(value);
    if (index >= count) value.refuse(fmt::format("{} of {}", index, count));
    return index;
}

std::optional<std::size_t> find_index(const JsonPlace& object, const char* key, std::size_t count) {
    const auto found = object.find(key);
    return found ? std::optional(index_below(*found, count)) : std::nullopt;
}

Rgb light_amount(const JsonPlace& place, const std::array<double, 3>& color, double scale, std::string_view what) {
    std::array<float, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double amount = color[i] * scale;
        if (!(amount >= 0 && amount <= k_most_light))
            place.refuse(fmt::format("its {} ({:.6g}, {:.6g}, {:.6g}) is negative or above {:g}", what,
                                     color[0] * scale, color[1] * scale, color[2] * scale, k_most_light));
        rgb[i] = static_cast<float>(amount);
    }
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace lobelia::gltf
