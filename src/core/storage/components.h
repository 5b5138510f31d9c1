// Components of a coefficient, as shares of its red, green and blue.
#pragma once

#include <array>

#include "lobelia/texture_layout.h"

namespace lobelia {

/// Shares of r, g, b in a component, and of a component in r, g, b.
struct ComponentShares {
    float in[3], out[3];
};
inline constexpr std::array<ComponentShares, 6> k_component_shares = {{
    {{1, 0, 0}, {1, 0, 0}},
    {{0, 1, 0}, {0, 1, 0}},
    {{0, 0, 1}, {0, 0, 1}},
    {{0.25f, 0.5f, 0.25f}, {1, 1, 1}},
    {{0.5f, 0, -0.5f}, {1, 0, -1}},
    {{-0.25f, 0.5f, -0.25f}, {-1, 1, -1}},
}};

[[nodiscard]] inline const ComponentShares& shares_of(Component component) {
    return k_component_shares[static_cast<std::size_t>(component)];
}

}  // namespace lobelia
