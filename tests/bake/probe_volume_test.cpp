// Tests light between probes: walls hold it back, constants stay constant, the field has no holes.
#include "lobelia/probe_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/probes/bake_probes.h"
#include "bake/probes/probe_visibility.h"
#include "lobelia/bake.h"
#include "small_scenes.h"
#include "support.h"

namespace lobelia {
namespace {

constexpr float k_wall = 0.1f, k_room = 3;

/// Two closed rooms of 3 x 3 x 3 m beside each other along x, with a wall of 10 cm between them. A lamp of 1 x 1 m
/// hangs below the ceiling of the first; the second is dark.
Scene two_rooms() {
    Scene scene;
    scene.materials = {test::matte({0.7f, 0.7f, 0.7f}), test::matte({}, {20, 20, 20})};
    Mesh rooms;
    test::add_box(rooms, 0, {-k_room - k_wall / 2, 0, 0}, {-k_wall / 2, k_room, k_room}, test::Facing::inwards);
    test::add_box(rooms, 0, {k_wall / 2, 0, 0}, {k_room + k_wall / 2, k_room, k_room}, test::Facing::inwards);
    test::add_square(rooms, 1, {-k_room / 2, k_room - 0.05f, k_room / 2}, {1, 0, 0}, {0, 0, 1}, 0.5f);
    test::add_object(scene, std::move(rooms));
    return scene;
}

struct BakedProbes {
    explicit BakedProbes(Scene s, ProbeOptions options = {})
        : scene(std::move(s)), world(make_world(scene)), tracer(scene, world) {
        options.samples = 512;
        options.codec = "sh2/moments/convolution";
        auto baked = bake_probes(tracer, options);
        EXPECT_TRUE(baked) << baked.error().message;
        probes = *std::move(baked);
    }
    Scene scene;
    World world;
    PathTracer tracer;
    ProbeSet probes;
};

/// A point of a room's surfaces and its normal, into the room.
struct SurfacePlace {
    Vec3 position, normal;
};
std::vector<SurfacePlace> places_in(Vec3 low, Vec3 high, std::size_t count) {
    std::mt19937 generator(4);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<SurfacePlace> places;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<float, 3> a = {low.x, low.y, low.z}, b = {high.x, high.y, high.z};
        std::array<float, 3> p{}, n{};
        for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + uniform(generator) * (b[k] - a[k]);
        const std::size_t axis = i % 3;
        const bool upper = i / 3 % 2 == 1;
        p[axis] = upper ? b[axis] : a[axis];
        n[axis] = upper ? -1.0f : 1.0f;
        places.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}});
    }
    return places;
}

const Vec3 k_lit_low{-k_room - k_wall / 2, 0, 0}, k_lit_high{-k_wall / 2, k_room, k_room};
const Vec3 k_dark_low{k_wall / 2, 0, 0}, k_dark_high{k_room + k_wall / 2, k_room, k_room};

template <class Read>
double mean_irradiance(const Read& read, Vec3 low, Vec3 high) {
    constexpr std::size_t k_count = 3000;
    double sum = 0;
    for (const SurfacePlace& place : places_in(low, high, k_count))
        sum += std::max(0.0, static_cast<double>(read(place.position, place.normal).g));
    return sum / k_count;
}

