// Punctual lights (KHR_lights_punctual) and cameras of a glTF file.
#include <algorithm>
#include <cmath>

#include "core/math/colour.h"
#include "scene/gltf/nodes.h"
#include "scene/light/light_kind.h"

namespace lobelia::gltf {
namespace {

/// Returns a transform without its scale, right-handed; nothing if its axes are degenerate.
std::optional<Transform> without_scale(const Transform& t) {
    const auto column = [&](int k) {
        const auto part = [&](Vec3 row) { return k == 0 ? row.x : k == 1 ? row.y : row.z; };
        return Vec3{part(t.rows[0]), part(t.rows[1]), part(t.rows[2])};
    };
    Vec3 z = column(2), y = column(1);
    const auto unit = [](Vec3& v) {
        // Normalise twice, for very small and large scales.
        for (int i = 0; i < 2; ++i) {
            const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
            if (!(largest > 0)) return false;
            v = v * (1 / largest);
            const float l = length(v);
            if (!std::isfinite(l) || !(l > 0)) return false;
            v = v * (1 / l);
        }
        return true;
    };
    if (!unit(z)) return std::nullopt;
    Vec3 x = cross(y, z);
    if (!unit(x)) return std::nullopt;
    y = cross(z, x);
    Transform result = t;
    result.rows = {Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}};
    return result;
}

void read_kind(const JsonPlace& source, PunctualLight& light) {
    const std::string_view type = source.at("type").long_text();
    std::string names;
    for (const PunctualLight::Kind kind : light_kinds()) {
        const LightKind& known = light_kind(kind);
        names += (names.empty() ? "" : ", ") + std::string(known.name);
        if (known.name != type) continue;
        light.kind = kind;
        if (known.read != nullptr) known.read(source, light);
        return;
    }
    source.at("type").refuse("not one of " + names);
}

PunctualLight read_light(const Document& document, std::size_t index) {
    const JsonPlace& source = document.lights[index];
    PunctualLight light;
    light.name = name_of(source);
    read_kind(source, light);
    double scale = number_or(source, "intensity", 1);
    if (document.options.units == GltfReadOptions::Units::photometric) scale /= k_white_efficacy;
    std::array<double, 3> color{1, 1, 1};
    if (const auto found = source.find("color")) found->numbers(color);
    light.intensity = light_amount(source, color, scale, "intensity");
    const auto range = source.find("range");
    if (!range || light_kind(light.kind).place == LightPlace::far) return light;
    light.range = range->single();
    if (light.range < 0) range->refuse("negative");
    return light;
}

void add_light(Document& document, const NodeTree& tree, std::size_t node, Scene& scene) {
    const JsonPlace& source = document.nodes[node];
    const auto punctual = extension(source, "KHR_lights_punctual");
    const auto index = punctual ? punctual->find("light") : std::nullopt;
    if (!index) return;
    if (!index->is_whole() || index->whole(0, ~std::uint64_t{0}) >= document.lights.size())
        index->refuse(fmt::format("not an index below {}", document.lights.size()));
    PunctualLight light = read_light(document, whole(*index));
    if (const std::string name = name_of(source); !name.empty()) light.name = name;
    const Transform placed = relative_to(scene.origin, tree.world_from_node[node]);
    if (light_kind(light.kind).place == LightPlace::near) light.position = placed.translation;
    if (light_kind(light.kind).aim == LightAim::along_direction) {
        const auto axes = without_scale(placed);
        if (!axes) source.refuse("degenerate scale: the light has no direction");
        light.direction = Vec3{axes->rows[0].z, axes->rows[1].z, axes->rows[2].z} * -1;
    }
    scene.lights.push_back(std::move(light));
}

void add_camera(Document& document, const NodeTree& tree, std::size_t node, Scene& scene) {
    const auto index = find_index(document.nodes[node], "camera", document.cameras.size());
    if (!index) return;
    const JsonPlace& source = document.cameras[*index];
    if (source.at("type").long_text() != "perspective") {
        document.warn(source, "orthographic; left out");
        return;
    }
    Camera camera;
    camera.name = name_of(document.nodes[node]);
    if (camera.name.empty()) camera.name = name_of(source);
    const JsonPlace angle = source.at("perspective").at("yfov");
    camera.vertical_field_of_view = angle.single();
    if (!(camera.vertical_field_of_view > 0 && camera.vertical_field_of_view < 3.1415f)) angle.refuse("not in (0, pi)");
    const auto axes = without_scale(relative_to(scene.origin, tree.world_from_node[node]));
    if (!axes) document.nodes[node].refuse("degenerate scale: the camera has no axes");
    camera.world_from_camera = *axes;
    scene.cameras.push_back(std::move(camera));
}

}  // namespace

void read_lights_and_cameras(Document& document, const NodeTree& tree, Scene& scene) {
    for (const std::size_t node : tree.shown) {
        add_light(document, tree, node, scene);
        add_camera(document, tree, node, scene);
    }
}

}  // namespace lobelia::gltf
