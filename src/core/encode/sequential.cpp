// Sequential encoders: shared padding, transposition and step sizes around three vectorised update rules.
#include "lobelia/encoders.h"

#include <Eigen/Dense>
#include <limits>

#include "core/math/kernels.h"
#include "core/math/scratch.h"

namespace lobelia {
namespace {

/// State: sum of weights, number of samples, then b (r, g, b arrays) and, if wanted, one number per lobe, each of
/// size() floats.
class SequentialEncoder : public LinearEncoder {
  public:
    SequentialEncoder(const std::shared_ptr<const LinearBasis>& basis_of, Sign sign)
        : LinearEncoder(basis_of), sign_(sign) {}

    [[nodiscard]] std::size_t state_size() const override { return k_header + arrays() * basis().size(); }
    [[nodiscard]] Merging merging() const override { return Merging::approximate; }
    [[nodiscard]] bool is_non_negative() const override { return sign_ == Sign::non_negative; }

    void add(std::span<float> state, SampleView samples) const final {
        check_state(state);
        const std::size_t n = basis().size(), lanes = round_up_to_lanes(n);
        const std::size_t at_once = std::min(samples.size, k_block_size);
        const Scratch memory(5 * lanes + 2 * n * k_block_size + 2 * lanes * at_once);
        float* const padded = memory.data();
        float* const rows = padded + 5 * lanes;
        float* const values = rows + 2 * n * k_block_size;
        float* const gains = values + lanes * at_once;

        // Unpack the state into whole lanes, zero past the last lobe.
        std::fill_n(padded, 5 * lanes, 0.0f);
        std::fill_n(values, 2 * lanes * at_once, 0.0f);
        kernels::Sequential s;
        s.lanes = lanes;
        s.lowest = is_non_negative() ? 0.0f : -std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < 3; ++k) s.b[k] = padded + k * lanes;
        s.per_lobe = padded + 3 * lanes;
        s.floor = padded + 4 * lanes;
        for (std::size_t k = 0; k < arrays(); ++k) std::copy_n(state.data() + k_header + k * n, n, padded + k * lanes);
        if (state[k_count] == 0) start(s);
        fill_floor(padded + 4 * lanes);

        // Go through the samples, lobes side by side.
        Progress progress{state[k_weight], state[k_count]};
        for_each_part(samples, k_block_size, [&](SampleView block, std::size_t) {
            basis().values(block.directions(), rows);
            transpose(rows, n, lanes, block.size, values);
            s.values = values;
            if (wants_gains()) {
                fill_gains(rows, block.size, rows + n * k_block_size);
                transpose(rows + n * k_block_size, n, lanes, block.size, gains);
                s.gains = gains;
            }
            Steps steps;
            steps.first = progress.count;
            for (std::size_t j = 0; j < block.size; ++j) steps.of[j] = step(block.solid_angles()[j], progress);
            update(s, block.radiance(), steps);
        });

        // Pack it again.
        state[k_weight] = static_cast<float>(progress.weight);
        state[k_count] = static_cast<float>(progress.count);
        for (std::size_t k = 0; k < arrays(); ++k) std::copy_n(padded + k * lanes, n, state.data() + k_header + k * n);
    }

    void solve(std::span<const float> state, std::span<Rgb> c) const override {
        check_state(state);
        const std::size_t n = basis().size();
        check_equal("coefficients", c.size(), n);
        const float* b = state.data() + k_header;
        for (std::size_t i = 0; i < n; ++i) c[i] = {b[i], b[n + i], b[2 * n + i]};
    }

    /// Averages the estimates by what each has seen: not what one pass over both would give.
    void merge(std::span<float> state, std::span<const float> other) const override {
        check_state(state);
        check_state(other);
        const std::size_t n = basis().size();
        const float total = state[k_weight] + other[k_weight];
        if (!(total > 0)) return;
        for (std::size_t i = 0; i < n; ++i) {
            const float share = merge_share(state, other, k_header + 3 * n + i, other[k_weight] / total);
            for (std::size_t k = 0; k < 3; ++k) {
                float& b = state[k_header + k * n + i];
                b += share * (other[k_header + k * n + i] - b);
            }
        }
        for (std::size_t i = k_header + 3 * n; i < state.size(); ++i)
            merge_per_lobe(state[i], other[i], other[k_weight] / total);
        state[k_weight] = total;
        state[k_count] += other[k_count];
    }

  protected:
    enum : std::size_t { k_weight, k_count, k_header };
    struct Progress {
        double weight = 0, count = 0;
    };