/// A byte for each cell: bit k says that its centre sees corner k. The alternative to maps of distance.
std::vector<std::uint8_t> corner_bits(const BakedProbes& baked, std::vector<std::array<std::uint32_t, 8>>& corners) {
    const ProbeGrid& grid = *baked.probes.grid;
    std::vector<std::uint8_t> bits;
    for (std::uint32_t z = 0; z + 1 < grid.count[2]; ++z)
        for (std::uint32_t y = 0; y + 1 < grid.count[1]; ++y)
            for (std::uint32_t x = 0; x + 1 < grid.count[0]; ++x) {
                const auto at = [&](std::uint32_t k) {
                    return x + (k & 1) + grid.count[0] * (y + (k >> 1 & 1) + grid.count[1] * (z + (k >> 2)));
                };
                const Vec3 centre = grid.origin + Vec3{(static_cast<float>(x) + 0.5f) * grid.spacing.x,
                                                       (static_cast<float>(y) + 0.5f) * grid.spacing.y,
                                                       (static_cast<float>(z) + 0.5f) * grid.spacing.z};
                std::uint8_t seen = 0;
                auto& of_cell = corners.emplace_back();
                for (std::uint32_t k = 0; k < 8; ++k) {
                    of_cell[k] = at(k);
                    const Vec3 way = baked.probes.positions[at(k)] - centre;
                    const float far = length(way);
                    const PathTracer::Ray ray{centre, way * (1 / far), far};
                    PathTracer::Hit hit;
                    baked.tracer.closest({&ray, 1}, {&hit, 1});
                    if (!(hit.distance < far)) seen = static_cast<std::uint8_t>(seen | 1u << k);
                }
                bits.push_back(seen);
            }
    return bits;
}

/// Irradiance with a byte for each cell in place of maps of distance, with the same bias and trilinear weights.
class BitVolume {
  public:
    explicit BitVolume(const BakedProbes& baked)
        : volume_(ProbeVolume::make(baked.probes, {0.2f, Switch::off}).value()), bits_(corner_bits(baked, corners_)) {}
    [[nodiscard]] Rgb irradiance(Vec3 p, Vec3 n) const {
        const auto around = volume_.corners(p, n);
        const auto cell = std::find(corners_.begin(), corners_.end(), around.probe) - corners_.begin();
        Rgb sum;
        float total = 1e-9f;
        for (std::size_t k = 0; k < 8; ++k) {
            if ((bits_[static_cast<std::size_t>(cell)] >> k & 1) == 0) continue;
            const std::size_t m = volume_.coefficients();
            const auto c = std::span(volume_.probes().coefficients).subspan(around.probe[k] * m, m);
            sum = sum + volume_.codec().irradiance(c, n) * around.weight[k];
            total += around.weight[k];
        }
        return sum * (1 / total);
    }

  private:
    ProbeVolume volume_;
    std::vector<std::array<std::uint32_t, 8>> corners_;
    std::vector<std::uint8_t> bits_;
};

/// Mean irradiance of the dark room over that of the lit one, and the share of the lit room's light that is lost.
struct Leak {
    double leaks = 0, loses = 0;
    template <class Volume>
    void add(const Volume& volume, double lit) {
        const auto read = [&](Vec3 p, Vec3 n) { return volume.irradiance(p, n); };
        leaks = std::max(leaks, mean_irradiance(read, k_dark_low, k_dark_high) / lit);
        loses = std::max(loses, 1 - mean_irradiance(read, k_lit_low, k_lit_high) / lit);
    }
    void print(const char* name) const { std::printf("  %-28s %8.3f %% %8.1f %%\n", name, 100 * leaks, 100 * loses); }
};

