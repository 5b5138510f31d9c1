// A glTF file taken apart.
#include "scene/gltf_document.h"

#include <bit>
#include <cstring>

#include "scene/gltf_json.h"

namespace lobelia::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are read as they lie in memory");

/// The two parts of a file; text files have no binary one.
struct Container {
    std::string_view json;
    std::optional<Bytes> binary;
};

std::uint32_t word_at(Bytes bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

/// GLB: a header of 12 bytes, then chunks of a length, a type and that many bytes.
Result<Container> split_glb(Bytes bytes, std::string_view name) {
    constexpr std::uint32_t k_json = 0x4E4F534A, k_binary = 0x004E4942;
    const auto failed = [&](std::string_view what) { return Error{fmt::format("{}: {}", name, what)}; };
    if (bytes.size() < 12) return failed("a GLB file that ends within its header");
    if (const std::uint32_t version = word_at(bytes, 4); version != 2)
        return failed(fmt::format("GLB version {} is not read, 2 is", version));
    const std::uint32_t length = word_at(bytes, 8);
    if (length > bytes.size())
        return failed(fmt::format("the file is cut short: {} bytes of {}", bytes.size(), length));
    if (length < 12) return failed("a GLB file of fewer bytes than its header");
    bytes = bytes.first(length);

    // Take the first chunk as JSON, the second as the binary buffer, and skip others.
    Container parts;
    std::size_t offset = 12;
    for (int chunk = 0; bytes.size() - offset >= 8; ++chunk) {
        const std::uint32_t size = word_at(bytes, offset), type = word_at(bytes, offset + 4);
        offset += 8;
        if (size > bytes.size() - offset)
            return failed(fmt::format("chunk {} is cut short: {} bytes of {}", chunk, bytes.size() - offset, size));
        const Bytes content = bytes.subspan(offset, size);
        if (chunk == 0 && type != k_json) return failed("the first chunk of the GLB file is not JSON");
        if (chunk == 0) parts.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        if (chunk == 1 && type == k_binary) parts.binary = content;
        // Chunks end at multiples of four, but the last one's padding is sometimes forgotten.
        offset = std::min(bytes.size(), offset + (std::size_t{size} + 3) / 4 * 4);
    }
    if (parts.json.data() == nullptr) return failed("a GLB file without chunks");
    return parts;
}

Result<Container> split(Bytes bytes, std::string_view name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.empty()) return Error{fmt::format("{}: the file is empty", name)};
    if (text.starts_with("glTF")) return split_glb(bytes, name);
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first == std::string_view::npos || text[first] != '{')
        return Error{fmt::format("{}: neither a .glb nor a .gltf file", name)};
    return Container{text, std::nullopt};
}

/// Fetches each buffer, and sees that it is as long as it should be.
Status read_buffers(Document& document, const nlohmann::json& root, const std::optional<Bytes>& binary) {
    const auto buffers = root.find("buffers");
    if (buffers == root.end()) return Done{};
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const nlohmann::json& buffer = (*buffers)[i];
        const std::string place = fmt::format("buffers[{}]", i);
        const auto length = buffer.find("byteLength");
        if (length == buffer.end()) return document.error(place + ".byteLength", "missing");
        Result<Bytes> bytes = Bytes{};
        if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
            if (!uri->is_string()) return document.error(place + ".uri", "not a text");
            bytes = document.resources.get(uri->get_ref<const std::string&>());
            if (!bytes) return document.error(place + ".uri", bytes.error().message);
        } else if (i == 0 && binary) {
            bytes = *binary;
        } else if (!buffer.contains("extensions")) {
            return document.error(place, "no uri, and no binary chunk for it");
        }
        // Buffers that only an extension fills are there to be fallen back from.
        const bool filled = buffer.contains("uri") || (i == 0 && binary);
        const auto wanted = length->get<std::uint64_t>();
        if (filled && wanted > bytes->size())
            return document.error(place, fmt::format("{} bytes, but byteLength is {}", bytes->size(), wanted));
        document.buffers.push_back(filled ? bytes->first(wanted) : Bytes{});
    }
    return Done{};
}

