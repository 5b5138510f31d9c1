// Tests that all twenty figures of the published tables on ennis.hdr are reproduced exactly.
#include "measure/recipe.h"

#include <gtest/gtest.h>

#include "ennis.h"

namespace lobelia {
namespace {

ComparisonOptions recipe_figures() {
    ComparisonOptions options;
    options.pictures = false;
    return options;
}

struct Published {
    const char* encoder;
    double radiance_rms, irradiance_rms;
};

void expect_published(Recipe recipe, const std::vector<Published>& table) {
    const Comparison result = run_recipe(recipe, test::ennis(), recipe_figures());
    ASSERT_EQ(result.methods.size(), table.size());
    EXPECT_EQ(result.recipe, recipe_name(recipe));
    EXPECT_EQ(result.samples, 20000u);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Method& method = result.methods[i];
        EXPECT_EQ(method.name, (CodecName{"sg12", table[i].encoder, "hill"}));
        EXPECT_NEAR(method.radiance.rms_unweighted, table[i].radiance_rms, 1e-4 * table[i].radiance_rms)
            << table[i].encoder;
        EXPECT_NEAR(method.irradiance_over_pi.rms_unweighted, table[i].irradiance_rms, 1e-4 * table[i].irradiance_rms)
            << table[i].encoder;
    }
}

TEST(Recipes, PublishedFiguresAreReproduced) {
    SKIP_WITHOUT_ENNIS();
    expect_published(Recipe::published, {{"projection", 4.24835, 0.441404},
                                         {"least-squares", 3.80738, 0.228353},
                                         {"running-average", 3.81673, 0.221796},
                                         {"nnls", 3.9339, 0.786142},
                                         {"running-average-nn", 3.92593, 0.670631}});
}

TEST(Recipes, UpdatedFiguresAreReproduced) {
    SKIP_WITHOUT_ENNIS();
    expect_published(Recipe::updated, {{"projection", 4.24341, 0.44259},
                                       {"least-squares", 3.81043, 0.241267},
                                       {"progressive", 3.80723, 0.243617},
                                       {"nnls", 3.93677, 0.808848},
                                       {"progressive-nn", 3.93653, 0.807047}});
}

TEST(Recipes, PublishedCoefficientsAreReproduced) {
    SKIP_WITHOUT_ENNIS();
    const Comparison result = run_recipe(Recipe::published, test::ennis(), recipe_figures());
    const auto& c = result.methods[1].c;
    const auto expect = [](Rgb found, std::array<double, 3> printed) {
        EXPECT_NEAR(found.r, printed[0], 1e-4 * std::abs(printed[0]) + 1e-4);
        EXPECT_NEAR(found.g, printed[1], 1e-4 * std::abs(printed[1]) + 1e-4);
        EXPECT_NEAR(found.b, printed[2], 1e-4 * std::abs(printed[2]) + 1e-4);
    };
    expect(c[0], {-0.019362, -0.125421, -0.249855});
    expect(c[11], {22.122445, 22.832998, 25.833863});
    int zeros = 0;
    for (const Rgb& v : result.methods[3].c) zeros += (v.r == 0) + (v.g == 0) + (v.b == 0);
    EXPECT_EQ(zeros, 23) << "non-negative coefficients that are 0";
}

TEST(Recipes, BlackEnvironmentGivesZerosNotNaN) {
    for (const Recipe recipe : {Recipe::published, Recipe::updated}) {
        const Comparison result = run_recipe(recipe, Image(256, 128), recipe_figures());
        for (const Method& method : result.methods) {
            EXPECT_EQ(method.radiance.rms_unweighted, 0) << method.name.str();
            EXPECT_EQ(method.irradiance_over_pi.rms_unweighted, 0) << method.name.str();
            for (const Rgb& v : method.c) EXPECT_EQ(v, Rgb{});
        }
    }
}

}  // namespace
}  // namespace lobelia
