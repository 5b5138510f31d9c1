// lobelia.Scene, from glTF files or made by code.
#include "scene.h"

#include "arrays.h"
#include "environment.h"
#include "scene/embedded.h"
#include "scene/sky_light.h"

namespace lobelia::python {
namespace {

SceneHandle read(const std::filesystem::path& path, std::size_t uv_set, bool photometric,
                 std::optional<std::size_t> scene_memory) {
    GltfReadOptions options;
    options.uv_set = uv_set;
    options.scene_memory = scene_memory;
    if (photometric) options.units = GltfReadOptions::Units::photometric;
    py::gil_scoped_release released;
    auto loaded = std::make_shared<LoadedScene>(value_or_throw(read_gltf(path, options)));
    loaded->source.path = path.string();
    loaded->source.uv_set = uv_set;
    loaded->source.photometric = photometric ? Switch::on : Switch::off;
    return {std::move(loaded)};
}

SceneHandle make_embedded(const std::string& name) {
    auto loaded = std::make_shared<LoadedScene>();
    loaded->scene = value_or_throw(embedded_scene(name));
    loaded->source.path = name;
    return {std::move(loaded)};
}

void set_scene_sky(SceneHandle& self, double turbidity, double sun_elevation, double sun_azimuth) {
    SkyOptions options;
    options.turbidity = turbidity;
    options.sun_elevation = sun_elevation;
    options.sun_azimuth = sun_azimuth;
    if (const auto status = check(options); !status) throw BadInput(status.error().message);
    self.change([&](LoadedScene& loaded) {
        set_sky(loaded.scene, options);
        loaded.source.environment.reset();
        loaded.source.turbidity = turbidity;
        loaded.source.sun_elevation = sun_elevation;
        loaded.source.sun_azimuth = sun_azimuth;
    });
}

std::vector<std::string> object_names(const SceneHandle& self) {
    std::vector<std::string> names;
    for (const Object& object : self.loaded->scene.objects) names.push_back(object.name);
    return names;
}

std::optional<Environment> environment_of(const SceneHandle& self) {
    const auto& environment = self.loaded->scene.environment;
    if (!environment) return {};
    return Environment{std::make_shared<Image>(*environment)};
}

void set_environment(SceneHandle& self, const std::optional<Environment>& environment) {
    self.change([&](LoadedScene& loaded) {
        loaded.scene.environment.reset();
        if (environment) loaded.scene.environment = *environment->image;
        // An image in memory has no name for the command line.
        loaded.source = {};
    });
}

}  // namespace

void add_scene(py::module_& module) {
    py::class_<SceneHandle>(module, "Scene", "What is baked: meshes, materials, lights, an environment.")
        .def_property_readonly("name", [](const SceneHandle& s) { return s.loaded->scene.name; })
        .def_property_readonly("objects", &object_names, "Names of the objects.")
        .def_property_readonly(
            "triangles",
            [](const SceneHandle& s) {
                std::size_t count = 0;
                for (const Object& object : s.loaded->scene.objects)
                    count += s.loaded->scene.meshes[object.mesh].triangles.size();
                return count;
            },
            "Number of triangles of all objects.")
        .def_property_readonly(
            "warnings", [](const SceneHandle& s) { return s.loaded->warnings; },
            "What the reader of the file reports: content that is ignored, and the like.")
        .def_property("environment", &environment_of, &set_environment,
                      "A copy of the Environment around the scene, or None.")
        .def("set_sky", &set_scene_sky, py::kw_only(), py::arg("turbidity") = SkyOptions{}.turbidity,
             py::arg("sun_elevation") = SkyOptions{}.sun_elevation, py::arg("sun_azimuth") = SkyOptions{}.sun_azimuth,
             "Surrounds the scene with the embedded sky; its sun replaces directional lights.")
        .def("__repr__", [](const SceneHandle& s) { return "<lobelia.Scene \"" + s.loaded->scene.name + "\">"; });
    module.def("read_gltf", &read, py::arg("path"), py::kw_only(), py::arg("uv_set") = 1,
               py::arg("photometric") = false, py::arg("scene_memory") = py::none(),
               "Reads a .gltf or .glb file. uv_set: the TEXCOORD with the lightmap UVs; photometric: lights and "
               "emission are in lux, candela and nits; scene_memory: bytes that the scene may take with all its copies "
               "(None: 1 GiB and 256 times the size of its files).");
    module.def("embedded_scene", &make_embedded, py::arg("name"),
               "Makes a scene by code: \"cornell\", \"colonnade\" and others of embedded_scene_names().");
    module.def("embedded_scene_names", [] {
        const auto names = embedded_scene_names();
        return std::vector<std::string>(names.begin(), names.end());
    });
}

}  // namespace lobelia::python
