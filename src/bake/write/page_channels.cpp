// Names of the channels of lightmap pages.
#include "lobelia/lightmap.h"

#include <fmt/format.h>

namespace lobelia {

std::vector<std::string> PageChannels::names() const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < coefficients; ++i)
        for (const char channel : {'R', 'G', 'B'}) result.push_back(fmt::format("c{}.{}", i, channel));
    for (const char* name : {"E.R", "E.G", "E.B", "E.error"}) result.emplace_back(name);
    return result;
}

}  // namespace lobelia
