// Punctual lights (KHR_lights_punctual) and cameras of a glTF file.
#include "scene/gltf_lights.h"

#include <algorithm>
#include <cmath>

#include "core/math/colour.h"

namespace lobelia::gltf {
namespace {

/// Axes of a transform without its scale, right-handed; nothing where they are degenerate.
std::optional<Transform> without_scale(const Transform& t) {
    const auto column = [&](int k) {
        const auto part = [&](Vec3 row) { return k == 0 ? row.x : k == 1 ? row.y : row.z; };
        return Vec3{part(t.rows[0]), part(t.rows[1]), part(t.rows[2])};
    };
    Vec3 z = column(2), y = column(1);
    const auto unit = [](Vec3& v) {
        // Twice, for a very small or large one.
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

Status read_kind(const Document& document, const tinygltf::Light& source, PunctualLight& light,
                 const std::string& place) {
    if (source.type == "point") {
        light.kind = PunctualLight::Kind::point;
    } else if (source.type == "directional") {
        light.kind = PunctualLight::Kind::directional;
        // glTF has no size for it: our own files carry one in the extras.
        const double radius = number(source.extras, "angular_radius", 0);
        if (!(radius >= 0 && radius < 0.5 * k_pi))
            return document.error(place + ".extras.angular_radius", fmt::format("{} is not in [0, pi / 2)", radius));
        light.angular_radius = static_cast<float>(radius);
    } else if (source.type == "spot") {
        light.kind = PunctualLight::Kind::spot;
        light.inner_angle = static_cast<float>(source.spot.innerConeAngle);
        light.outer_angle = static_cast<float>(source.spot.outerConeAngle);
        if (!(light.inner_angle >= 0 && light.inner_angle < light.outer_angle && light.outer_angle < 1.5708f))
            return document.error(place + ".spot", "0 <= innerConeAngle < outerConeAngle <= pi / 2 does not hold");
    } else {
        return document.error(place + ".type", "neither point, spot nor directional");
    }
    return Done{};
}

Result<PunctualLight> read_light(const Document& document, std::size_t index) {
    const tinygltf::Light& source = document.model.lights[index];
    const std::string place = fmt::format("extensions.KHR_lights_punctual.lights[{}]", index);
    PunctualLight light;
    light.name = short_name(source.name);
    if (const Status s = read_kind(document, source, light, place); !s) return s.error();
    double scale = source.intensity;
    if (document.options.units == GltfReadOptions::Units::photometric) scale /= k_white_efficacy;
    std::array<float, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i)
        rgb[i] = static_cast<float>(scale * (source.color.size() == 3 ? source.color[i] : 1));
    for (const float x : rgb)
        if (!(x >= 0) || !std::isfinite(x)) return document.error(place, "its intensity is negative or not finite");
    light.intensity = {rgb[0], rgb[1], rgb[2]};
    if (light.kind != PunctualLight::Kind::directional) light.range = static_cast<float>(source.range);
    if (!(light.range >= 0) || !std::isfinite(light.range))
        return document.error(place + ".range", "negative or not finite");
    return light;
}

Status add_light(Document& document, const PlacedNode& placed, Scene& scene) {
    const tinygltf::Node& node = document.model.nodes[placed.node];
    const auto* value = extension(node.extensions, "KHR_lights_punctual");
    if (value == nullptr) return Done{};
    const std::string place = fmt::format("nodes[{}].extensions.KHR_lights_punctual", placed.node);
    const auto index = checked_index(document, *value, "light", document.model.lights.size(), place);
    if (!index) return index.error();
    if (!*index) return document.error(place + ".light", "missing");
    auto light = read_light(document, **index);
    if (!light) return light.error();
    if (!node.name.empty()) light->name = short_name(node.name);
    if (light->kind != PunctualLight::Kind::directional) light->position = placed.world_from_node.translation;
    if (light->kind != PunctualLight::Kind::point) {
        const auto axes = without_scale(placed.world_from_node);
        if (!axes) return document.error(place, "its node's scale leaves it no direction");
        light->direction = Vec3{axes->rows[0].z, axes->rows[1].z, axes->rows[2].z} * -1;
    }
    scene.lights.push_back(*std::move(light));
    return Done{};
}

Status add_camera(Document& document, const PlacedNode& placed, Scene& scene) {
    const tinygltf::Node& node = document.model.nodes[placed.node];
    if (node.camera < 0) return Done{};
    const auto& cameras = document.model.cameras;
    if (static_cast<std::size_t>(node.camera) >= cameras.size())
        return document.error(fmt::format("nodes[{}].camera", placed.node),
                              fmt::format("{} of {}", node.camera, cameras.size()));
    const tinygltf::Camera& source = cameras[static_cast<std::size_t>(node.camera)];
    const std::string place = fmt::format("cameras[{}]", node.camera);
    if (source.type != "perspective") {
        document.warn(place, "orthographic; left out");
        return Done{};
    }
    Camera camera;
    camera.name = short_name(node.name.empty() ? source.name : node.name);
    camera.vertical_field_of_view = static_cast<float>(source.perspective.yfov);
    if (!(camera.vertical_field_of_view > 0 && camera.vertical_field_of_view < 3.1415f))
        return document.error(place + ".perspective.yfov", "not in (0, pi)");
    const auto axes = without_scale(placed.world_from_node);
    if (!axes) return document.error(fmt::format("nodes[{}]", placed.node), "its scale leaves the camera no axes");
    camera.world_from_camera = *axes;
    scene.cameras.push_back(std::move(camera));
    return Done{};
}

}  // namespace

Status read_lights_and_cameras(Document& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
    for (const PlacedNode& node : nodes) {
        if (const Status s = add_light(document, node, scene); !s) return s;
        if (const Status s = add_camera(document, node, scene); !s) return s;
    }
    return Done{};
}

}  // namespace lobelia::gltf
