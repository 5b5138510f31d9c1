// The machine's own limits: the speed of the operations that kernels consist of.
#pragma once

#include <cstddef>

namespace lobelia::bench {

/// y_i = exp(x_i) by Highway's vector exp, the one that the kernels use.
void exp_all(const float* x, float* y, std::size_t count);

/// Computes `count` fused multiply-adds of floats in independent chains; returns their sum, so that the compiler
/// removes none.
float fma_chain(std::size_t count);

/// The vector width in use, such as "AVX3".
const char* target_name();

}  // namespace lobelia::bench
