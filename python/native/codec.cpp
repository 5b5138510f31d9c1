// lobelia.Codec, lobelia.Accumulator, lobelia.Errors.
#include "lobelia/codec.h"

#include "arrays.h"
#include "environment.h"

namespace lobelia::python {
namespace {

/// An accumulator and whose it is.
struct CodecAccumulator {
    Codec codec;
    Accumulator accumulator{codec.encoder()};
};

py::array_t<float> encode_environment(const Codec& codec, const Environment& environment) {
    std::vector<Rgb> c;
    {
        py::gil_scoped_release released;
        // Encoders that learn as they go require texels in an order that is spread over the image.
        c = codec.encode(shuffled_texel_samples(*environment.image, codec.basis().domain(), 1));
    }
    return from_colours(c);
}

py::array_t<float> encode_samples(const Codec& codec, const FloatArray& directions, const FloatArray& radiance,
                                  const std::optional<FloatArray>& solid_angles) {
    const Samples samples = to_samples(directions, radiance, solid_angles, codec.basis().domain());
    std::vector<Rgb> c;
    {
        py::gil_scoped_release released;
        c = codec.encode(samples);
    }
    return from_colours(c);
}

using Evaluation = void (Codec::*)(std::span<const Rgb>, DirectionView, MutableColourView) const;

/// Evaluates `codec`.*method at directions of shape (..., 3).
template <Evaluation method>
py::array_t<float> evaluate_codec(const Codec& codec, const FloatArray& coefficients, const FloatArray& directions) {
    const auto c = to_colours(coefficients, codec.basis().size(), "coefficients");
    const Directions at = to_planes(directions, "directions");
    Colours out(at.size());
    {
        py::gil_scoped_release released;
        (codec.*method)(c, at, out);
    }
    return from_planes(out, directions);
}

void add_samples(CodecAccumulator& self, const FloatArray& directions, const FloatArray& radiance,
                 const std::optional<FloatArray>& solid_angles) {
    const Samples samples = to_samples(directions, radiance, solid_angles, self.codec.basis().domain());
    py::gil_scoped_release released;
    self.accumulator.add(samples);
}

void merge(CodecAccumulator& self, const CodecAccumulator& other) {
    if (self.codec.name() != other.codec.name())
        throw BadInput("merge: codecs differ, " + self.codec.name().str() + " and " + other.codec.name().str());
    self.accumulator.merge(other.accumulator);
}

Errors measure(const FloatArray& colours, const FloatArray& reference, const std::optional<FloatArray>& weights) {
    const Colours a = to_planes(colours, "colours"), r = to_planes(reference, "reference");
    if (a.size() != r.size()) throw BadInput("reference: as many entries as colours are required");
    if (weights && static_cast<std::size_t>(weights->size()) != a.size())
        throw BadInput("weights: as many entries as colours are required");
    const std::vector<float> equal(weights ? 0 : a.size(), 1.0f);
    return errors(a, r, weights ? std::span<const float>(weights->data(), a.size()) : std::span(equal));
}

void add_codec_class(py::module_& module) {
    py::class_<Codec>(module, "Codec",
                      "A basis, an encoder and an evaluator, made from their names: "
                      "\"sg12/least-squares/hill\" (see codec_names). Immutable.")
        .def(py::init([](const std::string& name) { return value_or_throw(make_codec(name)); }), py::arg("name"))
        .def_property_readonly("name", [](const Codec& codec) { return codec.name().str(); })
        .def_property_readonly(
            "size", [](const Codec& codec) { return codec.basis().size(); }, "Number of coefficients.")
        .def_property_readonly(
            "domain",
            [](const Codec& codec) { return codec.basis().domain() == Domain::sphere ? "sphere" : "hemisphere"; },
            "\"sphere\" (world axes, y up) or \"hemisphere\" (tangent frame, z >= 0).")
        .def("encode", &encode_environment, py::arg("environment"),
             "Encodes all texels of an environment; returns coefficients of shape (size, 3).")
        .def("encode", &encode_samples, py::arg("directions"), py::arg("radiance"),
             py::arg("solid_angles") = py::none(),
             "Encodes samples of shape (n, 3); solid_angles default to equal shares of the domain.")
        .def("radiance", &evaluate_codec<&Codec::radiance>, py::arg("coefficients"), py::arg("directions"),
             "Evaluates radiance [W/(m^2 sr)] at unit directions of shape (..., 3).")
        .def("irradiance", &evaluate_codec<&Codec::irradiance>, py::arg("coefficients"), py::arg("normals"),
             "Evaluates irradiance [W/m^2], not divided by pi, at unit normals of shape (..., 3).")
        .def(
            "accumulator", [](const Codec& codec) { return CodecAccumulator{codec}; },
            "Makes an empty accumulator for samples that arrive in parts.")
        .def("__repr__", [](const Codec& codec) { return "<lobelia.Codec " + codec.name().str() + ">"; });
}

void add_accumulator(py::module_& module) {
    py::class_<CodecAccumulator>(module, "Accumulator", "The state of an encoder: add, merge, solve.")
        .def("add", &add_samples, py::arg("directions"), py::arg("radiance"), py::arg("solid_angles") = py::none(),
             "Adds samples of shape (n, 3).")
        .def("merge", &merge, py::arg("other"), "Adds what another accumulator of the same codec has seen.")
        .def(
            "solve", [](const CodecAccumulator& self) { return from_colours(self.accumulator.solve()); },
            "Returns coefficients of shape (size, 3); zeros if there was no sample.")
        .def_property_readonly(
            "state",
            [](const py::object& self) {
                const auto state = self.cast<const CodecAccumulator&>().accumulator.state();
                return view_of(state.data(), {static_cast<py::ssize_t>(state.size())}, self);
            },
            "The state as a read-only array, not copied.");
}

}  // namespace

void add_codec(py::module_& module) {
    add_codec_class(module);
    add_accumulator(module);
    module.def(
        "codec_names",
        [] {
            std::vector<std::string> names;
            for (const CodecName& name : all_codecs()) names.push_back(name.str());
            return names;
        },
        "Names of all listed codecs; whole families of bases are known beyond the list, such as \"sg24\".");
    module.def("default_codec", &default_codec, "The codec for lightmap texels and probes unless another is named.");

    py::class_<Errors>(module, "Errors", "Errors of colours against a reference, over all entries and channels.")
        .def_readonly("rms", &Errors::rms, "Weighted root mean square error.")
        .def_readonly("smape", &Errors::smape, "Weighted mean of |a - r| / (|a| + |r|).")
        .def_readonly("relmse", &Errors::relmse, "Weighted mean of (a - r)^2 / (r^2 + 0.01).")
        .def_readonly("negative_share", &Errors::negative_share, "Weighted share of entries below 0.")
        .def_readonly("worst", &Errors::worst, "Largest error of one entry.")
        .def_readonly("worst_index", &Errors::worst_index, "Index of that entry.");
    module.def("errors", &measure, py::arg("colours"), py::arg("reference"), py::arg("weights") = py::none(),
               "Measures colours against a reference, both of shape (..., 3).");
}

}  // namespace lobelia::python