    /// The steps of a block of samples, of which `first` came before.
    struct Steps {
        double first = 0;
        float of[k_block_size];
    };

    /// The first coefficients, in place of zeros.
    virtual void start(const kernels::Sequential&) const {}
    /// The least denominators; the lanes past the last lobe too.
    virtual void fill_floor(float*) const {}
    [[nodiscard]] virtual bool wants_gains() const { return false; }
    [[nodiscard]] virtual bool wants_numbers_per_lobe() const { return true; }
    virtual void fill_gains(const float* /*rows*/, std::size_t /*size*/, float* /*to*/) const {}
    /// The step of a sample of weight `weight`; counts it in.
    virtual float step(float weight, Progress& progress) const = 0;
    virtual void update(const kernels::Sequential& s, ColourView radiance, const Steps& steps) const = 0;
    /// Define the weight of the other estimate's lobe in a merge, and the merge of the numbers per lobe.
    [[nodiscard]] virtual float merge_share(std::span<const float> /*state*/, std::span<const float> /*other*/,
                                            std::size_t /*per_lobe*/, float share) const {
        return share;
    }
    virtual void merge_per_lobe(float& mine, float other, float share) const { mine += share * (other - mine); }

  private:
    [[nodiscard]] std::size_t arrays() const { return wants_numbers_per_lobe() ? 4 : 3; }
    static void transpose(const float* rows, std::size_t n, std::size_t lanes, std::size_t size, float* to) {
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < size; ++j) to[j * lanes + i] = rows[i * k_block_size + j];
    }

    Sign sign_;
};

class RunningAverage final : public SequentialEncoder {
  public:
    using SequentialEncoder::SequentialEncoder;

  protected:
    float step(float weight, Progress& progress) const override {
        progress.weight += weight;
        progress.count += 1;
        return weight;
    }
    void update(const kernels::Sequential& s, ColourView radiance, const Steps& steps) const override {
        kernels::running_average(s, radiance, steps.of);
    }
    [[nodiscard]] float merge_share(std::span<const float> state, std::span<const float> other, std::size_t per_lobe,
                                    float) const override {
        const float sum = state[per_lobe] + other[per_lobe];
        return sum > 0 ? other[per_lobe] / sum : 0;
    }
    void merge_per_lobe(float& mine, float other, float) const override { mine += other; }
};

class Progressive final : public SequentialEncoder {
  public:
    Progressive(std::shared_ptr<const LinearBasis> basis_of, Sign sign, const ProgressiveOptions& options)
        : SequentialEncoder(basis_of, sign), options_(options) {
        const Matrix gram = basis().gram();
        const std::size_t n = basis().size();
        if (!options_.seed.empty()) check_equal("coefficients to start from", options_.seed.size(), n);
        for (std::size_t i = 0; i < n; ++i)
            mean_square_.push_back(static_cast<float>(gram[i * n + i] / solid_angle(basis().domain())));
    }

  protected:
    void start(const kernels::Sequential& s) const override {
        for (std::size_t i = 0; i < options_.seed.size(); ++i) {
            s.b[0][i] = options_.seed[i].r;
            s.b[1][i] = options_.seed[i].g;
            s.b[2][i] = options_.seed[i].b;
        }
        if (options_.denominator != ProgressiveOptions::Denominator::sampled || options_.acceleration) return;
        for (std::size_t i = 0; i < basis().size(); ++i)
            s.per_lobe[i] = options_.first_mean_square.value_or(mean_square_[i]);
    }
    void fill_floor(float* floor) const override {
        if (options_.denominator != ProgressiveOptions::Denominator::sampled)
            std::copy(mean_square_.begin(), mean_square_.end(), floor);
    }
    float step(float weight, Progress& progress) const override {
        progress.count += 1;
        const double ramp = options_.ramp ? -std::expm1(-progress.count / *options_.ramp) : 1;
        const double ramped = weight * ramp;
        progress.weight += ramped;
        return progress.weight > 0 ? static_cast<float>(ramped / progress.weight) : 0;
    }
    void update(const kernels::Sequential& s, ColourView radiance, const Steps& steps) const override {
        if (options_.acceleration) return accelerated(s, radiance, steps.of);
        // The running mean of B_i^2 goes with the samples, except that its first entry may be given.
        float mean_steps[k_block_size] = {};
        if (options_.denominator != ProgressiveOptions::Denominator::exact)
            std::copy_n(steps.of, radiance.size, mean_steps);
        if (options_.denominator == ProgressiveOptions::Denominator::sampled && steps.first == 0) mean_steps[0] = 0;
        kernels::progressive(s, radiance, steps.of, mean_steps);
    }

