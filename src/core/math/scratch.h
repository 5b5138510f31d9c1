// Working memory for inner functions: floats that a thread keeps from call to call, so that calls allocate nothing.
#pragma once

#include <cstddef>

namespace lobelia {

/// `size` floats of unspecified value, until the end of the scope; a place even for none. Scopes nest: memory is taken
/// and given back in the order of a stack, within one thread.
class Scratch {
  public:
    explicit Scratch(std::size_t size);
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    [[nodiscard]] float* data() const { return data_; }

  private:
    float* data_;
};

}  // namespace lobelia
