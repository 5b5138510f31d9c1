// Accessors of a glTF file: typed views of its buffers, read element by element.
#pragma once

#include <array>

#include "scene/gltf_document.h"

namespace lobelia::gltf {

/// Valid as long as the document is, and never out of its buffers. Copies nothing but a sparse accessor's indices.
class Accessor {
  public:
    /// Checks everything that the file says of it. Errors name `place`, such as
    /// "meshes[3].primitives[0].attributes.POSITION", and the accessor.
    [[nodiscard]] static Result<Accessor> open(Document& document, int index, const std::string& place);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::size_t components() const { return components_; }
    [[nodiscard]] bool is_integer() const { return component_type_ != TINYGLTF_COMPONENT_TYPE_FLOAT; }
    /// Element i as floats, normalised where the file says so; missing components are 0.
    [[nodiscard]] std::array<float, 4> operator[](std::size_t i) const;
    /// Component 0 of element i, of an accessor of unsigned integers.
    [[nodiscard]] std::uint32_t index_at(std::size_t i) const;
    [[nodiscard]] bool is_unsigned() const;

  private:
    [[nodiscard]] const std::byte* element(std::size_t i) const;
    [[nodiscard]] float component(const std::byte* data) const;
    [[nodiscard]] static Result<Accessor> open_checked(Document& document, int index, const std::string& place);
    [[nodiscard]] Status open_sparse(Document& document, int index, const std::string& place);

    Bytes data_;  ///< empty: zeros
    std::size_t count_ = 0, stride_ = 0, components_ = 0, component_size_ = 0;
    int component_type_ = 0;
    bool normalized_ = false;
    std::shared_ptr<const std::vector<std::uint32_t>> sparse_indices_;  ///< ascending; null: none
    Bytes sparse_values_;
};

}  // namespace lobelia::gltf
