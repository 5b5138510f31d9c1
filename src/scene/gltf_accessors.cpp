// Accessors of a glTF file: typed views of its buffers, read element by element.
#include "scene/gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace lobelia::gltf {
namespace {

/// Accessors without data are zeros of any number; more than this is no use, and costs memory on trust.
constexpr std::size_t k_most_zeros = std::size_t{1} << 20;

std::size_t size_of(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

/// 1 to 4; 0 for matrices, which no attribute that is read has.
std::size_t components_of(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

template <class T>
T load(const std::byte* data) {
    T value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

/// An integer as glTF reads it: as it is, or with the largest as 1.
template <class T>
float from_integer(const std::byte* data, bool normalized) {
    const auto value = static_cast<double>(load<T>(data));
    if (!normalized) return static_cast<float>(value);
    return static_cast<float>(std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0));
}

/// Where `count` elements lie in a view from `offset` on; nothing where they do not fit.
struct Layout {
    std::size_t offset = 0, count = 0, stride = 0, element = 0;
};
std::optional<Bytes> slice(Bytes view, const Layout& layout) {
    if (layout.count == 0) return view.first(0);
    if (layout.offset > view.size() || layout.element > view.size() - layout.offset) return std::nullopt;
    const std::size_t room = view.size() - layout.offset - layout.element;
    if (layout.count - 1 > room / layout.stride) return std::nullopt;
    return view.subspan(layout.offset, (layout.count - 1) * layout.stride + layout.element);
}

}  // namespace

Result<Accessor> Accessor::open(Document& document, int index, const std::string& place) {
    const auto& accessors = document.model.accessors;
    if (index < 0 || static_cast<std::size_t>(index) >= accessors.size())
        return document.error(place, fmt::format("accessor {} of {}", index, accessors.size()));
    return open_checked(document, index, fmt::format("{} (accessors[{}])", place, index));
}

Result<Accessor> Accessor::open_checked(Document& document, int index, const std::string& place) {
    // See that it is of a type that attributes have.
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
    Accessor result;
    result.component_type_ = accessor.componentType;
    result.component_size_ = size_of(accessor.componentType);
    result.components_ = components_of(accessor.type);
    result.normalized_ = accessor.normalized;
    result.count_ = accessor.count;
    if (result.component_size_ == 0)
        return document.error(place, fmt::format("componentType {} is not read", accessor.componentType));
    if (result.components_ == 0) return document.error(place, "matrices are not read here");
    const std::size_t element = result.component_size_ * result.components_;

    // Find its data, if it has any.
    if (accessor.bufferView >= 0) {
        const auto view = view_bytes(document, accessor.bufferView, place);
        if (!view) return view.error();
        const auto stride = document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        result.stride_ = stride > 0 ? stride : element;
        if (result.stride_ < element)
            return document.error(place, fmt::format("byteStride {} for elements of {} bytes", stride, element));
        const auto data = slice(*view, {accessor.byteOffset, accessor.count, result.stride_, element});
        if (!data)
            return document.error(
                place, fmt::format("{} elements from byte {} on exceed the {} bytes of bufferView {}", accessor.count,
                                   accessor.byteOffset, view->size(), accessor.bufferView));
        result.data_ = *data;
    } else if (accessor.count > k_most_zeros) {
        return document.error(
            place, fmt::format("{} elements without data; at most {} are read", accessor.count, k_most_zeros));
    }
    if (accessor.sparse.isSparse)
        if (const Status s = result.open_sparse(document, index, place + ".sparse"); !s) return s.error();
    return result;
}

Status Accessor::open_sparse(Document& document, int index, const std::string& place) {
    // Both parts are tightly packed.
    const auto& sparse = document.model.accessors[static_cast<std::size_t>(index)].sparse;
    const std::size_t index_size = size_of(sparse.indices.componentType);
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        return document.error(place, "negative numbers");
    if (index_size == 0 || sparse.indices.componentType % 2 == 0)
        return document.error(place, "the indices are not unsigned integers");
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t element = component_size_ * components_;
    const auto index_view = view_bytes(document, sparse.indices.bufferView, place + ".indices");
    if (!index_view) return index_view.error();
    const auto value_view = view_bytes(document, sparse.values.bufferView, place + ".values");
    if (!value_view) return value_view.error();
    const auto indices =
        slice(*index_view, {static_cast<std::size_t>(sparse.indices.byteOffset), count, index_size, index_size});
    const auto values =
        slice(*value_view, {static_cast<std::size_t>(sparse.values.byteOffset), count, element, element});
    if (!indices || !values) return document.error(place, fmt::format("{} elements exceed their bufferViews", count));
    sparse_values_ = *values;

    // Look at the indices once, however many primitives ask for them.
    auto& known = document.sparse_indices[index];
    sparse_indices_ = known;
    if (known) return Done{};
    if (count > document.sparse_left) return document.error(place, "too many sparse elements in all");
    document.sparse_left -= count;
    std::vector<std::uint32_t> ascending;
    ascending.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::byte* data = indices->data() + i * index_size;
        const std::uint32_t at = index_size == 1   ? load<std::uint8_t>(data)
                                 : index_size == 2 ? load<std::uint16_t>(data)
                                                   : load<std::uint32_t>(data);
        if (at >= count_ || (i > 0 && at <= ascending.back()))
            return document.error(place + ".indices",
                                  fmt::format("element {} is {}: not ascending below {}", i, at, count_));
        ascending.push_back(at);
    }
    sparse_indices_ = known = std::make_shared<const std::vector<std::uint32_t>>(std::move(ascending));
    return Done{};
}

const std::byte* Accessor::element(std::size_t i) const {
    if (sparse_indices_) {
        const auto found = std::lower_bound(sparse_indices_->begin(), sparse_indices_->end(), i);
        if (found != sparse_indices_->end() && *found == i)
            return sparse_values_.data() +
                   static_cast<std::size_t>(found - sparse_indices_->begin()) * component_size_ * components_;
    }
    return data_.empty() ? nullptr : data_.data() + i * stride_;
}

float Accessor::component(const std::byte* data) const {
    switch (component_type_) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return from_integer<std::int8_t>(data, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return from_integer<std::uint8_t>(data, normalized_);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return from_integer<std::int16_t>(data, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return from_integer<std::uint16_t>(data, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return from_integer<std::uint32_t>(data, normalized_);
        default:
            return load<float>(data);
    }
}

std::array<float, 4> Accessor::operator[](std::size_t i) const {
    assert(i < count_);
    std::array<float, 4> values{};
    if (const std::byte* data = element(i))
        for (std::size_t k = 0; k < components_; ++k) values[k] = component(data + k * component_size_);
    return values;
}

bool Accessor::is_unsigned() const { return is_integer() && component_type_ % 2 == 1; }

std::uint32_t Accessor::index_at(std::size_t i) const {
    assert(i < count_ && is_unsigned());
    const std::byte* data = element(i);
    if (data == nullptr) return 0;
    if (component_size_ == 1) return load<std::uint8_t>(data);
    return component_size_ == 2 ? load<std::uint16_t>(data) : load<std::uint32_t>(data);
}

}  // namespace lobelia::gltf
