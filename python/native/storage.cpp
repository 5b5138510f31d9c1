// lobelia.pack and what it makes: coefficients of texels as textures.
#include "lobelia/storage.h"

#include "arrays.h"
#include "lobelia/codec.h"

namespace lobelia::python {
namespace {

struct Textures {
    TextureLayout layout;
    std::vector<PackedTexture> textures;
    std::size_t width = 0, height = 0;
};

using Buffer = std::vector<std::vector<float>>;

Textures pack_coefficients(const Codec& codec, const FloatArray& coefficients, const std::string& storage) {
    const CoefficientTraits traits = coefficient_traits(*codec.encoder());
    const auto found = value_or_throw(find_storages({&storage, 1}, traits));
    if (coefficients.ndim() != 4 || coefficients.shape(3) != 3 || coefficients.size() == 0 ||
        coefficients.shape(2) != static_cast<py::ssize_t>(traits.count))
        throw BadInput("coefficients: an array of shape (height, width, " + std::to_string(traits.count) +
                       ", 3) is required");
    Textures result{found.front()->layout(traits),
                    {},
                    static_cast<std::size_t>(coefficients.shape(1)),
                    static_cast<std::size_t>(coefficients.shape(0))};
    const float* from = coefficients.data();
    py::gil_scoped_release released;
    const std::size_t texels = result.width * result.height;
    Buffer planes(3 * traits.count, std::vector<float>(texels));
    for (std::size_t t = 0; t < texels; ++t)
        for (auto& plane : planes) plane[t] = *from++;
    result.textures =
        pack(result.layout, CoefficientPlanes(result.width, result.height, std::span(planes), traits.count));
    return result;
}

py::array_t<float> unpack_coefficients(const Textures& self) {
    const std::size_t count = self.layout.coefficients, texels = self.width * self.height;
    Buffer planes(3 * count, std::vector<float>(texels));
    unpack(self.layout, self.textures, MutableCoefficientPlanes(self.width, self.height, std::span(planes), count));
    py::array_t<float> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(self.height),
                                                      static_cast<py::ssize_t>(self.width),
                                                      static_cast<py::ssize_t>(count), 3});
    float* to = array.mutable_data();
    for (std::size_t t = 0; t < texels; ++t)
        for (const auto& plane : planes) *to++ = plane[t];
    return array;
}

py::object texture_at(const py::object& self, py::ssize_t index) {
    const auto& textures = self.cast<const Textures&>().textures;
    const auto count = static_cast<py::ssize_t>(textures.size());
    if (index < 0) index += count;
    if (index < 0 || index >= count) throw py::index_error();
    return py::cast(&textures[static_cast<std::size_t>(index)], py::return_value_policy::reference_internal, self);
}

}  // namespace

void add_storage(py::module_& module) {
    py::class_<PackedTexture>(module, "Texture", "One texture, as graphics interfaces take it.")
        .def_readonly("name", &PackedTexture::name)
        .def_property_readonly(
            "format", [](const PackedTexture& t) { return info(t.format).name; }, "Such as \"rgba16f\".")
        .def_property_readonly("vk_format", [](const PackedTexture& t) { return info(t.format).vk_format; })
        .def_readonly("width", &PackedTexture::width)
        .def_readonly("height", &PackedTexture::height)
        .def_readonly("scale", &PackedTexture::scale, "Factor of stored values, before offset and scale of a channel.")
        .def_property_readonly(
            "data",
            [](const py::object& self) {
                const auto& data = self.cast<const PackedTexture&>().data;
                return view_of(reinterpret_cast<const std::uint8_t*>(data.data()),
                               {static_cast<py::ssize_t>(data.size())}, self);
            },
            "Its bytes as a read-only array, not copied.");
    py::class_<Textures>(module, "Textures", "The textures of one storage; a sequence of Texture.")
        .def("__len__", [](const Textures& self) { return self.textures.size(); })
        .def("__getitem__", &texture_at, py::arg("index"))
        .def("unpack", &unpack_coefficients, "Returns coefficients of shape (height, width, size, 3).");
    module.def("pack", &pack_coefficients, py::arg("codec"), py::arg("coefficients"), py::arg("storage"),
               "Packs coefficients of shape (height, width, size, 3) into textures.");
    module.def(
        "storage_names",
        [](const std::optional<Codec>& codec) {
            std::vector<std::string> names;
            for (const Storage& storage : storages())
                if (!codec || suits(storage, coefficient_traits(*codec->encoder()))) names.emplace_back(storage.name);
            return names;
        },
        py::arg("codec") = py::none(), "Names of all storages, or of those that the codec's coefficients fit.");
}

}  // namespace lobelia::python
