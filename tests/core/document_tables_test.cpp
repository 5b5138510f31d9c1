// Tests the tables of docs/*.md against the code: sizes of states, ranges and errors of evaluators, bytes of storages.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <charconv>
#include <fstream>
#include <map>
#include <regex>

#include "core/basis/sg/sg_irradiance.h"
#include "lobelia/codec.h"
#include "lobelia/encoders.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

std::string text_of(const std::string& document) {
    std::ifstream file(std::string(LOBELIA_DOCS_DIR) + "/" + document);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Returns the rows, cell by cell, of the table whose header line begins with `header`.
std::vector<std::vector<std::string>> table(const std::string& document, const std::string& header) {
    std::istringstream lines(text_of(document));
    std::vector<std::vector<std::string>> rows;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(header)) {
            inside = true;
            std::getline(lines, line);  // the rule below the header
            continue;
        }
        if (inside && !line.starts_with("|")) break;
        if (!inside) continue;
        std::istringstream cells(line.substr(1));
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, '|');) row.push_back(trimmed(cell));
        rows.push_back(std::move(row));
    }
    EXPECT_FALSE(rows.empty()) << document << ": no table " << header;
    return rows;
}

/// Returns the names in backticks; "-nn" stands for the name before it with that ending.
std::vector<std::string> names_in(const std::string& cell) {
    static const std::regex code("`([^`]+)`");
    std::vector<std::string> names;
    for (std::sregex_iterator match(cell.begin(), cell.end(), code), end; match != end; ++match) {
        const std::string name = (*match)[1];
        names.push_back(name.starts_with("-") ? names.back() + name : name);
    }
    return names;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// Returns whether two numbers agree to the digits of a table: within the fraction `share` of the larger.
void expect_same(double stated, double found, double share, const std::string& what) {
    EXPECT_NEAR(stated, found, share * std::max(std::abs(stated), std::abs(found))) << what;
}

/// Evaluates a sum such as "6 + 3n + n(n+1)/2 + 147".
std::size_t evaluated(const std::string& formula, std::size_t n) {
    std::istringstream terms(formula);
    std::size_t sum = 0;
    for (std::string term; std::getline(terms, term, '+');) {
        // n(n+1)/2 is split at its own +.
        if (trimmed(term) == "n(n") {
            std::getline(terms, term, '+');
            EXPECT_EQ(trimmed(term), "1)/2") << formula;
            sum += n * (n + 1) / 2;
            continue;
        }
        const std::string one = trimmed(term);
        std::size_t factor = 1;
        const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), factor);
        EXPECT_EQ(error, std::errc()) << formula;
        sum += end == one.data() + one.size() ? factor : factor * n;
    }
    return sum;
}

TEST(Documents, StateSizesOfEncoders) {
    std::vector<std::string> documented;
    for (const auto& row : table("encoders.md", "| name | what it solves"))
        for (const auto& name : names_in(row.at(0))) {
            documented.push_back(name);
            for (const std::size_t n : {12u, 7u}) {
                const auto basis = make_basis("sg" + std::to_string(n)).value();
                const auto encoder = make_encoder(name, basis).value();
                EXPECT_EQ(evaluated(row.at(2), n), encoder->state_size()) << name << " for n = " << n;
                if (n == 12) {
                    EXPECT_EQ(row.at(3), std::to_string(encoder->state_size())) << name;
                }
                EXPECT_EQ(row.at(4), encoder->merging() == Merging::exact ? "exact" : "approximate") << name;
            }
        }
    auto listed = encoder_names();
    std::sort(listed.begin(), listed.end());
    std::sort(documented.begin(), documented.end());
    EXPECT_EQ(documented, listed);
}

TEST(Documents, TheRidgeOfSampledGramMatrices) {
    char text[64];
    std::snprintf(text, sizeof text, "a ridge of %.0e of", k_gram_ridge);
    // 1e-06 is written 1e-6.
    const std::string stated = std::regex_replace(std::string(text), std::regex("e-0"), "e-");
    EXPECT_NE(text_of("encoders.md").find(stated), std::string::npos) << stated;
}

TEST(Documents, EigenvaluesThatSetTheSpeedOfProgressiveEncoders) {
    for (const auto& row : table("encoders.md", "| set | least")) {
        const std::string name = names_in(row.at(0)).at(0);
        const auto basis = as_linear(make_basis(name).value());
        const Matrix gram = basis->gram();
        const auto n = static_cast<Eigen::Index>(basis->size());
        Eigen::MatrixXd unit = Eigen::Map<const Eigen::MatrixXd>(gram.data(), n, n);
        const Eigen::VectorXd scale = unit.diagonal().cwiseSqrt().cwiseInverse();
        unit = scale.asDiagonal() * unit * scale.asDiagonal();
        const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit).eigenvalues();
        expect_same(number(row.at(1)), values.minCoeff(), 0.03, name);
        expect_same(number(row.at(2)), values.maxCoeff(), 0.01, name);
    }
}

TEST(Documents, RangesAndErrorsOfGaussianIrradiance) {
    std::vector<std::string> documented, listed;
    const auto rows = table("evaluators.md", "| name | range of");
    for (const SgIrradianceInfo& entry : sg_irradiance_list()) listed.emplace_back(entry.name);
    for (const auto& row : rows) {
        documented.push_back(names_in(row.at(0)).at(0));
        const auto kind = sg_irradiance_from_name(documented.back());
        ASSERT_TRUE(kind) << documented.back();
        const SgIrradianceInfo& entry = sg_irradiance_list()[static_cast<std::size_t>(*kind)];
        EXPECT_EQ("sharpness " + row.at(1), entry.range) << documented.back();
        expect_same(number(row.at(2)), entry.error, 1e-9, documented.back());
    }
    EXPECT_EQ(documented, listed);
}

TEST(Documents, BytesOfStorages) {
    std::vector<std::string> documented, listed;
    for (const Storage& storage : storages()) listed.emplace_back(storage.name);
    for (const auto& row : table("storage.md", "| storage | supports")) {
        documented.push_back(names_in(row.at(0)).at(0));
        const Storage& storage = **find_storage(documented.back());
        std::istringstream bytes(row.at(2));
        for (const std::size_t count : {4u, 9u, 12u}) {
            std::string stated;
            std::getline(bytes, stated, '/');
            if (trimmed(stated) == "-") continue;
            const CoefficientTraits traits{count, true, true, std::vector<float>(count, 1.0f)};
            EXPECT_EQ(trimmed(stated), std::to_string(static_cast<int>(bytes_per_texel(storage.layout(traits)))))
                << documented.back() << " of " << count;
        }
    }
    EXPECT_EQ(documented, listed);
}

}  // namespace
}  // namespace lobelia
