// Which codec and storage to take: those that nothing beats in error, bytes and time at once, and one of them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "measure/study/study.h"

namespace lobelia {

/// Purpose of the coefficients.
enum class Need { radiance, irradiance, specular };
[[nodiscard]] std::string_view to_string(Need need);

/// A codec in a storage: its size, error and time.
struct Candidate {
    CodecName codec;
    std::string storage;
    double bytes = 0;        ///< for a texel or probe
    double error = 0;        ///< RMS, over the mean
    double nanoseconds = 0;  ///< to evaluate one direction or normal; 0 if not measured
};

struct AdviceOptions {
    Need need = Need::irradiance;
    std::optional<double> budget = {};  ///< bytes for a texel or probe at most
    double target = 0.05;               ///< the error that is small enough
};

struct Advice {
    AdviceOptions options;
    std::vector<Candidate> front;  ///< by bytes, then by error
    std::size_t recommended = 0;   ///< in the front
    std::string reason;            ///< a sentence
};

/// The front: candidates to which no other is at least equal in error, bytes and time and better in one. Times count by
/// powers of two, and of equals the first is kept, unless it takes four times as long: they are noisy. Recommended is
/// what takes the fewest bytes of all within budget and target. Where the budget rules that out, it is the least error
/// that it can buy (of those within 2 % of it the fewest bytes); where nothing at all reaches the target, the least
/// product of error and bytes: half the bytes would more than double the error, and twice the bytes gain less than half
/// of it. Error: no candidates, or none within the budget.
[[nodiscard]] Result<Advice> advise(std::vector<Candidate> candidates, const AdviceOptions& options = {});

/// A table for people: from the front, the best for its bytes and the recommended one; then the reason.
[[nodiscard]] std::string to_text(const Advice& advice);
/// All of it, for scripts.
[[nodiscard]] nlohmann::json to_json(const Advice& advice);
/// A table of the whole front and its plot; `subject` names the environment or scene.
[[nodiscard]] Study to_study(const Advice& advice, const std::string& subject);

}  // namespace lobelia
