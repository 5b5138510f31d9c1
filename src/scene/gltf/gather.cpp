// A glTF file with all files that it refers to.
#include "scene/gltf/gather.h"

#include <nlohmann/json.hpp>

#include "io/decode_picture.h"
#include "io/read_file.h"
#include "scene/gltf/document.h"

namespace lobelia::gltf {
namespace {

using nlohmann::json;

/// The extension by which other programs know a picture's format where the file does not state it.
std::string extension_of(Bytes bytes) {
    if (const auto format = io::picture_format(bytes)) {
        switch (*format) {
            case io::PictureFormat::png:
                return "png";
            case io::PictureFormat::jpeg:
                return "jpg";
            case io::PictureFormat::webp:
                return "webp";
        }
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with("\xabKTX 20") ? "ktx2" : "bin";
}

/// Replaces the URIs of a list of the file by names of gathered files.
class Gatherer {
  public:
    Gatherer(Resources resources, GatheredFile& out) : resources_(std::move(resources)), out_(out) {}

    /// `read` are the entries of `target` as they were read, with their places.
    void replace(const std::vector<JsonPlace>& read, json& target) {
        for (std::size_t i = 0; i < read.size(); ++i) {
            const auto uri = read[i].find("uri");
            if (!uri || uri->long_text().starts_with("data:")) continue;
            const auto bytes = resources_.get(std::string(uri->long_text()));
            if (!bytes) uri->refuse(bytes.error().message);
            target[i]["uri"] = add(*bytes);
        }
    }
    std::string add(Bytes bytes) {
        std::string name = fmt::format("resource-{}.{}", out_.files.size(), extension_of(bytes));
        out_.files.emplace_back(name, std::vector(bytes.begin(), bytes.end()));
        return name;
    }

  private:
    Resources resources_;
    GatheredFile& out_;
};

GatheredFile gather(Bytes bytes, const std::filesystem::path& path, std::size_t most_bytes) {
    // Read the JSON twice: once for the places in it, once to change it.
    const Container container = split(bytes, path.string());
    const auto document = JsonDocument::parse(container.json, path.string());
    if (!document) throw JsonRefusal(document.error().message);
    const JsonPlace root(*document);
    json changed = parse_json(container.json, path.string()).value();

    GatheredFile result;
    Gatherer gatherer(Resources(files_in(path.parent_path()), most_bytes), result);
    const auto buffers = objects(root, "buffers"), images = objects(root, "images");
    gatherer.replace(buffers, changed["buffers"]);
    gatherer.replace(images, changed["images"]);
    if (container.binary && !buffers.empty() && !buffers[0].has("uri"))
        changed["buffers"][0]["uri"] = gatherer.add(*container.binary);
    for (const char* list : {"buffers", "images"})
        if (changed[list].is_null()) changed.erase(list);
    result.json = changed.dump(-1, ' ', false, json::error_handler_t::replace);
    return result;
}

}  // namespace

Result<GatheredFile> gather_gltf(const std::filesystem::path& path, std::size_t most_bytes) {
    const auto bytes = read_file(path, most_bytes);
    if (!bytes) return bytes.error();
    try {
        return gather(*bytes, path, most_bytes);
    } catch (const JsonRefusal& refusal) {
        return Error{refusal.what()};
    }
}

}  // namespace lobelia::gltf
