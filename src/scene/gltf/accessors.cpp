// Accessors of a glTF file: typed views of its buffers, read element by element.
#include "scene/gltf/accessors.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>

namespace lobelia::gltf {
namespace {

/// Limit of accessors without data, whose elements are zeros: more is useless, and costs memory without any bytes in
/// the file.
constexpr std::size_t k_most_zeros = std::size_t{1} << 20;

std::size_t size_of(std::size_t component_type) {
    switch (component_type) {
        case k_byte:
        case k_unsigned_byte:
            return 1;
        case k_short:
        case k_unsigned_short:
            return 2;
        case k_unsigned_int:
        case k_float:
            return 4;
        default:
            return 0;
    }
}

/// Returns the number of components; 0 for unsupported types.
std::size_t components_of(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    return type == "MAT4" ? 16 : 0;
}

template <class T>
T load(const std::byte* data) {
    T value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

std::uint32_t load_unsigned(const std::byte* data, std::size_t size) {
    if (size == 1) return load<std::uint8_t>(data);
    return size == 2 ? load<std::uint16_t>(data) : load<std::uint32_t>(data);
}

/// Converts an integer, or normalises it: the largest becomes 1.
template <class T>
float from_integer(const std::byte* data, bool normalized) {
    const auto value = static_cast<double>(load<T>(data));
    if (!normalized) return static_cast<float>(value);
    return static_cast<float>(std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0));
}

/// Layout of `count` elements in a view from `offset` on; nothing if they do not fit.
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

std::size_t offset_of(const JsonPlace& object) {
    const auto offset = object.find("byteOffset");
    return offset ? offset->whole(0, ~std::uint64_t{0}) : 0;
}

}  // namespace

Accessor::Accessor(Document& document, const JsonPlace& index, std::size_t most_components) {
    // Check its type.
    const std::size_t number = whole(index);
    if (number >= document.accessors.size())
        index.refuse(fmt::format("accessor {} of {}", number, document.accessors.size()));
    const JsonPlace& accessor = document.accessors[number];
    const auto refuse = [&](std::string_view what) {
        document.refuse(fmt::format("{} (accessors[{}])", index.path(), number), what);
    };
    component_type_ = whole(accessor.at("componentType"));
    component_size_ = size_of(component_type_);
    components_ = components_of(accessor.at("type").long_text());
    if (const auto normalized = accessor.find("normalized")) normalized_ = normalized->flag();
    count_ = whole(accessor.at("count"));
    if (component_size_ == 0) refuse(fmt::format("componentType {} is not supported", component_type_));
    if (components_ == 0 || components_ > most_components) refuse("matrices are not supported here");
    const std::size_t element = component_size_ * components_;

    // Find its data, if it has any.
    if (const auto view_index = accessor.find("bufferView")) {
        const Bytes view = view_bytes(document, *view_index);
        const auto stride = document.buffer_views[whole(*view_index)].find("byteStride");
        stride_ = stride ? whole(*stride) : element;
        if (stride_ < element) refuse(fmt::format("byteStride {} for elements of {} bytes", stride_, element));
        const std::size_t offset = offset_of(accessor);
        const auto data = slice(view, {offset, count_, stride_, element});
        if (!data)
            refuse(fmt::format("{} elements from byte {} on exceed the {} bytes of bufferView {}", count_, offset,
                               view.size(), whole(*view_index)));
        data_ = *data;
    } else if (count_ > k_most_zeros) {
        refuse(fmt::format("{} elements without data; at most {} are read", count_, k_most_zeros));
    }
    if (const auto sparse = accessor.find("sparse")) open_sparse(document, *sparse, number);
}

void Accessor::open_sparse(Document& document, const JsonPlace& sparse, std::size_t accessor) {
    // Both parts are tightly packed.
    const JsonPlace indices = sparse.at("indices"), values = sparse.at("values");
    const std::size_t index_type = whole(indices.at("componentType")), index_size = size_of(index_type);
    if (index_type != k_unsigned_byte && index_type != k_unsigned_short && index_type != k_unsigned_int)
        sparse.refuse("the indices are not unsigned integers");
    const std::size_t count = whole(sparse.at("count")), element = component_size_ * components_;
    const Bytes index_view = view_bytes(document, indices.at("bufferView"));
    const Bytes value_view = view_bytes(document, values.at("bufferView"));
    const auto index_data = slice(index_view, {offset_of(indices), count, index_size, index_size});
    const auto value_data = slice(value_view, {offset_of(values), count, element, element});
    if (!index_data || !value_data) sparse.refuse(fmt::format("{} elements exceed their bufferViews", count));
    sparse_values_ = *value_data;

    // Read the indices once, however many primitives use them.
    auto& known = document.sparse_indices[accessor];
    sparse_indices_ = known;
    if (known) return;
    document.keep(sparse, count, sizeof(std::uint32_t));
    document.work(sparse, count);
    std::vector<std::uint32_t> ascending;
    ascending.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = load_unsigned(index_data->data() + i * index_size, index_size);
        if (at >= count_ || (i > 0 && at <= ascending.back()))
            indices.refuse(fmt::format("element {} is {}: not ascending below {}", i, at, count_));
        ascending.push_back(at);
    }
    sparse_indices_ = known = std::make_shared<const std::vector<std::uint32_t>>(std::move(ascending));
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
        case k_byte:
            return from_integer<std::int8_t>(data, normalized_);
        case k_unsigned_byte:
            return from_integer<std::uint8_t>(data, normalized_);
        case k_short:
            return from_integer<std::int16_t>(data, normalized_);
        case k_unsigned_short:
            return from_integer<std::uint16_t>(data, normalized_);
        case k_unsigned_int:
            return from_integer<std::uint32_t>(data, normalized_);
        default:
            return load<float>(data);
    }
}

void Accessor::get(std::size_t i, std::span<float> values) const {
    assert(i < count_);
    const std::byte* data = element(i);
    for (std::size_t k = 0; k < std::min(values.size(), components_); ++k)
        values[k] = data != nullptr ? component(data + k * component_size_) : 0;
}

std::array<float, 4> Accessor::operator[](std::size_t i) const {
    std::array<float, 4> values{};
    get(i, values);
    return values;
}

bool Accessor::is_unsigned() const {
    return component_type_ == k_unsigned_byte || component_type_ == k_unsigned_short ||
           component_type_ == k_unsigned_int;
}

std::uint32_t Accessor::index_at(std::size_t i, std::size_t k) const {
    assert(i < count_ && k < components_ && is_unsigned());
    const std::byte* data = element(i);
    return data == nullptr ? 0 : load_unsigned(data + k * component_size_, component_size_);
}

}  // namespace lobelia::gltf
