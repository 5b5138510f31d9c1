// Encoders: accumulators with three functions, add, merge and solve, over a state that is a span of floats.
#pragma once

#include "lobelia/basis.h"

namespace lobelia {

/// exact: merging the states of two halves equals one pass over both, as for sums. approximate: it does not, as for
/// estimates that are corrected sample by sample.
enum class Merging { exact, approximate };

/// Finds the coefficients of a basis from samples as they arrive. An encoder is immutable and shared; the samples
/// accumulate in a state of `state_size()` floats that the caller keeps (one per texel or probe), that threads merge
/// and that checkpoints store. A state of zeros is empty.
class Encoder {
  public:
    explicit Encoder(std::shared_ptr<const Basis> basis) : basis_(std::move(basis)) {}
    virtual ~Encoder() = default;

    [[nodiscard]] const Basis& basis() const { return *basis_; }
    [[nodiscard]] virtual std::size_t state_size() const = 0;
    [[nodiscard]] virtual Merging merging() const = 0;
    /// Returns whether all coefficients are >= 0.
    [[nodiscard]] virtual bool is_non_negative() const { return false; }

    virtual void add(std::span<float> state, SampleView samples) const = 0;
    /// Adds direct light, sampled from light sources in addition to the directions of `add`: radiance times solid angle
    /// is the irradiance across the direction. The solid angles are tiny (at most 2e-3 of the domain's in all), so that
    /// they do not count as coverage of the domain. By default these are added like other samples.
    virtual void add_sources(std::span<float> state, SampleView sources) const { add(state, sources); }
    virtual void merge(std::span<float> state, std::span<const float> other) const = 0;
    /// Returns the encoder of a linear basis that has the same state: this one, or the one that a fitted basis
    /// accumulates with.
    [[nodiscard]] virtual const Encoder& accumulating() const { return *this; }
    /// Solves for the coefficients; all zeros if no sample was added. Precondition: `c` has basis().size() entries.
    virtual void solve(std::span<const float> state, std::span<Rgb> c) const = 0;
    /// Whether states of `other` mean the same as those of this: the same kind of encoder of the same functions.
    [[nodiscard]] bool has_states_of(const Encoder& other) const;

  protected:
    /// Checks that a span is a state of this encoder.
    void check_state(std::span<const float> state, SourcePlace place = SourcePlace::here()) const {
        check_equal("floats of the state", state.size(), state_size(), place);
    }

  private:
    std::shared_ptr<const Basis> basis_;
};

/// An encoder of a linear basis.
class LinearEncoder : public Encoder {
  public:
    explicit LinearEncoder(const std::shared_ptr<const LinearBasis>& basis) : Encoder(basis), linear_(*basis) {}
    [[nodiscard]] const LinearBasis& basis() const { return linear_; }

  private:
    const LinearBasis& linear_;
};

/// Makes an encoder of a fitted basis: `accumulating`, an encoder of its accumulated basis, does all but the last step.
[[nodiscard]] std::shared_ptr<const Encoder> make_fitted_encoder(std::shared_ptr<const FittedBasis> basis,
                                                                 std::shared_ptr<const Encoder> accumulating);

/// An encoder together with its state.
class Accumulator {
  public:
    explicit Accumulator(std::shared_ptr<const Encoder> encoder)
        : encoder_(std::move(encoder)), state_(encoder_->state_size()) {}

    void add(SampleView samples) { encoder_->add(state_, samples); }
    void add_sources(SampleView sources) { encoder_->add_sources(state_, sources); }
    /// Adds what `other` has seen, an accumulator of the same encoder or of one that is equal (has_states_of).
    void merge(const Accumulator& other);
    [[nodiscard]] std::vector<Rgb> solve() const {
        std::vector<Rgb> c(encoder_->basis().size());
        encoder_->solve(state_, c);
        return c;
    }
    [[nodiscard]] std::span<const float> state() const { return state_; }

  private:
    std::shared_ptr<const Encoder> encoder_;
    std::vector<float> state_;
};

}  // namespace lobelia