TEST(ProbeVolume, WallsHoldLightBack) {
    // The grid at several places beside the wall; the worst of them counts.
    constexpr std::array<std::uint32_t, 4> k_sides = {4, 6, 8, 16};
    Leak none, bits;
    std::array<Leak, k_sides.size()> maps;
    for (const float shift : {0.0f, 0.2f, 0.4f}) {
        ProbeOptions options;
        options.spacing = 1;
        options.box = {{k_lit_low + Vec3{shift, 0, 0}, k_dark_high + Vec3{shift, 0, 0}}};
        for (std::size_t i = 0; i < k_sides.size(); ++i) {
            options.visibility = k_sides[i];
            const BakedProbes baked(two_rooms(), options);
            const auto plain = ProbeVolume::make(baked.probes, {0.2f, Switch::off}).value();
            const double lit =
                mean_irradiance([&](Vec3 p, Vec3 n) { return plain.irradiance(p, n); }, k_lit_low, k_lit_high);
            EXPECT_GT(lit, 1);
            maps[i].add(ProbeVolume::make(baked.probes).value(), lit);
            if (i > 0) continue;
            none.add(plain, lit);
            bits.add(BitVolume(baked), lit);
        }
    }
    std::printf("light through a wall of 10 cm, of the lit room's; light that the lit room loses\n");
    none.print("no visibility");
    bits.print("corner bits, 1 byte a cell");
    for (std::size_t i = 0; i < k_sides.size(); ++i)
        maps[i].print(("maps of distance, " + std::to_string(4 * k_sides[i] * k_sides[i]) + " bytes").c_str());
    EXPECT_LT(maps[2].leaks, 0.01);
    EXPECT_LT(maps[2].loses, 0.05);
    EXPECT_GT(none.leaks, 0.03);
}

TEST(ProbeVolume, AConstantStaysAConstant) {
    for (const int levels : {0, 2}) {
        Scene open;
        open.materials.push_back(test::matte({0.5f, 0.5f, 0.5f}));
        Mesh box;
        test::add_box(box, 0, {-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}, test::Facing::outwards);
        test::add_object(open, std::move(box));
        ProbeOptions options;
        options.box = {{{-2, -2, -2}, {2, 2, 2}}};
        options.levels = levels;
        options.tolerance = 0;
        BakedProbes baked(std::move(open), options);
        for (Rgb& c : baked.probes.coefficients) c = {};
        for (std::size_t i = 0; i < baked.probes.size(); ++i) baked.probes.coefficients[9 * i] = {1, 2, 3};
        const auto volume = ProbeVolume::make(baked.probes).value();
        const auto directions = test::random_directions(Domain::sphere, 200, 1);
        const float expected = static_cast<float>(std::sqrt(k_pi) / 2);  // E of c_0 = 1: pi / sqrt(4 pi)
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const Vec3 n = direction_at(directions, i);
            const Rgb e = volume.irradiance(n * (0.5f + 0.015f * static_cast<float>(i)), n);
            EXPECT_NEAR(e.r, expected, 1e-4f);
            EXPECT_NEAR(e.b, 3 * expected, 3e-4f);
        }
    }
}

TEST(ProbeVolume, IsContinuousAcrossCellsOfOneSize) {
    const BakedProbes baked(two_rooms());
    const auto volume = ProbeVolume::make(baked.probes).value();
    const ProbeGrid& grid = *baked.probes.grid;
    for (std::uint32_t step = 1; step + 1 < grid.count[0]; ++step)
        for (const Vec3 n : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}}) {
            const float face = grid.origin.x + static_cast<float>(step) * grid.spacing.x;
            const Rgb before = volume.irradiance({face - 1e-4f, 1.3f, 1.4f}, n);
            const Rgb after = volume.irradiance({face + 1e-4f, 1.3f, 1.4f}, n);
            EXPECT_NEAR(before.g, after.g, 0.01f * std::max(1.0f, before.g));
        }
}

TEST(ProbeVolume, WithoutValidProbesTheResultIsFinite) {
    BakedProbes baked(two_rooms());
    for (float& v : baked.probes.validity) v = 0;
    const auto volume = ProbeVolume::make(baked.probes).value();
    const Rgb e = volume.irradiance({-1, 1, 1}, {0, 1, 0});
    EXPECT_TRUE(std::isfinite(e.r) && std::isfinite(e.g) && std::isfinite(e.b));
}

