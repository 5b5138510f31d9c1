// Working memory by thread: one buffer for each depth of nesting.
#include "core/math/scratch.h"

#include <array>
#include <memory>

#include "lobelia/contract.h"

namespace lobelia {
namespace {

struct Buffer {
    std::unique_ptr<float[]> floats;
    std::size_t size = 0;
};

/// Buffers above this are not kept, so that a thread does not hold on to the memory of one large basis [floats].
constexpr std::size_t k_kept = 1 << 18;

/// Evaluation nests three deep at most: an encoder or a loop over blocks, a function set, the set that it is made of.
struct Stack {
    std::array<Buffer, 8> buffers;
    std::size_t depth = 0;
};
thread_local Stack stack;

}  // namespace

Scratch::Scratch(std::size_t size) {
    check_range("depth of nested working memory", stack.depth, 0, stack.buffers.size() - 1);
    Buffer& buffer = stack.buffers[stack.depth++];
    if (buffer.size < size || !buffer.floats) buffer = {std::make_unique_for_overwrite<float[]>(size), size};
    data_ = buffer.floats.get();
}

Scratch::~Scratch() {
    Buffer& buffer = stack.buffers[--stack.depth];
    if (buffer.size > k_kept) buffer = {};
}

}  // namespace lobelia
