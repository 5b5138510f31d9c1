// A glTF file taken apart: its JSON as tinygltf's model, its buffers and images as bytes.
#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <memory>
#include <optional>

#include "scene/gltf_resources.h"

namespace lobelia::gltf {

using Bytes = std::span<const std::byte>;

/// Where an image's file is: in a buffer view, or at a URI.
struct ImageSource {
    std::string name;
    std::optional<std::size_t> buffer_view;
    std::string uri;
};

/// tinygltf sees the JSON without buffers, images and animations: it opens no file, decodes no picture.
struct Document {
    std::string name;  ///< of the file, for messages
    tinygltf::Model model;
    std::vector<Bytes> buffers;
    std::vector<ImageSource> images;
    Resources resources;
    GltfReadOptions options;
    std::vector<std::string> warnings;
    std::size_t more_warnings = 0;  ///< beyond the first few
    /// Checked indices of sparse accessors, read once each.
    std::map<int, std::shared_ptr<const std::vector<std::uint32_t>>> sparse_indices = {};
    std::size_t sparse_left = std::size_t{1} << 26;  ///< elements that may still be read

    /// "file: place: what"
    [[nodiscard]] Error error(std::string_view place, std::string_view what) const {
        return Error{fmt::format("{}: {}: {}", name, place, what)};
    }
    void warn(std::string_view place, std::string_view what) {
        constexpr std::size_t k_most = 24;
        if (warnings.size() < k_most) {
            warnings.push_back(fmt::format("{}: {}", place, what));
        } else {
            ++more_warnings;
        }
    }
};

/// `bytes` must outlive the document.
[[nodiscard]] Result<Document> open_document(Bytes bytes, std::string_view name, const ResourceReader& resources,
                                             const GltfReadOptions& options);

/// The bytes of a buffer view; an error that names `place` where there is none, or it exceeds its buffer.
[[nodiscard]] Result<Bytes> view_bytes(const Document& document, int view, std::string_view place);

/// What is said of data that only an extension could decompress.
[[nodiscard]] std::string compressed(std::string_view extension);

/// A name, or the beginning of one that is no name but a burden: it may be asked for a million times.
[[nodiscard]] std::string short_name(const std::string& name);

/// An extension of some object, or null.
[[nodiscard]] const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name);

/// A number in an extension; `otherwise` where it is missing or no number.
[[nodiscard]] double number(const tinygltf::Value& value, const char* key, double otherwise);

/// An index in an extension; nothing where it is missing, and an error where it is not in [0, count).
[[nodiscard]] Result<std::optional<std::size_t>> checked_index(const Document& document, const tinygltf::Value& value,
                                                               const char* key, std::size_t count,
                                                               std::string_view place);

}  // namespace lobelia::gltf
