// Sampled images for the compute shaders of vulkan_compute.cpp.
#pragma once

#include <vulkan/vulkan.h>

#include <span>
#include <vector>

#include "lobelia/result.h"
#include "vulkan_compute.h"

namespace lobelia::test {

/// What images need of their device.
struct VulkanDevice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;  ///< not being recorded
};

/// Returns whether the device samples the format with linear filters.
[[nodiscard]] bool filters(VkPhysicalDevice physical, VkFormat format);

/// Textures on the device, each with a sampler: linear, clamped to the edge.
class VulkanImages {
  public:
    explicit VulkanImages(const VulkanDevice& device) : device_(device) {}
    ~VulkanImages();
    VulkanImages(const VulkanImages&) = delete;
    VulkanImages& operator=(const VulkanImages&) = delete;

    /// Uploads the bytes and waits. Errors: a format that the device does not filter; a call that fails.
    [[nodiscard]] Status add(const ComputeTexture& texture);
    [[nodiscard]] const std::vector<VkDescriptorImageInfo>& descriptors() const { return descriptors_; }

  private:
    struct Image {
        VkImage image = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
    };
    [[nodiscard]] Status make(Image& image, const ComputeTexture& texture);
    [[nodiscard]] Status upload(const Image& image, const ComputeTexture& texture);

    VulkanDevice device_;
    std::vector<Image> images_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorImageInfo> descriptors_;
};

}  // namespace lobelia::test
