// Tests that the documents name files that exist, that their links resolve, and that the tour's two lists stay short.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "folders.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

const fs::path k_docs = LOBELIA_DOCS_DIR;
const fs::path k_root = k_docs.parent_path();

/// Returns the lines of a Markdown file outside of fenced code blocks.
std::vector<std::string> prose_of(const fs::path& path) {
    std::istringstream text(test::contents(path));
    std::vector<std::string> lines;
    bool fenced = false;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with("```"))
            fenced = !fenced;
        else if (!fenced)
            lines.push_back(line);
    }
    return lines;
}

std::vector<fs::path> documents() {
    std::vector<fs::path> found;
    for (const fs::path& folder : {k_root, k_docs})
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

/// Returns every match of the first group of `pattern` in `line`.
std::vector<std::string> matches(const std::string& line, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

std::vector<std::string> inline_code(const std::string& line) {
    static const std::regex code("`([^`]+)`");
    return matches(line, code);
}

/// Returns whether inline code names a file or a folder from the root, such as "src/io/" and "src/trace/rays.*".
bool is_path(const std::string& code) {
    static const std::regex path(R"((src|include|docs|examples|tests|bench|fuzz|tools|setup|cmake|python)/[\w./*-]*)");
    return std::regex_match(code, path);
}

/// Returns whether inline code is the name of a source file, with or without folders.
bool is_source(const std::string& code) {
    static const std::regex source(R"([\w./-]+\.(h|cpp|mjs|py|cmake|\*))");
    return std::regex_match(code, source);
}

/// Returns whether a path from the root exists; a last component "name.*" stands for any extension.
bool exists_in_tree(const std::string& path) {
    if (!path.ends_with(".*")) return fs::exists(k_root / path);
    const fs::path stem = fs::path(path.substr(0, path.size() - 2));
    const fs::path folder = k_root / stem.parent_path();
    if (!fs::is_directory(folder)) return false;
    return std::any_of(fs::directory_iterator(folder), {},
                       [&](const auto& entry) { return entry.path().stem() == stem.filename(); });
}

/// Returns the anchors that GitHub makes of a document's headings.
std::set<std::string> anchors_of(const fs::path& path) {
    std::set<std::string> anchors;
    for (const std::string& line : prose_of(path)) {
        const std::size_t text = line.find_first_not_of('#');
        if (text == 0 || text == std::string::npos || line[text] != ' ') continue;
        std::string anchor;
        for (const char c : line.substr(text + 1)) {
            const auto byte = static_cast<unsigned char>(c);
            if (c == ' ')
                anchor += '-';
            else if (byte >= 0x80 || std::isalnum(byte) || c == '-' || c == '_')
                anchor += static_cast<char>(std::tolower(byte));
        }
        anchors.insert(anchor);
    }
    return anchors;
}

/// Returns the first code of each numbered item of the section with this heading.
std::vector<std::string> numbered_files(const fs::path& document, const std::string& heading) {
    std::vector<std::string> files;
    bool inside = false;
    for (const std::string& line : prose_of(document)) {
        if (line.starts_with("#")) inside = line == heading;
        if (!inside || line.empty() || !std::isdigit(static_cast<unsigned char>(line[0]))) continue;
        const auto code = inline_code(line);
        files.push_back(code.empty() ? std::string() : code.front());
        EXPECT_TRUE(line.starts_with(std::to_string(files.size()) + ". ")) << line;
    }
    return files;
}

TEST(Documents, EveryNamedPathExists) {
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        const std::string name = document.filename().string();
        // The files of their examples do not exist.
        if (name.starts_with("adding-")) continue;
        // These two must give the folder of every source file.
        const bool is_map = name == "README.md" || name == "tour.md";
        for (const std::string& line : prose_of(document))
            for (const std::string& code : inline_code(line)) {
                if (!is_path(code) && !(is_map && is_source(code))) continue;
                ++found;
                EXPECT_TRUE(exists_in_tree(code)) << name << " names " << code;
            }
    }
    EXPECT_GT(found, 100u);
}

TEST(Documents, EveryLinkResolves) {
    const std::regex link(R"(\]\(([^)\s]+)\))");
    std::size_t found = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& line : prose_of(document))
            for (const std::string& target : matches(line, link)) {
                if (target.find("://") != std::string::npos) continue;
                ++found;
                const std::size_t hash = target.find('#');
                const std::string file = target.substr(0, hash);
                const fs::path linked = file.empty() ? document : document.parent_path() / file;
                EXPECT_TRUE(fs::exists(linked)) << document.filename().string() << " links to " << target;
                if (hash == std::string::npos || !fs::exists(linked)) continue;
                EXPECT_TRUE(anchors_of(linked).contains(target.substr(hash + 1)))
                    << document.filename().string() << " links to " << target << ", which has no such heading";
            }
    }
    EXPECT_GT(found, 100u);
}

TEST(Documents, TheTourFollowsOneSampleAndOneTexelThroughFewFiles) {
    const struct {
        const char* heading;
        std::size_t most;
    } lists[] = {{"## One sample", 12}, {"## One texel", 25}};
    for (const auto& list : lists) {
        const auto files = numbered_files(k_docs / "tour.md", list.heading);
        EXPECT_GE(files.size(), 8u) << list.heading;
        EXPECT_LE(files.size(), list.most) << list.heading;
        for (const std::string& file : files)
            EXPECT_TRUE(fs::is_regular_file(k_root / file)) << list.heading << " names " << file;
        EXPECT_EQ(std::set(files.begin(), files.end()).size(), files.size()) << list.heading << " repeats a file";
    }
}

}  // namespace
}  // namespace lobelia
