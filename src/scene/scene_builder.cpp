// Makes scenes of gridded patches and packs their charts.
#include "scene/scene_builder.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "scene/chart_packer.h"

namespace lobelia {
namespace {

ChartSize grid_size(Vec2 size, double scale) {
    const auto units = [&](float metres) {
        return static_cast<std::uint32_t>(std::max(1.0, std::floor(static_cast<double>(metres) * scale + 0.5)));
    };
    return {units(size.x), units(size.y)};
}

}  // namespace

std::uint32_t SceneBuilder::material(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

void SceneBuilder::begin_object(std::string name) {
    Mesh mesh;
    mesh.name = name;
    scene_.meshes.push_back(std::move(mesh));
    scene_.objects.push_back({std::move(name), scene_.meshes.size() - 1, {}});
}

void SceneBuilder::add_grid(const PatchOptions& options, const GridPoint& point) {
    assert(!scene_.meshes.empty());
    Mesh& mesh = scene_.meshes.back();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const std::size_t stride = options.columns + 1;
    charts_.push_back({scene_.meshes.size() - 1, first, stride * (options.rows + 1), options.size * options.density});
    for (std::size_t row = 0; row <= options.rows; ++row)
        for (std::size_t column = 0; column < stride; ++column) {
            const PatchPoint p = point(column, row);
            mesh.positions.push_back(p.position);
            mesh.normals.push_back(p.normal);
            mesh.uv[0].push_back(p.uv);
            mesh.lightmap_uv.push_back(
                {stop(options.column_stops, column, options.columns), stop(options.row_stops, row, options.rows)});
        }
    for (std::size_t row = 0; row < options.rows; ++row)
        for (std::size_t column = 0; column < options.columns; ++column) {
            const auto a = static_cast<std::uint32_t>(first + row * stride + column);
            const auto above = static_cast<std::uint32_t>(a + stride);
            mesh.triangles.push_back({a, a + 1, above + 1});
            mesh.triangles.push_back({a, above + 1, above});
            mesh.materials.insert(mesh.materials.end(), 2, options.material);
        }
}

void SceneBuilder::quad(Vec3 corner, Vec3 right, Vec3 up, const PatchOptions& options) {
    PatchOptions sized = options;
    sized.size = {length(right), length(up)};
    const Vec3 normal = normalize(cross(right, up));
    patch(sized, [&](float u, float v) {
        return PatchPoint{corner + right * u + up * v, normal, {u * sized.size.x, v * sized.size.y}};
    });
}

void SceneBuilder::box(Vec3 lowest, Vec3 highest, const BoxOptions& options) {
    // Add each face by its lower left corner as seen from outside.
    const Vec3 d = highest - lowest, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    struct Face {
        unsigned bit;
        Vec3 corner, right, up;
    };
    const std::array<Face, 6> faces{{{k_face_left, lowest, z, y},
                                     {k_face_right, lowest + x + z, z * -1, y},
                                     {k_face_bottom, lowest, x, z},
                                     {k_face_top, lowest + y + z, x, z * -1},
                                     {k_face_back, lowest + x, x * -1, y},
                                     {k_face_front, lowest + z, x, y}}};
    PatchOptions face_options;
    face_options.density = options.density;
    face_options.material = options.material;
    for (const Face& face : faces)
        if (options.faces & face.bit)
            quad(transform_point(options.world_from_box, face.corner),
                 transform_vector(options.world_from_box, face.right),
                 transform_vector(options.world_from_box, face.up), face_options);
}

void SceneBuilder::lathe(Vec3 base, std::span<const ProfilePoint> profile, std::size_t segments,
                         const PatchOptions& options) {
    // Measure the profile, so that the chart is about as large as the surface.
    assert(profile.size() >= 2);
    PatchOptions sized = options;
    sized.columns = segments;
    sized.rows = profile.size() - 1;
    sized.row_stops = {0};
    float mean_radius = 0;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        mean_radius += profile[i].radius / static_cast<float>(profile.size());
        if (i > 0)
            sized.row_stops.push_back(sized.row_stops.back() + std::hypot(profile[i].radius - profile[i - 1].radius,
                                                                          profile[i].y - profile[i - 1].y));
    }
    sized.size = {static_cast<float>(2 * k_pi) * mean_radius, sized.row_stops.back()};
    for (float& stop : sized.row_stops) stop /= sized.size.y;

    // Revolve it: columns go around from +z towards +x.
    add_grid(sized, [&](std::size_t column, std::size_t row) {
        const ProfilePoint& point = profile[row];
        const double turn = static_cast<double>(column % segments) / static_cast<double>(segments);
        const auto s = static_cast<float>(std::sin(2 * k_pi * turn)), c = static_cast<float>(std::cos(2 * k_pi * turn));
        return PatchPoint{base + Vec3{point.radius * s, point.y, point.radius * c},
                          normalize({point.normal.x * s, point.normal.y, point.normal.x * c}),
                          {static_cast<float>(column) / static_cast<float>(segments) * sized.size.x,
                           sized.row_stops[row] * sized.size.y}};
    });
}

Scene SceneBuilder::finish(const LightmapOptions& options) {
    // Search for the maximum number of grid units per metre at which all charts fit.
    std::vector<ChartSize> sizes(charts_.size());
    std::vector<ChartPlace> places;
    double fits = 0, too_large = options.grid;
    for (int step = 0; step < 24; ++step) {
        const double scale = 0.5 * (fits + too_large);
        for (std::size_t i = 0; i < charts_.size(); ++i) sizes[i] = grid_size(charts_[i].size, scale);
        if (auto packed = pack_charts(sizes, options.grid, options.padding)) {
            places = *std::move(packed);
            fits = scale;
        } else {
            too_large = scale;
        }
    }
    assert(charts_.size() == places.size());

    // Move each chart from the unit square to its place.
    const float unit = 1 / static_cast<float>(options.grid);
    for (std::size_t i = 0; i < charts_.size(); ++i) {
        const Chart& chart = charts_[i];
        const ChartSize size = grid_size(chart.size, fits);
        for (std::size_t k = 0; k < chart.vertices; ++k) {
            Vec2& uv = scene_.meshes[chart.mesh].lightmap_uv[chart.first_vertex + k];
            uv = {(static_cast<float>(places[i].x) + uv.x * static_cast<float>(size.width)) * unit,
                  (static_cast<float>(places[i].y) + uv.y * static_cast<float>(size.height)) * unit};
        }
    }
    charts_.clear();
    if (scene_.textures.empty())
        for (Mesh& mesh : scene_.meshes) mesh.uv[0].clear();
    return std::exchange(scene_, {});
}

}  // namespace lobelia
