// Numbers of things in sentences for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lobelia {

/// "1 edge", "3 edges": for nouns whose plural takes an s.
[[nodiscard]] inline std::string counted(std::size_t count, std::string_view noun) {
    return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace lobelia
