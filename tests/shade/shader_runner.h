// Runs the functions of shader_cases() in every way that there is on this machine.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shader_cases.h"
#include "vulkan_compute.h"

namespace lobelia::test {

/// Values of a function at all texels.
struct ShaderInput {
    std::size_t texels = 0;
    std::vector<float> values;   ///< coefficients of each texel, or the members of its Texel
    std::size_t directions = 1;  ///< 1 for unpack()
    std::vector<float> xyz;   ///< of each direction; for specular() the k_point_floats of each point, then ggx_table()
    std::size_t results = 3;  ///< at each texel and direction
    [[nodiscard]] std::size_t stride() const { return values.size() / texels; }
};

/// Runs Metal's text compiled as C++. Returns results of texel 0 at each direction, of texel 1, ...
[[nodiscard]] std::vector<float> run_msl_as_cpp(const ShaderCase& shader, const ShaderInput& input);

/// Whether a case runs on Vulkan: drivers take minutes to compile the unpacking of hundreds of coefficients.
[[nodiscard]] bool runs_on_vulkan(const ShaderCase& shader);

/// Runs GLSL or HLSL on Vulkan, some cases of shader_cases() in one shader.
class VulkanRunner {
  public:
    /// Errors: no driver, or no glslangValidator.
    [[nodiscard]] static Result<std::unique_ptr<VulkanRunner>> open(shade::Language language);
    [[nodiscard]] std::string device() const { return compute_->device(); }

    /// Runs a member of shader_cases() that runs_on_vulkan(); results as above. Errors: of the compiler or the driver.
    [[nodiscard]] Result<std::vector<float>> run(const ShaderCase& shader, const ShaderInput& input);
    /// Runs another text in place of the case's own.
    [[nodiscard]] Result<std::vector<float>> run(const ShaderCase& shader, const std::string& text,
                                                 const ShaderInput& input);

  private:
    VulkanRunner(shade::Language language, std::unique_ptr<VulkanCompute> compute)
        : language_(language), compute_(std::move(compute)) {}
    [[nodiscard]] Result<std::vector<float>> dispatch(const ShaderInput& input, std::span<const std::uint32_t> spirv,
                                                      std::size_t chosen);

    shade::Language language_;
    std::unique_ptr<VulkanCompute> compute_;
    std::size_t batch_ = 0;             ///< the batch of cases that is compiled
    std::vector<std::uint32_t> spirv_;  ///< its code; empty: none is compiled
};

/// Returns a text with its outermost names made unique by `suffix`, so that one shader can hold many.
[[nodiscard]] std::string with_own_names(const std::string& text, const std::string& suffix);

}  // namespace lobelia::test
