// The machine's own limits: how fast it can do what the kernels are made of.
#pragma once

#include <cstddef>

namespace lobelia::bench {

/// y_i = exp(x_i) by Highway's vector exp, the one that the kernels use.
void exp_all(const float* x, float* y, std::size_t count);

/// `count` fused multiply-adds of floats in independent chains; returns their sum, so that none is left out.
float fma_chain(std::size_t count);

/// The vector width in use, such as "AVX3".
const char* target_name();

}  // namespace lobelia::bench