Status read_image_sources(Document& document, const nlohmann::json& root) {
    const auto images = root.find("images");
    if (images == root.end()) return Done{};
    for (std::size_t i = 0; i < images->size(); ++i) {
        const nlohmann::json& image = (*images)[i];
        ImageSource source;
        source.name = short_name(image.value("name", std::string()));
        if (const auto view = image.find("bufferView"); view != image.end())
            source.buffer_view = view->get<std::size_t>();
        if (const auto uri = image.find("uri"); uri != image.end()) {
            if (!uri->is_string()) return document.error(fmt::format("images[{}].uri", i), "not a text");
            source.uri = uri->get<std::string>();
            // Looked at even where nobody uses the image: other programs would open it.
            if (!source.uri.starts_with("data:"))
                if (const auto path = relative_path(source.uri); !path)
                    return document.error(fmt::format("images[{}].uri", i), path.error().message);
        }
        if (source.buffer_view.has_value() != source.uri.empty())
            return document.error(fmt::format("images[{}]", i), "must have either a uri or a bufferView");
        document.images.push_back(std::move(source));
    }
    return Done{};
}

/// Gives tinygltf what is left of the JSON.
Status parse_model(Document& document, nlohmann::json root) {
    // Take away what it would load, and what nobody asks for.
    for (const char* key : {"buffers", "images", "animations", "skins", "extras"}) root.erase(key);
    const std::string text = root.dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) return document.error("JSON", "larger than 4 GiB");
    tinygltf::TinyGLTF reader;
    std::string error, warning;
    bool done = false;
    try {
        done = reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                          static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (done && error.empty()) return Done{};
    error = error.substr(0, error.find('\n'));
    return document.error("JSON", error.empty() ? "malformed" : error);
}

}  // namespace

Result<Document> open_document(Bytes bytes, std::string_view name, const ResourceReader& resources,
                               const GltfReadOptions& options) {
    const auto container = split(bytes, name);
    if (!container) return container.error();
    auto root = parse_json(container->json, name);
    if (!root) return root.error();

    Document document{std::string(name), {}, {}, {}, Resources(resources, options.most_bytes), options, {}};
    if (const Status s = read_buffers(document, *root, container->binary); !s) return s.error();
    if (const Status s = read_image_sources(document, *root); !s) return s.error();
    const bool moves = root->contains("animations") && !(*root)["animations"].empty();
    if (const Status s = parse_model(document, *std::move(root)); !s) return s.error();
    if (moves) document.warn("animations", "not read; everything stands where its node says");
    for (const std::string& extension : document.model.extensionsUsed)
        if (const std::string_view what = unread_extension(extension); !what.empty())
            document.warn("extensionsUsed", fmt::format("{}: {}", extension, what));
    return document;
}

Result<Bytes> view_bytes(const Document& document, int view, std::string_view place) {
    const auto& views = document.model.bufferViews;
    if (view < 0 || static_cast<std::size_t>(view) >= views.size())
        return document.error(place, fmt::format("bufferView {} of {}", view, views.size()));
    const auto& v = views[static_cast<std::size_t>(view)];
    const std::string at = fmt::format("bufferViews[{}]", view);
    if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= document.buffers.size())
        return document.error(at, fmt::format("buffer {} of {}", v.buffer, document.buffers.size()));
    const Bytes buffer = document.buffers[static_cast<std::size_t>(v.buffer)];
    for (const char* compression : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (buffer.empty() && extension(v.extensions, compression)) return document.error(at, compressed(compression));
    if (v.byteOffset > buffer.size() || v.byteLength > buffer.size() - v.byteOffset)
        return document.error(
            at, fmt::format("bytes {} + {} of a buffer of {}", v.byteOffset, v.byteLength, buffer.size()));
    return buffer.subspan(v.byteOffset, v.byteLength);
}

std::string compressed(std::string_view extension) {
    return fmt::format("{} is not read; decompress the file first: gltf-transform copy IN.glb OUT.glb", extension);
}

std::string short_name(const std::string& name) {
    // Not within a character of UTF-8.
    std::size_t end = std::min<std::size_t>(name.size(), 200);
    while (end > 0 && end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
    return name.substr(0, end);
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number(const tinygltf::Value& value, const char* key, double otherwise) {
    return value.Has(key) && value.Get(key).IsNumber() ? value.Get(key).GetNumberAsDouble() : otherwise;
}

Result<std::optional<std::size_t>> checked_index(const Document& document, const tinygltf::Value& value,
                                                 const char* key, std::size_t count, std::string_view place) {
    if (!value.Has(key)) return std::optional<std::size_t>();
    const tinygltf::Value& entry = value.Get(key);
    if (!entry.IsInt() || entry.GetNumberAsInt() < 0 || static_cast<std::size_t>(entry.GetNumberAsInt()) >= count)
        return document.error(fmt::format("{}.{}", place, key), fmt::format("not an index below {}", count));
    return std::optional<std::size_t>(static_cast<std::size_t>(entry.GetNumberAsInt()));
}

}  // namespace lobelia::gltf