  private:
    /// The later variant: lobe after lobe, each seeing what those before it have mended.
    void accelerated(const kernels::Sequential& s, ColourView radiance, const float* steps) const {
        for (std::size_t j = 0; j < radiance.size; ++j) {
            Rgb delta = error(s, radiance, j);
            const float* w = s.values + j * s.lanes;
            const float a = steps[j];
            for (std::size_t i = 0; i < basis().size(); ++i) {
                s.per_lobe[i] += (w[i] * w[i] - s.per_lobe[i]) * a;
                const float gain =
                    static_cast<float>(*options_.acceleration) * a * w[i] / (a + (1 - a) * s.per_lobe[i]);
                const Rgb change = move(
                    s, i, [&](float, float d) { return gain * d; }, delta);
                delta = delta - change * w[i];
            }
        }
    }

    [[nodiscard]] Rgb error(const kernels::Sequential& s, ColourView radiance, std::size_t j) const {
        Rgb delta = colour_at(radiance, j);
        for (std::size_t i = 0; i < basis().size(); ++i)
            delta = delta - Rgb{s.b[0][i], s.b[1][i], s.b[2][i]} * s.values[j * s.lanes + i];
        return delta;
    }

    /// Adds `change(b, delta)` to each channel of lobe i, clamps, and returns by how much it moved.
    template <class Change>
    static Rgb move(const kernels::Sequential& s, std::size_t i, const Change& change, Rgb delta) {
        const float deltas[3] = {delta.r, delta.g, delta.b};
        float moved[3];
        for (std::size_t k = 0; k < 3; ++k) {
            float& b = s.b[k][i];
            const float to = std::max(b + change(b, deltas[k]), s.lowest);
            moved[k] = to - b;
            b = to;
        }
        return {moved[0], moved[1], moved[2]};
    }

    ProgressiveOptions options_;
    std::vector<float> mean_square_;  ///< exact mean of B_i^2 over the domain
};

class MatrixGain final : public SequentialEncoder {
  public:
    explicit MatrixGain(std::shared_ptr<const LinearBasis> basis_of) : SequentialEncoder(basis_of, Sign::any) {
        const auto n = static_cast<Eigen::Index>(basis().size());
        const Matrix gram = basis().gram();
        Eigen::MatrixXd mean = Eigen::Map<const Eigen::MatrixXd>(gram.data(), n, n) / solid_angle(basis().domain());
        // A ridge, relative to each function, for sets of lobes that are nearly dependent.
        mean.diagonal() *= 1 + 1e-6;
        const Eigen::MatrixXd inverse = mean.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
        inverse_.assign(inverse.data(), inverse.data() + inverse.size());
    }

  protected:
    [[nodiscard]] bool wants_gains() const override { return true; }
    [[nodiscard]] bool wants_numbers_per_lobe() const override { return false; }
    void fill_gains(const float* rows, std::size_t size, float* to) const override {
        kernels::transform_rows(rows, basis().size(), inverse_.data(), size, to);
    }
    float step(float weight, Progress& progress) const override {
        // omega / (W (1 + n / N)): 1 / (N + n) where all weights are equal.
        progress.weight += weight;
        progress.count += 1;
        const double damping = 1 + static_cast<double>(basis().size()) / progress.count;
        return progress.weight > 0 ? static_cast<float>(weight / (progress.weight * damping)) : 0;
    }
    void update(const kernels::Sequential& s, ColourView radiance, const Steps& steps) const override {
        kernels::matrix_gain(s, radiance, steps.of);
    }

  private:
    std::vector<float> inverse_;  ///< of the Gram matrix per unit of the domain
};

}  // namespace

std::shared_ptr<const Encoder> make_running_average(std::shared_ptr<const LinearBasis> basis, Sign sign) {
    return std::make_shared<RunningAverage>(std::move(basis), sign);
}

std::shared_ptr<const Encoder> make_progressive(std::shared_ptr<const LinearBasis> basis, Sign sign,
                                                const ProgressiveOptions& options) {
    return std::make_shared<Progressive>(std::move(basis), sign, options);
}

std::shared_ptr<const Encoder> make_matrix_gain(std::shared_ptr<const LinearBasis> basis) {
    return std::make_shared<MatrixGain>(std::move(basis));
}

}  // namespace lobelia
