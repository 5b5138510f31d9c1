// Reads and writes coefficient files.
#include "coefficients/coefficient_file.h"

#include <nlohmann/json.hpp>

#include "io/json.h"

namespace lobelia {
namespace {

using nlohmann::json;

constexpr int k_coefficient_format = 1;

}  // namespace

std::string to_text(const CoefficientFile& file) {
    json coefficients = json::array();
    for (const Rgb& value : file.c) coefficients.push_back({value.r, value.g, value.b});
    const json content = {{"lobelia_coefficients", k_coefficient_format},
                          {"codec", file.codec.str()},
                          {"coefficients", std::move(coefficients)}};
    return json_text(content, 1) + "\n";
}

Result<CoefficientFile> coefficients_from_text(std::string_view text, const std::string& name) {
    return read_json(text, name, [](const JsonPlace& top) {
        if (!top.has("lobelia_coefficients"))
            top.refuse("no \"lobelia_coefficients\" version; is it from `lobelia encode`?");
        const auto version = top.at("lobelia_coefficients").whole(0, ~std::uint64_t{0});
        if (version != static_cast<std::uint64_t>(k_coefficient_format))
            top.at("lobelia_coefficients")
                .refuse("version " + std::to_string(version) + ", but this program reads version " +
                        std::to_string(k_coefficient_format) + "; write it again with `lobelia encode`");
        const auto codec = make_codec(top.at("codec").text());
        if (!codec) top.at("codec").refuse(codec.error().message);
        const JsonPlace list = top.at("coefficients");
        const std::size_t expected = codec->basis().size();
        if (list.is_list() && list.size() != expected)
            list.refuse(codec->name().basis + " has " + std::to_string(expected) +
                        " coefficients, but the file holds " + std::to_string(list.size()));
        CoefficientFile file{codec->name(), {}};
        for (const JsonPlace& rgb : list.list_of(expected)) {
            const Vec3 c = rgb.vector();
            file.c.push_back({c.x, c.y, c.z});
        }
        return file;
    });
}

}  // namespace lobelia
