// NumPy arrays on one side, planes and colours on the other; errors as exceptions.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lobelia/lobelia.h"

namespace lobelia::python {

namespace py = pybind11;

/// Any array-like of numbers, as contiguous float32.
using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// lobelia.Error: bad input, with the message of the library.
struct BadInput : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// The value, or BadInput.
template <class T>
[[nodiscard]] T value_or_throw(Result<T> result) {
    if (!result) throw BadInput(result.error().message);
    return *std::move(result);
}

/// Number of triples in an array of shape (..., 3); BadInput, with its name, for another shape.
[[nodiscard]] std::size_t triples(const FloatArray& array, const char* name);

/// Copies an array of shape (..., 3) into planes.
[[nodiscard]] Planes<3> to_planes(const FloatArray& array, const char* name);

/// A new array of the same shape.
[[nodiscard]] py::array_t<float> from_planes(const Planes<3>& planes, const FloatArray& like);

/// Views a (n, 3) array as colours; BadInput unless n is `count`.
[[nodiscard]] std::span<const Rgb> to_colours(const FloatArray& array, std::size_t count, const char* name);

/// A new (n, 3) array.
[[nodiscard]] py::array_t<float> from_colours(std::span<const Rgb> colours);

/// A read-only array of `shape` over memory that belongs to `owner`, without a copy.
template <class T>
[[nodiscard]] py::array view_of(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
    py::array array(py::dtype::of<T>(), std::move(shape), data, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// Samples from directions and radiance of shape (n, 3) and solid angles of shape (n,), or equal shares of the domain.
[[nodiscard]] Samples to_samples(const FloatArray& directions, const FloatArray& radiance,
                                 const std::optional<FloatArray>& solid_angles, Domain domain);

// The parts of the module, one file each.
void add_environment(py::module_& module);
void add_codec(py::module_& module);
void add_storage(py::module_& module);
void add_scene(py::module_& module);
void add_bake(py::module_& module);

}  // namespace lobelia::python
