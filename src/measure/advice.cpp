// The front by comparing all pairs: there are a few thousand candidates at most.
#include "measure/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lobelia {
namespace {

/// Times that are equal for choosing: the power of two.
int time_class(const Candidate& c) {
    return c.nanoseconds > 0 ? static_cast<int>(std::floor(std::log2(c.nanoseconds))) : 0;
}

/// Twice the time may be noise, four times it is not: what is recommended must not depend on noise.
bool is_faster(const Candidate& a, const Candidate& b) { return time_class(a) + 2 <= time_class(b); }

bool beats(const Candidate& a, const Candidate& b) {
    const bool no_worse = a.error <= b.error && a.bytes <= b.bytes && time_class(a) <= time_class(b);
    return no_worse && (a.error < b.error || a.bytes < b.bytes || is_faster(a, b));
}

std::vector<Candidate> front_of(std::vector<Candidate> candidates) {
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.bytes, a.error) < std::pair(b.bytes, b.error);
    });
    std::vector<Candidate> front;
    for (const Candidate& c : candidates) {
        const bool beaten =
            std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) { return beats(other, c); });
        const bool repeated = std::any_of(front.begin(), front.end(), [&](const Candidate& other) {
            return other.error == c.error && other.bytes == c.bytes && !is_faster(c, other);
        });
        if (!beaten && !repeated) front.push_back(c);
    }
    return front;
}

std::string text_of(const Candidate& c) { return c.codec.str() + " in " + c.storage; }

/// The fewest bytes within budget and target.
std::optional<std::size_t> smallest_good(const std::vector<Candidate>& front, const AdviceOptions& options) {
    for (std::size_t i = 0; i < front.size(); ++i)
        if (front[i].error <= options.target) {
            if (options.budget && front[i].bytes > *options.budget) return std::nullopt;
            return i;
        }
    return std::nullopt;
}

/// The least error within the budget; of those within 2 % of it, the fewest bytes.
std::size_t best_within(const std::vector<Candidate>& front, double budget) {
    double least = HUGE_VAL;
    for (const Candidate& c : front)
        if (c.bytes <= budget) least = std::min(least, c.error);
    constexpr double k_as_good = 1.02;
    return static_cast<std::size_t>(
        std::find_if(front.begin(), front.end(), [&](const Candidate& c) { return c.error <= k_as_good * least; }) -
        front.begin());
}

/// The least product of error and bytes.
std::size_t balanced(const std::vector<Candidate>& front) {
    const auto product = [](const Candidate& c) { return c.error * c.bytes; };
    return static_cast<std::size_t>(
        std::min_element(front.begin(), front.end(),
                         [&](const Candidate& a, const Candidate& b) { return product(a) < product(b); }) -
        front.begin());
}

/// Chooses a candidate and states the reason.
void recommend(Advice& advice) {
    const AdviceOptions& options = advice.options;
    const std::string small_enough =
        fmt::format("{:.3g} % of the mean {}", 100 * options.target, to_string(options.need));
    std::string why;
    if (const auto good = smallest_good(advice.front, options)) {
        advice.recommended = *good;
        why = "is the smallest within " + small_enough;
    } else if (options.budget) {
        advice.recommended = best_within(advice.front, *options.budget);
        why = fmt::format("has the smallest error in at most {:.4g} bytes; none there is within {}", *options.budget,
                          small_enough);
    } else {
        advice.recommended = balanced(advice.front);
        why = "has the smallest product of bytes and error; none is within " + small_enough;
    }
    const Candidate& chosen = advice.front[advice.recommended];
    advice.reason =
        fmt::format("{} {}: {:.3g} % in {:.4g} bytes", text_of(chosen), why, 100 * chosen.error, chosen.bytes);
}

/// The next of the front with fewer bytes, or with less error, than the recommended one; null where there is none.
const Candidate* cheaper(const Advice& advice) {
    const Candidate& chosen = advice.front[advice.recommended];
    const Candidate* best = nullptr;
    for (const Candidate& c : advice.front)
        if (c.bytes < chosen.bytes && (best == nullptr || c.error < best->error)) best = &c;
    return best;
}
const Candidate* better(const Advice& advice) {
    const Candidate& chosen = advice.front[advice.recommended];
    const Candidate* best = nullptr;
    for (const Candidate& c : advice.front)
        if (c.error < 0.9 * chosen.error && (best == nullptr || c.bytes < best->bytes)) best = &c;
    return best;
}

