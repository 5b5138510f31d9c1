// Resources of a glTF file by URI: data URIs, and files in its own folder.
#pragma once

#include <map>

#include "lobelia/gltf.h"

namespace lobelia::gltf {

/// Returns a reader of files in `folder` and below it; it refuses links that lead out of the folder.
[[nodiscard]] ResourceReader files_in(const std::filesystem::path& folder);

/// The bytes behind URIs, each file read once. Spans stay valid for the lifetime of this object, also when it is moved.
class Resources {
  public:
    Resources(ResourceReader reader, std::size_t most_bytes) : reader_(std::move(reader)), bytes_left_(most_bytes) {}
    /// Returns the bytes. Errors describe the fault of the URI or its file, without the place in the glTF file.
    [[nodiscard]] Result<std::span<const std::byte>> get(const std::string& uri);
    /// The size of everything that was read so far.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    [[nodiscard]] Result<std::span<const std::byte>> keep(const std::string& key, std::vector<std::byte> bytes);

    ResourceReader reader_;
    std::size_t bytes_left_, bytes_ = 0;
    std::map<std::string, std::vector<std::byte>> files_;
    std::vector<std::vector<std::byte>> data_;
};

/// Converts a relative URI to a path below the folder: decodes percent signs, resolves "." and "..". Errors: it is
/// absolute, has a scheme, leads out of the folder, or holds characters that no portable file name has.
[[nodiscard]] Result<std::string> relative_path(std::string_view uri);

/// Decodes the bytes of a URI "data:...;base64,...".
[[nodiscard]] Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);

}  // namespace lobelia::gltf
