// The encoder of a fitted basis: another one's verbs, and a fit at the end.
#include "lobelia/encoder.h"

namespace lobelia {
namespace {

class FittedEncoder final : public Encoder {
  public:
    FittedEncoder(std::shared_ptr<const FittedBasis> basis_of, std::shared_ptr<const Encoder> accumulating)
        : Encoder(basis_of), fitted_(*basis_of), accumulating_(std::move(accumulating)) {
        check_equal("functions that are accumulated", accumulating_->basis().size(), fitted_.accumulated()->size());
    }

    [[nodiscard]] std::size_t state_size() const override { return accumulating_->state_size(); }
    [[nodiscard]] Merging merging() const override { return accumulating_->merging(); }
    void add(std::span<float> state, SampleView samples) const override { accumulating_->add(state, samples); }
    void add_sources(std::span<float> state, SampleView sources) const override {
        accumulating_->add_sources(state, sources);
    }
    [[nodiscard]] const Encoder& accumulating() const override { return *accumulating_; }
    void merge(std::span<float> state, std::span<const float> other) const override {
        accumulating_->merge(state, other);
    }
    void solve(std::span<const float> state, std::span<Rgb> c) const override {
        check_equal("coefficients", c.size(), fitted_.size());
        std::vector<Rgb> accumulated(accumulating_->basis().size());
        accumulating_->solve(state, accumulated);
        fitted_.fit(accumulated, c);
    }

  private:
    const FittedBasis& fitted_;
    std::shared_ptr<const Encoder> accumulating_;
};

}  // namespace

std::shared_ptr<const Encoder> make_fitted_encoder(std::shared_ptr<const FittedBasis> basis,
                                                   std::shared_ptr<const Encoder> accumulating) {
    return std::make_shared<FittedEncoder>(std::move(basis), std::move(accumulating));
}

}  // namespace lobelia
