// The extension module lobelia._native; python/src/lobelia/__init__.py is what people import.
#include "arrays.h"

namespace lobelia::python {

std::size_t triples(const FloatArray& array, const char* name) {
    if (array.ndim() < 1 || array.shape(array.ndim() - 1) != 3)
        throw BadInput(std::string(name) + ": an array of shape (..., 3) is required");
    return static_cast<std::size_t>(array.size()) / 3;
}

Planes<3> to_planes(const FloatArray& array, const char* name) {
    Planes<3> planes(triples(array, name));
    const float* from = array.data();
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) planes.channel(k)[i] = from[3 * i + k];
    return planes;
}

py::array_t<float> from_planes(const Planes<3>& planes, const FloatArray& like) {
    py::array_t<float> array(std::vector<py::ssize_t>(like.shape(), like.shape() + like.ndim()));
    float* to = array.mutable_data();
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) to[3 * i + k] = planes.channel(k)[i];
    return array;
}

std::span<const Rgb> to_colours(const FloatArray& array, std::size_t count, const char* name) {
    if (array.ndim() != 2 || array.shape(1) != 3 || array.shape(0) != static_cast<py::ssize_t>(count))
        throw BadInput(std::string(name) + ": an array of shape (" + std::to_string(count) + ", 3) is required");
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    return {reinterpret_cast<const Rgb*>(array.data()), count};
}

py::array_t<float> from_colours(std::span<const Rgb> colours) {
    py::array_t<float> array({static_cast<py::ssize_t>(colours.size()), py::ssize_t{3}});
    std::copy(colours.begin(), colours.end(), reinterpret_cast<Rgb*>(array.mutable_data()));
    return array;
}

Samples to_samples(const FloatArray& directions, const FloatArray& radiance,
                   const std::optional<FloatArray>& solid_angles, Domain domain) {
    const std::size_t count = triples(directions, "directions");
    if (triples(radiance, "radiance") != count) throw BadInput("radiance: as many entries as directions are required");
    if (solid_angles && static_cast<std::size_t>(solid_angles->size()) != count)
        throw BadInput("solid_angles: as many entries as directions are required");
    const float share = count == 0 ? 0 : static_cast<float>(solid_angle(domain) / static_cast<double>(count));
    Samples samples(count);
    const float *d = directions.data(), *L = radiance.data();
    for (std::size_t i = 0; i < count; ++i, d += 3, L += 3)
        samples.set(i, {{d[0], d[1], d[2]}, {L[0], L[1], L[2]}, solid_angles ? solid_angles->data()[i] : share});
    return samples;
}

}  // namespace lobelia::python

PYBIND11_MODULE(_native, module) {
    using namespace lobelia::python;
    module.attr("__version__") = LOBELIA_VERSION;
    // Shapes are checked before the library is called; what a check here overlooks is a ValueError, too, not an abort.
    lobelia::set_contract_handler(
        [](const lobelia::ContractViolation& violation) { throw std::invalid_argument(violation.str()); });
    pybind11::register_exception<BadInput>(module, "Error", PyExc_ValueError).attr("__doc__") =
        "Bad input: a file, a name, an option or the shape of an array; the message names the place and the remedy.";
    add_environment(module);
    add_codec(module);
    add_storage(module);
    add_scene(module);
    add_bake(module);
}
