// Error measures, accumulated in double precision.
#include "lobelia/metrics.h"

namespace lobelia {

double negative_share(ColourView a, std::span<const float> weights) {
    check_equal("weights", weights.size(), a.size);
    double negative = 0, total = 0;
    for (std::size_t i = 0; i < a.size; ++i) {
        total += weights[i];
        if (std::min({a.channel(0)[i], a.channel(1)[i], a.channel(2)[i]}) < 0) negative += weights[i];
    }
    return total > 0 ? negative / total : 0;
}

Errors errors(ColourView a, ColourView reference, std::span<const float> weights) {
    check_equal("colours for the reference", a.size, reference.size);
    check_equal("weights", weights.size(), a.size);
    Errors e;
    double total = 0, worst = -1;
    for (std::size_t i = 0; i < a.size; ++i) {
        const double w = weights[i];
        double squared = 0, relative = 0, symmetric = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = a.channel(k)[i], r = reference.channel(k)[i], d = x - r;
            const double magnitude = std::abs(x) + std::abs(r);
            squared += d * d;
            relative += d * d / (r * r + 0.01);
            symmetric += magnitude > 0 ? std::abs(d) / magnitude : 0;
        }
        total += w;
        e.rms += w * squared;
        e.rms_unweighted += squared;
        e.smape += w * symmetric;
        e.relmse += w * relative;
        if (squared > worst) {
            worst = squared;
            e.worst_index = i;
        }
    }
    if (a.size == 0 || !(total > 0)) return e;
    e.rms = std::sqrt(e.rms / (3 * total));
    e.rms_unweighted = std::sqrt(e.rms_unweighted / (3 * static_cast<double>(a.size)));
    e.smape /= 3 * total;
    e.relmse /= 3 * total;
    e.negative_share = negative_share(a, weights);
    e.worst = std::sqrt(worst / 3);
    return e;
}

}  // namespace lobelia
