// Compute shaders on a Vulkan driver, without a window: runs shader code in tests.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lobelia/result.h"

namespace lobelia::test {

/// A 2D texture as its bytes.
struct ComputeTexture {
    std::uint32_t vk_format = 0;
    std::uint32_t width = 0, height = 0;
    std::span<const std::byte> data;
};
/// The most textures of a shader.
inline constexpr std::size_t k_most_textures = 16;

/// A shader with three storage buffers of floats in set 0 (bindings 0 and 1: input, 2: results), two constants to
/// specialise, and textures (binding 3: an array of k_most_textures samplers), which are filtered and clamped.
struct ComputeJob {
    std::span<const std::uint32_t> spirv;
    std::array<std::int32_t, 2> constants = {0, 0};
    std::span<const float> first, second;
    std::size_t results = 0;
    std::array<std::uint32_t, 2> groups = {1, 1};
    std::span<const ComputeTexture> textures;
};

class VulkanCompute {
  public:
    /// Opens a software driver, or any GPU if there is none; with LOBELIA_TEST_GPU set, a GPU first. Errors: no Vulkan
    /// at compile time, or no driver.
    [[nodiscard]] static Result<std::unique_ptr<VulkanCompute>> open();
    virtual ~VulkanCompute() = default;

    [[nodiscard]] virtual std::string device() const = 0;
    /// Returns the results; those that the shader does not write are NaN. Errors: a call of Vulkan that fails.
    [[nodiscard]] virtual Result<std::vector<float>> run(const ComputeJob& job) = 0;
};

}  // namespace lobelia::test
