// Whether the states of two encoders mean the same, and merging by accumulators, which checks it.
#include "lobelia/encoder.h"

#include <typeinfo>

namespace lobelia {
namespace {

/// Compares functions by their values in a few directions without symmetry: a basis and a rotated one have one name.
bool are_same_functions(const LinearBasis& a, const LinearBasis& b) {
    if (&a == &b) return true;
    if (a.size() != b.size()) return false;
    std::vector<float> values(round_up_to_lanes(a.size())), others(values.size());
    for (const Vec3 direction : {Vec3{0.36f, 0.48f, 0.8f}, Vec3{-0.64f, 0.6f, 0.48f}, Vec3{0.28f, -0.96f, 0}}) {
        a.values_at(direction, values.data());
        b.values_at(direction, others.data());
        if (!std::equal(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(a.size()), others.begin()))
            return false;
    }
    return true;
}

std::string state_text(const Encoder& encoder) {
    return std::to_string(encoder.state_size()) + " floats of " + encoder.basis().name();
}

}  // namespace

bool Encoder::has_states_of(const Encoder& other) const {
    const Encoder &mine = accumulating(), &theirs = other.accumulating();
    if (&mine == &theirs) return true;
    const LinearBasis *a = mine.basis().linear(), *b = theirs.basis().linear();
    return typeid(mine) == typeid(theirs) && mine.state_size() == theirs.state_size() && a != nullptr && b != nullptr &&
           are_same_functions(*a, *b);
}

void Accumulator::merge(const Accumulator& other) {
    if (!encoder_->has_states_of(*other.encoder_)) [[unlikely]]
        contract_violated("accumulator of another encoder: " + state_text(*other.encoder_) + ", must be " +
                          state_text(*encoder_));
    encoder_->merge(state_, other.state_);
}

}  // namespace lobelia
