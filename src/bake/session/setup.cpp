// Layout, encoding and plan of a bake.
#include "bake/session/setup.h"

#include <fmt/format.h>

#include "bake/place/objects.h"
#include "core/math/hash.h"
#include "scene/scene_hash.h"

namespace lobelia {
namespace {

/// Makes the plan: pages and the scene are always in memory, states and receivers as far as they fit.
Result<BakePlan> plan_of(const BakeSetup& setup) {
    constexpr std::size_t bytes_of_program = 64 << 20;
    const std::size_t texels = setup.atlas.width() * setup.atlas.height() * setup.atlas.pages();
    const std::size_t always =
        texels * (setup.encoding.page_channels().count() * sizeof(float) + 2 * sizeof(std::uint32_t)) +
        setup.map.texels.size() * (sizeof(CoveredTexel) + sizeof(std::uint32_t)) +
        setup.world.triangles.size() * k_bytes_per_triangle + bytes_of_program;
    return make_plan(setup.map, setup.options, setup.layout.bytes() + sizeof(Receiver) + sizeof(std::uint32_t), always);
}

}  // namespace

Result<std::unique_ptr<const BakeSetup>> BakeSetup::make(const Scene& scene, const BakeOptions& options,
                                                         StopFlag stop) {
    auto setup = std::make_unique<BakeSetup>();
    setup->scene = &scene;
    setup->options = options;
    auto encoding = BakeEncoding::make(options);
    if (!encoding) return encoding.error();
    setup->encoding = *std::move(encoding);
    setup->layout = setup->encoding.states();

    // Lay objects out on pages, and find the texels that they cover.
    setup->world = make_world(scene, stop);
    auto atlas = Atlas::make(setup->world, options.atlas, stop);
    if (!atlas) return atlas.error();
    setup->atlas = *std::move(atlas);
    setup->map = map_texels(setup->atlas, stop);
    if (options.only_object) {
        const auto object = find_object(setup->world, *options.only_object);
        if (!object) return object.error();
        setup->map = texels_of_object(setup->map, setup->world, *object);
    }
    if (setup->map.texels.empty())
        return Error{"no texel is covered by any triangle; the lightmap UVs are probably degenerate"};

    // Plan regions and passes; then prepare the tracer.
    auto plan = plan_of(*setup);
    if (!plan) return plan.error();
    setup->plan = *std::move(plan);
    setup->hash = state_hash(scene, options);
    setup->tracer = std::make_unique<PathTracer>(scene, setup->world, options.paths, stop);
    return std::unique_ptr<const BakeSetup>(std::move(setup));
}

std::uint64_t state_hash(const Scene& scene, const BakeOptions& o) {
    // Hash text, so that nothing depends on the padding of structures.
    const auto& a = o.atlas;
    const auto& p = o.paths;
    const std::string text =
        fmt::format("{:x} {} {} | {} {} {} {} {} | {} {} {} {} {} {} | {} {} {} {}", scene_hash(scene), o.codec,
                    static_cast<int>(o.frame), a.width, a.height, a.texels_per_metre.value_or(0), a.padding,
                    static_cast<int>(a.layout), p.bounces, p.seed, static_cast<int>(p.next_event),
                    static_cast<int>(p.environment_table), static_cast<int>(p.roulette), static_cast<int>(p.sun_size),
                    static_cast<int>(o.directions), static_cast<int>(o.push_out), o.target_error.value_or(0),
                    o.only_object.value_or(""));
    Hash hash;
    hash.bytes(text.data(), text.size());
    return hash.value();
}

}  // namespace lobelia
