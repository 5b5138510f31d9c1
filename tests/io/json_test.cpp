// Tests of JSON that is written: no number that JSON cannot hold becomes null unnoticed.
#include "io/json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace lobelia {
namespace {

using Json = nlohmann::ordered_json;

TEST(FiguresText, WritesWhatIsFinite) {
    const auto text = figures_text(Json{{"a", 1.5}, {"b", {1, nullptr, "text", Json::array()}}});
    ASSERT_TRUE(text);
    EXPECT_EQ(Json::parse(*text)["a"], 1.5);
}

TEST(FiguresText, NamesTheFigureThatIsNot) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const std::pair<Json, std::string> cases[] = {{Json{{"a", nan}}, "\"a\""},
                                                  {Json{{"a", 1}, {"b", {1.0, {{"c", -infinity}}}}}, "\"b/1/c\""},
                                                  {Json::array({1.0, infinity}), "\"1\""}};
    for (const auto& [figures, place] : cases) {
        const auto text = figures_text(figures);
        ASSERT_FALSE(text);
        EXPECT_NE(text.error().message.find(place), std::string::npos) << text.error().message;
    }
}

}  // namespace
}  // namespace lobelia
