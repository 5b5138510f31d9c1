// A block of directions in another frame.
#pragma once

#include "lobelia/evaluator.h"

namespace lobelia {

class TurnedBlock {
  public:
    /// r times each of at most k_block_size directions.
    TurnedBlock(DirectionView block, const Rotation& r) : size_(block.size) {
        check_range("directions of a block", size_, 0, k_block_size);
        const PlanesView<3, float> to{{axes_[0].data(), axes_[1].data(), axes_[2].data()}, size_};
        for (std::size_t j = 0; j < size_; ++j) set_entry(to, j, rotate(r, direction_at(block, j)));
    }
    [[nodiscard]] DirectionView view() const { return {{axes_[0].data(), axes_[1].data(), axes_[2].data()}, size_}; }

  private:
    std::array<std::array<float, k_block_size>, 3> axes_;
    std::size_t size_;
};

}  // namespace lobelia
