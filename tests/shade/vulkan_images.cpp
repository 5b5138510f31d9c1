#include "vulkan_images.h"

#include <cstring>

#include "vulkan_calls.h"

namespace lobelia::test {
namespace {

/// A buffer that the device copies from, filled.
class Staging {
  public:
    explicit Staging(const VulkanDevice& device) : device_(device) {}
    ~Staging() {
        vkDestroyBuffer(device_.device, buffer_, nullptr);
        vkFreeMemory(device_.device, memory_, nullptr);
    }
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    Status fill(std::span<const std::byte> bytes) {
        auto create = structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        create.size = bytes.size();
        create.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        RETURN_IF_FAILED(vkCreateBuffer(device_.device, &create, nullptr, &buffer_));
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device_.device, buffer_, &needs);
        auto memory = allocated(device_.physical, device_.device, needs,
                                VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        if (!memory) return memory.error();
        memory_ = *memory;
        RETURN_IF_FAILED(vkBindBufferMemory(device_.device, buffer_, memory_, 0));
        void* data = nullptr;
        RETURN_IF_FAILED(vkMapMemory(device_.device, memory_, 0, VK_WHOLE_SIZE, 0, &data));
        std::memcpy(data, bytes.data(), bytes.size());
        vkUnmapMemory(device_.device, memory_);
        return Done{};
    }
    [[nodiscard]] VkBuffer buffer() const { return buffer_; }

  private:
    const VulkanDevice& device_;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

constexpr VkImageSubresourceRange k_whole = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    auto barrier = structure<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = k_whole;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace

bool filters(VkPhysicalDevice physical, VkFormat format) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
    constexpr auto k_wanted = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                              VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    return (properties.optimalTilingFeatures & k_wanted) == k_wanted;
}

VulkanImages::~VulkanImages() {
    for (const Image& image : images_) {
        vkDestroyImageView(device_.device, image.view, nullptr);
        vkDestroyImage(device_.device, image.image, nullptr);
        vkFreeMemory(device_.device, image.memory, nullptr);
    }
    vkDestroySampler(device_.device, sampler_, nullptr);
}

Status VulkanImages::add(const ComputeTexture& texture) {
    if (!filters(device_.physical, static_cast<VkFormat>(texture.vk_format)))
        return Error{fmt::format("the driver does not filter VkFormat {}", texture.vk_format)};
    if (sampler_ == VK_NULL_HANDLE) {
        auto create = structure<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        create.magFilter = create.minFilter = VK_FILTER_LINEAR;
        create.addressModeU = create.addressModeV = create.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        RETURN_IF_FAILED(vkCreateSampler(device_.device, &create, nullptr, &sampler_));
    }
    Image& image = images_.emplace_back();
    if (Status status = make(image, texture); !status) return status;
    if (Status status = upload(image, texture); !status) return status;
    descriptors_.push_back({sampler_, image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    return Done{};
}

Status VulkanImages::make(Image& image, const ComputeTexture& texture) {
    auto create = structure<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = static_cast<VkFormat>(texture.vk_format);
    create.extent = {texture.width, texture.height, 1};
    create.mipLevels = create.arrayLayers = 1;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    RETURN_IF_FAILED(vkCreateImage(device_.device, &create, nullptr, &image.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_.device, image.image, &needs);
    auto memory = allocated(device_.physical, device_.device, needs, 0);
    if (!memory) return memory.error();
    image.memory = *memory;
    RETURN_IF_FAILED(vkBindImageMemory(device_.device, image.image, image.memory, 0));
    auto view = structure<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = create.format;
    view.subresourceRange = k_whole;
    RETURN_IF_FAILED(vkCreateImageView(device_.device, &view, nullptr, &image.view));
    return Done{};
}

Status VulkanImages::upload(const Image& image, const ComputeTexture& texture) {
    Staging staging(device_);
    if (Status status = staging.fill(texture.data); !status) return status;
    auto begin = structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    RETURN_IF_FAILED(vkBeginCommandBuffer(device_.commands, &begin));
    change_layout(device_.commands, image.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {texture.width, texture.height, 1};
    vkCmdCopyBufferToImage(device_.commands, staging.buffer(), image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    change_layout(device_.commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    RETURN_IF_FAILED(vkEndCommandBuffer(device_.commands));
    auto submission = structure<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &device_.commands;
    RETURN_IF_FAILED(vkQueueSubmit(device_.queue, 1, &submission, VK_NULL_HANDLE));
    RETURN_IF_FAILED(vkQueueWaitIdle(device_.queue));
    return Done{};
}

}  // namespace lobelia::test
