// What an encoder is: an accumulator with three verbs, add, merge and solve, over a state that is a span of floats.
#pragma once

#include "lobelia/basis.h"

namespace lobelia {

/// Whether merging the states of two halves gives what one pass over both would: sums do, learned estimates do not.
enum class Merging { exact, approximate };

/// Finds the coefficients of a basis from samples as they arrive. An encoder is immutable and shared; what it
/// has seen is in a state of `state_size()` floats that the caller keeps (one per texel or probe), that threads merge
/// and that checkpoints store. A state of zeros has seen nothing.
class Encoder {
  public:
    explicit Encoder(std::shared_ptr<const Basis> basis) : basis_(std::move(basis)) {}
    virtual ~Encoder() = default;

    [[nodiscard]] const Basis& basis() const { return *basis_; }
    [[nodiscard]] virtual std::size_t state_size() const = 0;
    [[nodiscard]] virtual Merging merging() const = 0;
    /// Whether all coefficients are >= 0.
    [[nodiscard]] virtual bool is_non_negative() const { return false; }

    virtual void add(std::span<float> state, SampleView samples) const = 0;
    /// Light that was aimed at, beside what `add` saw in all directions: radiance times solid angle is the irradiance
    /// across the direction, and the solid angles are next to nothing (2e-3 of the domain's at most in all), so that
    /// they do not count as directions seen. Encoders for whom every sample is an observation add them as samples.
    virtual void add_sources(std::span<float> state, SampleView sources) const { add(state, sources); }
    virtual void merge(std::span<float> state, std::span<const float> other) const = 0;
    /// The encoder of a linear basis that has the same state: this one, or what a fitted basis accumulates with.
    [[nodiscard]] virtual const Encoder& accumulating() const { return *this; }
    /// Coefficients from what was seen; zeros where that was nothing. `c` has basis().size() entries.
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

/// An encoder of a fitted basis: `accumulating`, an encoder of its accumulated basis, does all but the last step.
[[nodiscard]] std::shared_ptr<const Encoder> make_fitted_encoder(std::shared_ptr<const FittedBasis> basis,
                                                                 std::shared_ptr<const Encoder> accumulating);

/// An encoder with a state of its own.
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
