// lobelia.bake and its result.
#include "lobelia/bake.h"

#include "arrays.h"
#include "interruptible.h"
#include "scene.h"

namespace lobelia::python {
namespace {

/// Shared by the pages that Python holds.
using BakeHandle = std::shared_ptr<Bake>;

struct PageHandle {
    BakeHandle bake;
    std::size_t index = 0;
    [[nodiscard]] const LightmapPage& page() const { return bake->pages[index]; }
    [[nodiscard]] std::vector<py::ssize_t> shape() const {
        return {static_cast<py::ssize_t>(page().height), static_cast<py::ssize_t>(page().width)};
    }
};

/// One of `names`, by its place in the list.
template <class Choice>
Choice choose(const char* option, const std::string& value, std::initializer_list<std::pair<const char*, Choice>> all) {
    std::string names;
    for (const auto& [name, choice] : all) {
        if (value == name) return choice;
        names += std::string(names.empty() ? "" : ", ") + name;
    }
    throw BadInput(std::string(option) + ": \"" + value + "\" is not one of " + names);
}

Switch to_switch(bool on) { return on ? Switch::on : Switch::off; }

BakeJob to_job(const py::kwargs& options) {
    BakeJob job;
    BakeOptions& bake = job.bake;
    const auto set = [&](const char* name, auto& to) {
        if (!options[name].is_none()) to = options[name].cast<std::remove_reference_t<decltype(to)>>();
    };
    const auto set_switch = [&](const char* name, Switch& to) { to = to_switch(options[name].cast<bool>()); };
    set("codec", bake.codec);
    const auto [width, height] = options["size"].cast<std::pair<std::size_t, std::size_t>>();
    bake.atlas.width = width;
    bake.atlas.height = height;
    set("texels_per_metre", bake.atlas.texels_per_metre);
    set("samples", bake.samples);
    set("bounces", bake.paths.bounces);
    set("seed", bake.paths.seed);
    set("threads", bake.threads);
    set("memory", bake.memory);
    set("time", bake.most_seconds);
    set("target_error", bake.target_error);
    bake.frame = choose<Frame>("frame", options["frame"].cast<std::string>(),
                               {{"world", Frame::world}, {"tangent", Frame::tangent}});
    bake.directions =
        choose<DirectionChoice>("directions", options["directions"].cast<std::string>(),
                                {{"uniform", DirectionChoice::uniform}, {"mixture", DirectionChoice::mixture}});
    set_switch("denoise", job.finish.denoise);
    set_switch("seams", job.finish.seams);
    set_switch("dilate", job.finish.dilate);
    set_switch("push_out", bake.push_out);
    job.precision = choose<Precision>("precision", options["precision"].cast<std::string>(),
                                      {{"half", Precision::half}, {"float", Precision::full}});
    set("storages", job.textures.storages);
    set("container", job.textures.container);
    set_switch("texture_arrays", job.textures.arrays);
    set("mip_levels", job.textures.levels);
    set_switch("zstd", job.textures.zstd);
    if (!options["probe_spacing"].is_none()) set("probe_spacing", job.probes.emplace().spacing);
    job.report.write = Switch::off;
    return job;
}

BakeHandle run(const SceneHandle& scene, const std::optional<std::filesystem::path>& folder, bool resume,
               const py::object& progress, BakeJob job) {
    // Hold the scene: Python may drop it, or give it another environment.
    const auto held = scene.loaded;
    job.scene = held->source;
    return run_interruptibly<BakeProgress>(progress, [&](const std::atomic<bool>& stop, const auto& report) {
        BakeSession session;
        if (folder) session.folder = *folder;
        session.start = resume ? BakeSession::Start::resume : BakeSession::Start::fresh;
        session.stop = &stop;
        session.progress = report;
        session.earlier_warnings = held->warnings;
        return std::make_shared<Bake>(value_or_throw(bake(held->scene, job, session)));
    });
}

py::object bake_in_python(const SceneHandle& scene, const std::optional<std::filesystem::path>& folder, bool resume,
                          const py::object& progress, const py::kwargs& options) {
    return py::cast(run(scene, folder, resume, progress, to_job(options)));
}

std::vector<PageHandle> pages_of(const BakeHandle& bake) {
    std::vector<PageHandle> pages;
    for (std::size_t i = 0; i < bake->pages.size(); ++i) pages.push_back({bake, i});
    return pages;
}

py::array channel(const py::object& self, const std::string& name) {
    const auto& handle = self.cast<const PageHandle&>();
    const auto names = handle.bake->channels().names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw py::key_error(name);
    return view_of(handle.page().planes[static_cast<std::size_t>(found - names.begin())].data(), handle.shape(), self);
}

/// Planes [first, first + 3 * count) as (height, width, count, 3).
py::array_t<float> colours_of(const PageHandle& handle, std::size_t first, std::size_t count) {
    const LightmapPage& page = handle.page();
    auto shape = handle.shape();
    shape.insert(shape.end(), {static_cast<py::ssize_t>(count), 3});
    py::array_t<float> array(shape);
    float* to = array.mutable_data();
    for (std::size_t t = 0; t < page.size(); ++t)
        for (std::size_t k = 0; k < 3 * count; ++k) *to++ = page.planes[first + k][t];
    return array;
}

py::dict statistics(const BakeHandle& bake) {
    const BakeStatistics& s = bake->manifest.statistics;
    py::dict result;
    result["texels"] = s.texels;
    result["invalid_texels"] = s.invalid_texels;
    result["buried_texels"] = s.buried_texels;
    result["rays"] = s.rays;
    result["seconds"] = s.seconds;
    result["samples"] = s.samples;
    result["mean_error"] = s.mean_error;
    result["back_face_share"] = s.back_face_share;
    result["negative_share"] = s.negative_share;
    result["ringing"] = s.ringing;
    result["codec_error"] = s.codec_error;
    return result;
}

void write_to(const BakeHandle& bake, const std::filesystem::path& folder,
              const std::optional<std::vector<std::string>>& storages, const SceneHandle* scene,
              const std::string& container) {
    py::gil_scoped_release released;
    const Scene* written = scene == nullptr ? nullptr : &scene->loaded->scene;
    (void)value_or_throw(write_bake(folder, *bake, {{storages, container}, written}));
}

void add_progress(py::module_& module) {
    py::class_<BakeProgress>(module, "Progress", "How far a bake is.")
        .def_property_readonly(
            "stage", [](const BakeProgress& p) { return p.stage == BakeProgress::Stage::texels ? "texels" : "probes"; })
        .def_readonly("done", &BakeProgress::done, "Fraction of the stage, in [0, 1].")
        .def_readonly("rays_per_second", &BakeProgress::rays_per_second)
        .def_readonly("seconds_left", &BakeProgress::seconds_left)
        .def_readonly("error", &BakeProgress::error, "Relative standard error so far; 0: not known yet.")
        .def_readonly("pass_number", &BakeProgress::pass)
        .def_readonly("passes", &BakeProgress::passes);
}

void add_page(py::module_& module) {
    py::class_<PageHandle>(module, "Page", "A lightmap page: channels of shape (height, width).")
        .def_property_readonly("width", [](const PageHandle& p) { return p.page().width; })
        .def_property_readonly("height", [](const PageHandle& p) { return p.page().height; })
        .def_property_readonly(
            "channels", [](const PageHandle& p) { return p.bake->channels().names(); },
            "Names: c0.R, c0.G, c0.B, c1.R and so on, E.R, E.G, E.B, E.error.")
        .def("__getitem__", &channel, py::arg("channel"), "A channel as a read-only array, not copied.")
        .def_property_readonly(
            "coefficients", [](const PageHandle& p) { return colours_of(p, 0, p.bake->manifest.coefficients); },
            "A new array of shape (height, width, size, 3), as pack() takes it.")
        .def_property_readonly(
            "irradiance",
            [](const PageHandle& p) {
                return colours_of(p, p.bake->channels().irradiance(0), 1).attr("squeeze")(py::int_(2));
            },
            "E at the shading normal as the paths measured it [W/m^2]: a new array of shape (height, width, 3).")
        .def_property_readonly(
            "validity",
            [](const py::object& self) {
                const auto& p = self.cast<const PageHandle&>();
                return view_of(p.page().validity.data(), p.shape(), self);
            },
            "Fraction of paths that did not hit a back face first; 0 where nothing was baked. Not copied.")
        .def_property_readonly(
            "chart",
            [](const py::object& self) {
                const auto& p = self.cast<const PageHandle&>();
                return view_of(p.page().chart.data(), p.shape(), self);
            },
            "Chart of each texel plus 1; 0: no triangle covers the texel. Not copied.")
        .def_property_readonly(
            "normals",
            [](const py::object& self) {
                const auto& p = self.cast<const PageHandle&>();
                auto shape = p.shape();
                shape.push_back(3);
                return view_of(&p.bake->normals[p.index].data()->x, shape, self);
            },
            "Shading normals of shape (height, width, 3); zero where nothing was baked. Not copied.");
}

void add_bake_class(py::module_& module) {
    py::class_<Bake, std::shared_ptr<Bake>>(module, "Bake", "Lightmap pages in memory.")
        .def_property_readonly("codec", [](const Bake& b) { return b.manifest.options.codec; })
        .def_property_readonly("pages", [](const std::shared_ptr<Bake>& b) { return pages_of(b); })
        .def_property_readonly("warnings", [](const Bake& b) { return b.manifest.warnings; })
        .def_property_readonly("statistics", [](const std::shared_ptr<Bake>& b) { return statistics(b); })
        .def_property_readonly("objects",
                               [](const Bake& b) {
                                   std::vector<std::string> names;
                                   for (const auto& object : b.manifest.objects) names.push_back(object.name);
                                   return names;
                               })
        .def(
            "write",
            [](const std::shared_ptr<Bake>& b, const std::filesystem::path& folder,
               const std::optional<std::vector<std::string>>& storages, const SceneHandle* scene,
               const std::string& container) { write_to(b, folder, storages, scene, container); },
            py::arg("folder"), py::kw_only(), py::arg("storages") = py::none(), py::arg("scene") = py::none(),
            py::arg("container") = "ktx2", "Writes pages, textures and bake.json; with the scene, also its copy.");
}

}  // namespace

void add_bake(py::module_& module) {
    add_progress(module);
    add_page(module);
    add_bake_class(module);
    module.def(
        "read_bake",
        [](const std::filesystem::path& folder) {
            py::gil_scoped_release released;
            return std::make_shared<Bake>(value_or_throw(read_bake(folder)));
        },
        py::arg("folder"), "Reads the folder of a bake, or the bake.json in it.");
    module.def("_bake", &bake_in_python);
}

}  // namespace lobelia::python
