// Fills the template of studies.
#include "report/study_report.h"

#include <nlohmann/json.hpp>

#include "io/write_image.h"
#include "report/base64.h"
#include "report/page_template.h"

namespace lobelia {

Result<std::string> study_html(const Study& study) {
    nlohmann::json data = to_json(study), pictures = nlohmann::json::array();
    for (const auto& picture : study.pictures) {
        const auto png = encode_png(to_srgb(picture.image));
        if (!png) return Error{std::string("picture \"") + picture.title + "\": " + png.error().message};
        pictures.push_back({{"title", picture.title},
                            {"caption", picture.caption},
                            {"width", picture.image.width},
                            {"height", picture.image.height},
                            {"source", "data:image/png;base64," + base64(*png)}});
    }
    data["pictures"] = std::move(pictures);
    data["lobelia"] = LOBELIA_VERSION;
    const std::string text = script_safe(data);
    return fill_template("study/study.html", text.size(), [&](std::string_view mark, std::string& html) {
        if (mark == "study") html += text;
        return mark == "study";
    });
}

}  // namespace lobelia
