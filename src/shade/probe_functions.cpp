#include "shade/probe_functions.h"

#include "core/math/octahedral_map.h"

namespace lobelia::shade {

// The same arithmetic as in src/bake/probes/probe_volume.cpp; ShaderParity compares them.
std::vector<ShaderFunction> probe_functions() {
    return {
        octahedral_place_code(),
        {"probe_map_place", R"(/// Returns the place of a unit direction on a probe's octahedral map, in [0, 1]^2.
vec2 probe_map_place(vec3 w) {
    vec2 place = octahedral_place(w);
    return vec2(0.5 + 0.5 * place.x, 0.5 + 0.5 * place.y);
}
)"},
        {"probe_weight",
         R"(/// Returns what a probe counts for, before the weights of all eight are divided by their sum. `trilinear`: its share by
/// place; `to_probe`: from the surface to the probe; `n`: the normal; `from_probe`: from the probe to the place moved
/// along the normal by a fifth of a cell; `moments`: its map's mean and mean squared distance at
/// probe_map_place(normalize(from_probe)); `validity` of the probe (Majercik et al. 2019).
float probe_weight(float trilinear, vec3 to_probe, vec3 n, vec3 from_probe, vec2 moments, float validity) {
    float far = length(from_probe);
    float facing = 0.5 + 0.5 * dot(to_probe, n) / max(length(to_probe), 1.0e-6);
    float seen = facing * facing + 0.2;
    if (far > moments.x) {
        // Chebyshev's bound on the share of light that travels farther.
        float variance = abs(moments.y - moments.x * moments.x);
        float beyond = far - moments.x;
        float share = variance / max(variance + beyond * beyond, 1.0e-12);
        seen = seen * share * share * share;
    }
    // Little light from behind walls becomes none.
    seen = choose(seen < 0.2, 25.0 * seen * seen * seen, seen);
    return (trilinear + 1.0e-7) * max(seen, 1.0e-7) * choose(validity < 0.5, 1.0e-6, 1.0);
}
)"}};
}

}  // namespace lobelia::shade
