// Cameras as they are named on the command line.
#include "cli/camera.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "cli/numbers.h"
#include "lobelia/render.h"

namespace lobelia::cli {
namespace {

Result<Camera> camera_from(const std::vector<float>& numbers, const std::string& text) {
    const Vec3 eye{numbers[0], numbers[1], numbers[2]}, target{numbers[3], numbers[4], numbers[5]};
    const float degrees = numbers.size() > 6 ? numbers[6] : 45;
    const float distance = length(eye - target);
    if (!(distance > 0) || !std::isfinite(distance) || !(degrees >= 1) || !(degrees <= 170))
        return Error{"--camera: \"" + text + "\" needs two different points, and a field of view of 1 to 170 degrees"};
    // Stand upright; looking straight up or down, with -z at the top.
    const Vec3 back = (eye - target) * (1 / distance);
    const Vec3 upward = std::abs(back.y) > 0.9999f ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
    const Vec3 right = normalize(cross(upward, back)), up = cross(back, right);
    Camera camera;
    camera.world_from_camera = {{Vec3{right.x, up.x, back.x}, {right.y, up.y, back.y}, {right.z, up.z, back.z}}, eye};
    camera.vertical_field_of_view = degrees * static_cast<float>(k_pi / 180);
    return camera;
}

}  // namespace

Result<Camera> find_camera(const Scene& scene, const std::string& text) {
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == text) return camera;
        names.push_back("\"" + camera.name + "\"");
    }
    const auto numbers = parse_numbers(text);
    if (numbers && (numbers->size() == 6 || numbers->size() == 7)) return camera_from(*numbers, text);
    if (numbers && numbers->size() == 1 && numbers->front() >= 0 && numbers->front() == std::floor(numbers->front())) {
        if (scene.cameras.empty() && numbers->front() == 0) return default_camera(scene);
        if (numbers->front() < static_cast<float>(scene.cameras.size()))
            return scene.cameras[static_cast<std::size_t>(numbers->front())];
    }
    return Error{fmt::format("--camera: \"{}\" is neither a camera of {} ({}) nor \"px,py,pz,tx,ty,tz[,fov]\"", text,
                             scene.name, names.empty() ? "it has none" : fmt::format("{}", fmt::join(names, ", ")))};
}

}  // namespace lobelia::cli