/// A picture of the lit room from within.
Image picture(const Scene& scene, const Bake& bake, ProbeLight light) {
    Camera camera;
    camera.world_from_camera.translation = {-k_room, 1.5f, 1.5f};
    camera.world_from_camera.rows = {Vec3{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};  // looks along +x
    RenderOptions options;
    options.width = 32;
    options.height = 24;
    options.samples = 64;
    options.probes = light;
    auto image = render(scene, bake, camera, options);
    EXPECT_TRUE(image) << image.error().message;
    return *std::move(image);
}

TEST(ProbeVolume, APictureLitByProbesIsNearThePathTracedOne) {
    ProbeOptions options;
    options.spacing = 0.5;
    const BakedProbes baked(two_rooms(), options);
    // No object has a lightmap: without probes all of it is path-traced.
    Bake bake;
    bake.manifest.options.codec.clear();
    for (const Object& object : baked.scene.objects) bake.manifest.objects.push_back({object.name, {}});
    bake.probes = baked.probes;
    const Image paths = picture(baked.scene, bake, ProbeLight::none);
    const Image probes = picture(baked.scene, bake, ProbeLight::unbaked);
    double off = 0, all = 0;
    for (std::size_t i = 0; i < paths.pixels.size(); ++i) {
        off += std::abs(static_cast<double>(paths.pixels[i].g) - static_cast<double>(probes.pixels[i].g));
        all += static_cast<double>(paths.pixels[i].g);
    }
    std::printf("a picture by probes 0.5 m apart: mean difference from the path-traced one %.1f %%\n", 100 * off / all);
    EXPECT_LT(off, 0.12 * all);
    bake.probes.reset();
    Camera camera;
    RenderOptions none;
    none.width = none.height = 4;
    none.probes = ProbeLight::all;
    const auto refused = render(baked.scene, bake, camera, none);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("the bake has no probes"), std::string::npos);
}

TEST(ProbeVolume, InvalidProbesAreFilledFromValidNeighbours) {
    ProbeSet probes;
    probes.codec = "sh1/moments/convolution";
    probes.coefficients_per_probe = 1;
    probes.grid = ProbeGrid{{3, 1, 1}, {0, 0, 0}, {1, 1, 1}};
    probes.positions.resize(3);
    probes.validity = {1, 0, 0.2f};
    probes.coefficients = {{4, 4, 4}, {1, 1, 1}, {2, 2, 2}};
    dilate_probes(probes);
    EXPECT_EQ(probes.coefficients[1], (Rgb{4, 4, 4}));
    EXPECT_EQ(probes.coefficients[2], (Rgb{4, 4, 4}));
    EXPECT_EQ(probes.validity[1], 0);
    probes.validity = {0, 0, 0};
    probes.coefficients = {{4, 4, 4}, {1, 1, 1}, {2, 2, 2}};
    dilate_probes(probes);
    EXPECT_EQ(probes.coefficients[1], (Rgb{1, 1, 1}));
}

TEST(ProbeVolume, OctahedralMapsGoOnBeyondTheirEdges) {
    // A map of a smooth function, read bilinearly anywhere, is near the function.
    constexpr int k_side = 16;
    const auto f = [](Vec3 w) { return 2 + w.x + 0.5f * w.y - 0.7f * w.z; };
    std::vector<std::array<float, 2>> map(k_side * k_side);
    const auto directions = test::random_directions(Domain::sphere, 2000, 8);
    for (int y = 0; y < k_side; ++y)
        for (int x = 0; x < k_side; ++x) {
            const double u = 2 * (x + 0.5) / k_side - 1, v = 2 * (y + 0.5) / k_side - 1;
            // The inverse of OctahedralMap::place.
            double z = 1 - std::abs(u) - std::abs(v), a = u, b = v;
            if (z < 0) {
                a = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
                b = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
            }
            map[static_cast<std::size_t>(y) * k_side + static_cast<std::size_t>(x)] = {
                f(normalize(Vec3{static_cast<float>(a), static_cast<float>(b), static_cast<float>(z)})), 0};
        }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3 w = direction_at(directions, i);
        EXPECT_NEAR(probe_moments(map, k_side, w)[0], f(w), 0.09f);  // a texel is 0.2 wide where the faces fold
    }
}

}  // namespace
}  // namespace lobelia
