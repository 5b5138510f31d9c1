// Tables of a comparison.
#include "measure/comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lobelia {
namespace {

constexpr std::size_t k_most_rows = 12;

/// A figure in per cent of the mean; a dash if there is no mean.
std::string percent_of(double error, double mean) {
    return mean > 0 && std::isfinite(error) ? fmt::format("{:.3g} %", 100 * error / mean) : "-";
}

double order(const Method& m) {
    const double rms = m.irradiance_over_pi.rms;
    return std::isnan(rms) ? std::numeric_limits<double>::infinity() : rms;
}

/// The best method of each basis, by irradiance error.
std::vector<const Method*> best_of_bases(const Comparison& comparison) {
    std::vector<const Method*> ranked;
    for (const Method& method : comparison.methods) ranked.push_back(&method);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Method* a, const Method* b) { return order(*a) < order(*b); });
    std::set<std::string> seen;
    std::erase_if(ranked, [&](const Method* m) { return !seen.insert(m->name.basis).second; });
    return ranked;
}

}  // namespace

std::string summary_text(const Comparison& comparison) {
    const bool is_recipe = !comparison.recipe.empty();
    const double mean = mean_value(comparison);
    std::vector<const Method*> shown;
    if (is_recipe)
        for (const Method& method : comparison.methods) shown.push_back(&method);
    else
        shown = best_of_bases(comparison);
    const std::size_t count = is_recipe ? shown.size() : std::min(k_most_rows, shown.size());

    std::string text =
        fmt::format("{:<42} {:>6} {:>9} {:>9} {:>11} {:>11} {:>8}\n", is_recipe ? "codec" : "best codec of each basis",
                    "bytes", "E error", "L error", "E/pi rms", "L rms", "E sMAPE");
    for (std::size_t i = 0; i < count; ++i) {
        const Method& m = *shown[i];
        const double e = is_recipe ? m.irradiance_over_pi.rms_unweighted : m.irradiance_over_pi.rms;
        const double l = is_recipe ? m.radiance.rms_unweighted : m.radiance.rms;
        text += fmt::format("{:<42} {:>6} {:>9} {:>9} {:>11.5g} {:>11.5g} {:>8.3g}\n", m.name.str(), 12 * m.c.size(),
                            percent_of(e, mean), percent_of(l, mean), e, l, m.irradiance_over_pi.smape);
    }
    if (shown.size() > count) text += fmt::format("... and {} more bases, in the report\n", shown.size() - count);
    text +=
        fmt::format("Errors in per cent are RMS over the mean radiance of the environment, {:.4g} W/(m^2 sr).\n", mean);
    return text;
}

std::string stored_text(const Comparison& comparison) {
    std::vector<std::pair<const Method*, const StorageErrors*>> ranked;
    for (const Method& method : comparison.methods)
        for (const StorageErrors& stored : method.storage)
            if (!shares_texels(**find_storage(stored.storage))) ranked.emplace_back(&method, &stored);
    if (ranked.empty()) return {};
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second->bytes, a.second->irradiance_over_pi_rms) <
               std::pair(b.second->bytes, b.second->irradiance_over_pi_rms);
    });
    const double mean = mean_value(comparison);
    std::string text =
        fmt::format("\n{:<42} {:>6} {:>9} {:>9} {:>11} {:>11} {:>12}\n", "stored: smallest error for the bytes",
                    "bytes", "E error", "L error", "E/pi rms", "L rms", "storage");
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [method, stored] : ranked) {
        if (!(stored->irradiance_over_pi_rms < least)) continue;
        least = stored->irradiance_over_pi_rms;
        text +=
            fmt::format("{:<42} {:>6.4g} {:>9} {:>9} {:>11.5g} {:>11.5g} {:>12}\n", method->name.str(), stored->bytes,
                        percent_of(stored->irradiance_over_pi_rms, mean), percent_of(stored->radiance_rms, mean),
                        stored->irradiance_over_pi_rms, stored->radiance_rms, stored->storage);
    }
    return text;
}

}  // namespace lobelia
