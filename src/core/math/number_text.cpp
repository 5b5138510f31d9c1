// Numbers as text for people.
#include "core/math/number_text.h"

#include <cmath>
#include <cstdio>

namespace lobelia {

std::string table_number(double value, int digits) {
    char text[32];
    if (value != 0 && std::abs(value) < 1e-2) {
        // Drop the exponent's padding: 3.1e-04 reads as 3.1e-4.
        std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
        std::string shortened = text;
        const auto e = shortened.find('e');
        if (e != std::string::npos && shortened.size() > e + 3 && shortened[e + 2] == '0') shortened.erase(e + 2, 1);
        return shortened;
    }
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

}  // namespace lobelia
