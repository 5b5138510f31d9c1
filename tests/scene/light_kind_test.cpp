// Tests every kind of light: glTF files keep it, check_scene knows what it needs, and its profile is a fraction.
#include "scene/light/light_kind.h"

#include <gtest/gtest.h>

#include <set>

#include "gltf_reading.h"
#include "same_scenes.h"
#include "scene/check_scene.h"
#include "small_scenes.h"

namespace lobelia {
namespace {

Scene scene_with(const PunctualLight& light) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh;
    test::add_square(mesh, 0, {}, {0, 0, 1}, {1, 0, 0}, 1);
    test::add_object(scene, std::move(mesh));
    scene.lights = {light};
    return scene;
}

float fraction(const PunctualLight& light, float cosine) {
    const auto profile = light_kind(light.kind).profile;
    return profile != nullptr ? profile(light, cosine) : 1;
}

TEST(EveryLightKind, HasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (const auto kind : light_kinds()) names.insert(light_kind(kind).name);
    EXPECT_EQ(names.size(), light_kinds().size());
}

TEST(EveryLightKind, ProfileIsAFraction) {
    for (const auto kind : light_kinds()) {
        const PunctualLight light = test::some_light(kind);
        float most = 0;
        for (int i = -100; i <= 100; ++i) {
            const float f = fraction(light, 0.01f * static_cast<float>(i));
            EXPECT_TRUE(f >= 0 && f <= 1) << light_kind(kind).name << " " << i;
            most = std::max(most, f);
        }
        EXPECT_GT(most, 0) << light_kind(kind).name;
    }
}

TEST(EveryLightKind, RoundTripsThroughGltf) {
    for (const auto kind : light_kinds()) {
        SCOPED_TRACE(light_kind(kind).name);
        const auto round_trip = [](const PunctualLight& light) {
            const auto bytes = encode_glb(scene_with(light), {});
            EXPECT_TRUE(bytes) << bytes.error().message;
            const auto loaded = test::read_gltf_text(*bytes);
            EXPECT_TRUE(loaded) << loaded.error().message;
            return loaded->scene.lights.at(0);
        };
        const PunctualLight light = test::some_light(kind), once = round_trip(light);
        EXPECT_EQ(once.kind, kind);
        if (light_kind(kind).place == LightPlace::near) {
            EXPECT_EQ(once.position, light.position);
        }
        if (light_kind(kind).aim == LightAim::along_direction) test::expect_near(once.direction, light.direction);
        for (int i = -100; i <= 100; ++i)
            EXPECT_EQ(fraction(once, 0.01f * static_cast<float>(i)), fraction(light, 0.01f * static_cast<float>(i)));
        test::expect_same(once, round_trip(once));
    }
}

TEST(EveryLightKind, ChecksWhatItNeeds) {
    for (const auto kind : light_kinds()) {
        SCOPED_TRACE(light_kind(kind).name);
        const PunctualLight good = test::some_light(kind);
        EXPECT_TRUE(check_scene(scene_with(good)));
        PunctualLight light = good;
        light.direction = {};
        EXPECT_EQ(static_cast<bool>(check_scene(scene_with(light))), light_kind(kind).aim == LightAim::everywhere);
        light = good;
        light.intensity.g = -1;
        EXPECT_FALSE(check_scene(scene_with(light)));
    }
}

}  // namespace
}  // namespace lobelia
