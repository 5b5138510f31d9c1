// Tests that docs/bases.md equals what the program writes.
#include "measure/bases_document.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "lobelia/codec.h"

namespace lobelia {
namespace {

TEST(BasesPage, TheCommittedOneIsCurrent) {
    std::ifstream file(LOBELIA_DOCS_DIR "/bases.md");
    ASSERT_TRUE(file) << "docs/bases.md is missing: lobelia list --markdown > docs/bases.md";
    const std::string committed{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(committed == bases_markdown()) << "write it again: lobelia list --markdown > docs/bases.md";
}

TEST(BasesPage, NamesEveryBasisAndEvaluator) {
    const std::string page = bases_markdown();
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        EXPECT_NE(page.find("| `" + name + "` |"), std::string::npos) << name;
        const BasisCard& card = card_of(*basis);
        for (const auto& text : {card.family, card.formula, card.good_at, card.bad_at})
            EXPECT_FALSE(text.empty()) << name;
        EXPECT_NE(page.find("## " + std::string(card.family)), std::string::npos) << name;
        for (const auto& evaluator : basis->evaluator_names())
            EXPECT_NE(page.find("| `" + evaluator + "` |"), std::string::npos) << name << " " << evaluator;
    }
}

}  // namespace
}  // namespace lobelia
