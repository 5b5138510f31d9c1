// Tests that docs/references.bib has an entry for every paper that a source file names in its first lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "folders.h"

namespace lobelia {
namespace {

/// The comment that a file opens with, as one line.
std::string opening_comment(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string comment, line;
    while (std::getline(file, line) && line.starts_with("//")) comment += line.substr(2);
    return comment;
}

/// Splits the bibliography into entries, each from an @ at the beginning of a line to the next one.
std::vector<std::string> entries_of(const std::string& bibliography) {
    std::vector<std::string> entries;
    for (std::size_t begin = bibliography.find("\n@"); begin != std::string::npos;) {
        const std::size_t end = bibliography.find("\n@", begin + 1);
        entries.push_back(bibliography.substr(begin, end - begin));
        begin = end;
    }
    return entries;
}

TEST(References, EveryPaperThatAFileNamesHasAnEntry) {
    const std::filesystem::path docs = LOBELIA_DOCS_DIR;
    const auto entries = entries_of(test::contents(docs / "references.bib"));
    ASSERT_GT(entries.size(), 50u);
    // "Golub and Pereyra 1973", "Wang et al. 2009", "Sloan 2008".
    const std::regex paper(R"(([A-Z][A-Za-z'-]+)( et al\.| and (van )?[A-Z][a-z]+)? ((19|20)[0-9][0-9])\b)");
    std::size_t found = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(docs / ".." / "src")) {
        if (file.path().extension() != ".h" && file.path().extension() != ".cpp") continue;
        const std::string comment = opening_comment(file.path());
        for (std::sregex_iterator match(comment.begin(), comment.end(), paper), end; match != end; ++match) {
            const std::string author = (*match)[1], year = (*match)[4];
            ++found;
            EXPECT_TRUE(std::any_of(entries.begin(), entries.end(),
                                    [&](const std::string& entry) {
                                        return entry.find(author) != std::string::npos &&
                                               entry.find(year) != std::string::npos;
                                    }))
                << file.path().filename().string() << " names " << author << " " << year;
        }
    }
    EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace lobelia