/// Says what a little less and a little more would give.
void add_neighbours(Advice& advice) {
    if (const Candidate* next = cheaper(advice))
        advice.reason += fmt::format("; with fewer bytes, {} at {:.4g} has an error of {:.3g} %", text_of(*next),
                                     next->bytes, 100 * next->error);
    if (const Candidate* next = better(advice))
        advice.reason +=
            fmt::format("; for {:.3g} %, {} takes {:.4g} bytes", 100 * next->error, text_of(*next), next->bytes);
    advice.reason += ".";
}

std::string nanoseconds_text(const Candidate& c) {
    return c.nanoseconds > 0 ? fmt::format("{:.1f}", c.nanoseconds) : "";
}

}  // namespace

std::string_view to_string(Need need) {
    switch (need) {
        case Need::radiance:
            return "radiance";
        case Need::irradiance:
            return "irradiance";
        case Need::specular:
            return "specular";
    }
    return {};
}

Result<Advice> advise(std::vector<Candidate> candidates, const AdviceOptions& options) {
    std::erase_if(candidates, [](const Candidate& c) { return !std::isfinite(c.error) || !(c.bytes > 0); });
    if (candidates.empty()) return Error{"no codec to choose from"};
    Advice advice{options, front_of(std::move(candidates)), 0, {}};
    // Even the smallest may be too large.
    if (const Candidate& smallest = advice.front.front(); options.budget && smallest.bytes > *options.budget)
        return Error{fmt::format("nothing fits {:.4g} bytes: the smallest is {} with {:.4g}", *options.budget,
                                 text_of(smallest), smallest.bytes)};
    recommend(advice);
    add_neighbours(advice);
    return advice;
}

std::string to_text(const Advice& advice) {
    const std::string error = fmt::format("{} error", to_string(advice.options.need));
    std::string text = fmt::format("{:<42} {:<14} {:>8} {:>17} {:>8}\n", "codec", "storage", "bytes", error, "ns");
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < advice.front.size(); ++i) {
        const Candidate& c = advice.front[i];
        if (c.error >= least && i != advice.recommended) continue;
        least = std::min(least, c.error);
        text += fmt::format("{:<42} {:<14} {:>8.4g} {:>15.3g} % {:>8} {}\n", c.codec.str(), c.storage, c.bytes,
                            100 * c.error, nanoseconds_text(c), i == advice.recommended ? "<-" : "");
    }
    return text + "\n" + advice.reason + "\n";
}

nlohmann::json to_json(const Advice& advice) {
    const auto entry = [](const Candidate& c) {
        nlohmann::json j = {{"codec", c.codec.str()}, {"storage", c.storage}, {"bytes", c.bytes}, {"error", c.error}};
        if (c.nanoseconds > 0) j["evaluate_ns"] = c.nanoseconds;
        return j;
    };
    nlohmann::json j = {{"format", 1},
                        {"need", to_string(advice.options.need)},
                        {"target", advice.options.target},
                        {"reason", advice.reason}};
    if (advice.options.budget) j["budget"] = *advice.options.budget;
    j["recommended"] = entry(advice.front[advice.recommended]);
    for (const Candidate& c : advice.front) j["front"].push_back(entry(c));
    return j;
}

Study to_study(const Advice& advice, const std::string& subject) {
    Study study;
    study.name = "advice";
    study.title = fmt::format("Codecs for the {} of {}", to_string(advice.options.need), subject);
    study.summary = advice.reason;
    Study::Table& table = study.tables.emplace_back();
    table.title = "Pareto-optimal in error, bytes and time";
    table.note = "Error: RMS over the mean. Bytes for a texel or probe. Recommended: marked by an asterisk.";
    table.columns = {"codec", "storage", "bytes", "error", "ns", ""};
    Study::Plot& plot = study.plots.emplace_back();
    plot.title = "Error against bytes";
    plot.x_label = "bytes for a texel or probe";
    plot.y_label = "RMS error over the mean";
    plot.x_axis = plot.y_axis = Study::Axis::logarithmic;
    Study::Series front{"smallest error for this many bytes", {}, {}};
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < advice.front.size(); ++i) {
        const Candidate& c = advice.front[i];
        table.rows.push_back({c.codec.str(), c.storage, fmt::format("{:.4g}", c.bytes),
                              fmt::format("{:.3g} %", 100 * c.error), nanoseconds_text(c),
                              i == advice.recommended ? "*" : ""});
        if (c.error >= least || !(c.error > 0)) continue;
        least = c.error;
        front.x.push_back(c.bytes);
        front.y.push_back(c.error);
    }
    const Candidate& chosen = advice.front[advice.recommended];
    plot.series = {std::move(front), {"recommended", {chosen.bytes}, {chosen.error}}};
    return study;
}

}  // namespace lobelia
