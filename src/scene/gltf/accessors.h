// Accessors of a glTF file: typed views of its buffers, read element by element.
#pragma once

#include <array>

#include "scene/gltf/document.h"

namespace lobelia::gltf {

/// Values of accessor.componentType.
inline constexpr std::size_t k_byte = 5120, k_unsigned_byte = 5121, k_short = 5122, k_unsigned_short = 5123,
                             k_unsigned_int = 5125, k_float = 5126;

/// A view of an accessor's elements. Valid as long as the document is, and always within its buffers. Copies only the
/// indices of a sparse accessor.
class Accessor {
  public:
    /// Opens the accessor whose index is `index` and checks all that the file states about it. Elements have at most
    /// `most_components`: 4 for vectors, 16 for matrices.
    Accessor(Document& document, const JsonPlace& index, std::size_t most_components = 4);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::size_t components() const { return components_; }
    /// Returns element i as floats, normalised where the file says so; missing components are 0.
    [[nodiscard]] std::array<float, 4> operator[](std::size_t i) const;
    /// Reads the first components of element i.
    void get(std::size_t i, std::span<float> values) const;
    /// Returns component k of element i, of an accessor of unsigned integers.
    [[nodiscard]] std::uint32_t index_at(std::size_t i, std::size_t k = 0) const;
    [[nodiscard]] bool is_unsigned() const;

  private:
    [[nodiscard]] const std::byte* element(std::size_t i) const;
    [[nodiscard]] float component(const std::byte* data) const;
    void open_sparse(Document& document, const JsonPlace& sparse, std::size_t accessor);

    Bytes data_;  ///< empty: all zeros
    std::size_t count_ = 0, stride_ = 0, components_ = 0, component_size_ = 0;
    std::size_t component_type_ = 0;
    bool normalized_ = false;
    std::shared_ptr<const std::vector<std::uint32_t>> sparse_indices_;  ///< ascending; null: none
    Bytes sparse_values_;
};

}  // namespace lobelia::gltf
