// docs/bases.md: every listed basis, from the cards and traits of the bases.
#pragma once

#include <string>

namespace lobelia {

/// The page as Markdown: a table of all, then a section for each family with formula, sizes, evaluators and their
/// stated errors, what it is good at and bad at.
[[nodiscard]] std::string bases_markdown();

}  // namespace lobelia
