// Small bakes with every kind of content, for tests of a bake's files.
#pragma once

#include <random>

#include "lobelia/bake.h"
#include "lobelia/codec.h"

namespace lobelia::test {

/// Random pages, some texels of them empty, and probes on a grid of 2 x 1 x 3.
inline Bake some_bake(const std::string& codec, Frame frame = Frame::world, std::size_t width = 21,
                      std::size_t height = 34) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    Bake bake;
    Manifest& m = bake.manifest;
    m.program = "test";
    m.scene_name = "a \"scene\"";
    m.scene_hash = 0x0123456789abcdefu;
    m.coefficients = make_codec(codec)->basis().size();
    m.width = width;
    m.height = height;
    m.options.codec = codec;
    m.options.frame = frame;
    m.options.atlas.width = m.width;
    m.options.atlas.height = m.height;
    m.options.target_error = 0.125;
    m.options.only_object = "table";
    m.finish = {"denoise", "dilate"};
    m.warnings = {"a warning"};
    m.options.paths.seed = 0xfffffffe;
    m.options.shard = {Shard::By::samples, 2, 5};
    m.statistics = {700, 11, 5, 123456789012345u, 1.5, 64, 0.01, 99, 0.001, 0.002};
    m.objects = {{"floor", {0, {20.3f, 33.1f}, {0.1f, 0.7f}, {0, 0, 21, 34}, true}},
                 {"lamp", {}},
                 {"table", {1, {7.77f, 1e-3f}, {-3.3f, 9}, {1, 2, 9, 20}, true}}};
    for (std::size_t p = 0; p < 2; ++p) {
        LightmapPage page(m.width, m.height, bake.channels().count());
        std::vector<Vec3> normals(page.size());
        for (std::size_t i = 0; i < page.size(); ++i) {
            if (i % 5 == 0) continue;
            for (auto& plane : page.planes) plane[i] = 3 * uniform(generator);
            page.chart[i] = static_cast<std::uint32_t>(1 + i % 7);
            page.validity[i] = 0.5f * (1 + uniform(generator));
            normals[i] = normalize(Vec3{uniform(generator), uniform(generator), uniform(generator) + 1.01f});
        }
        bake.pages.push_back(std::move(page));
        bake.normals.push_back(std::move(normals));
    }
    ProbeSet probes;
    probes.codec = "sh1/moments/convolution";
    probes.coefficients_per_probe = 4;
    probes.grid = ProbeGrid{{2, 1, 3}, {-1, 0, 0.1f}, {0.5f, 1, 2}};
    for (std::size_t i = 0; i < 6; ++i) {
        probes.positions.push_back({uniform(generator), uniform(generator), uniform(generator)});
        probes.validity.push_back(0.5f + 0.5f * uniform(generator));
        probes.back_faces.push_back(0.25f);
        for (std::size_t k = 0; k < 4; ++k)
            probes.coefficients.push_back({uniform(generator), uniform(generator), uniform(generator)});
    }
    probes.cells = {{{0, 1, 2}, 0.7f, {0, 1, 2, 3, 4, 5, 0, 1}}};
    bake.probes = std::move(probes);
    return bake;
}

}  // namespace lobelia::test
