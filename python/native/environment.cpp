// lobelia.Environment.
#include "environment.h"
#include "arrays.h"
#include "io/read_image.h"

namespace lobelia::python {
namespace {

Environment load(const std::filesystem::path& path, bool ldr, bool sanitize) {
    ReadOptions options;
    options.ldr = ldr;
    options.sanitize = sanitize;
    py::gil_scoped_release released;
    return {std::make_shared<Image>(value_or_throw(read_environment(path, options)).image)};
}

Environment make_sky(std::pair<std::size_t, std::size_t> size, double turbidity, double sun_elevation,
                     double sun_azimuth, double ground_albedo) {
    const auto [width, height] = size;
    if (width < 1 || height < 1 || width > 65536 || height > 65536)
        throw BadInput("size: width and height must be in 1 to 65536");
    SkyOptions options;
    options.turbidity = turbidity;
    options.sun_elevation = sun_elevation;
    options.sun_azimuth = sun_azimuth;
    options.ground_albedo = ground_albedo;
    if (const auto status = check(options); !status) throw BadInput(status.error().message);
    py::gil_scoped_release released;
    return {std::make_shared<Image>(sky({width, height}, options))};
}

Environment from_pixels(const FloatArray& pixels) {
    if (pixels.ndim() != 3 || pixels.shape(2) != 3 || pixels.size() == 0)
        throw BadInput("pixels: an array of shape (height, width, 3) is required");
    auto image =
        std::make_shared<Image>(static_cast<std::size_t>(pixels.shape(1)), static_cast<std::size_t>(pixels.shape(0)));
    const float* from = pixels.data();
    for (py::ssize_t i = 0; i < pixels.size(); ++i)
        if (!(from[i] >= 0 && std::isfinite(from[i]))) throw BadInput("pixels: NaN, infinite or negative values");
    std::copy_n(reinterpret_cast<const Rgb*>(from), image->pixels.size(), image->pixels.begin());
    return {std::move(image)};
}

py::array_t<float> irradiance(const Environment& environment, const FloatArray& normals) {
    const Directions n = to_planes(normals, "normals");
    Colours E(n.size());
    {
        py::gil_scoped_release released;
        irradiance_sum(texel_samples(*environment.image), n, E);
    }
    return from_planes(E, normals);
}

}  // namespace

void add_environment(py::module_& module) {
    py::class_<Environment>(module, "Environment", "A latitude-longitude image of radiance [W/(m^2 sr)]; y is up.")
        .def(py::init(&from_pixels), py::arg("pixels"), "Copies an array of shape (height, width, 3).")
        .def_static("load", &load, py::arg("path"), py::kw_only(), py::arg("ldr") = false, py::arg("sanitize") = false,
                    "Reads a Radiance .hdr or OpenEXR file. ldr: accept PNG, JPEG and WebP, too, decoded from sRGB. "
                    "sanitize: replace NaN, infinite and negative components by 0 instead of raising Error.")
        .def_static(
            "sky", &make_sky, py::arg("size") = std::pair(512, 256), py::kw_only(),
            py::arg("turbidity") = SkyOptions{}.turbidity, py::arg("sun_elevation") = SkyOptions{}.sun_elevation,
            py::arg("sun_azimuth") = SkyOptions{}.sun_azimuth, py::arg("ground_albedo") = SkyOptions{}.ground_albedo,
            "Makes a clear sky with its sun; size is (width, height), angles are in degrees.")
        .def_property_readonly(
            "pixels",
            [](const py::object& self) {
                const Image& image = *self.cast<const Environment&>().image;
                return view_of(&image.pixels.data()->r,
                               {static_cast<py::ssize_t>(image.height), static_cast<py::ssize_t>(image.width), 3},
                               self);
            },
            "The radiance as a read-only array of shape (height, width, 3), not copied.")
        .def("irradiance", &irradiance, py::arg("normals"),
             "Computes the exact irradiance [W/m^2] at normals of shape (..., 3).")
        .def("__repr__", [](const Environment& e) {
            return "<lobelia.Environment " + std::to_string(e.image->width) + "x" + std::to_string(e.image->height) +
                   ">";
        });
}

}  // namespace lobelia::python
