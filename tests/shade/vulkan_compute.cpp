#include "vulkan_compute.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "vulkan_calls.h"
#include "vulkan_images.h"

namespace lobelia::test {
namespace {

/// A buffer that both sides see, mapped during its lifetime.
class Buffer {
  public:
    Buffer(VkPhysicalDevice physical, VkDevice device) : physical_(physical), device_(device) {}
    ~Buffer() {
        vkDestroyBuffer(device_, buffer_, nullptr);
        vkFreeMemory(device_, memory_, nullptr);
    }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    Status make(std::size_t floats) {
        auto create = structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        create.size = std::max<std::size_t>(floats, 1) * sizeof(float);
        create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        RETURN_IF_FAILED(vkCreateBuffer(device_, &create, nullptr, &buffer_));
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device_, buffer_, &needs);
        auto memory = allocated(physical_, device_, needs,
                                VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        if (!memory) return memory.error();
        memory_ = *memory;
        RETURN_IF_FAILED(vkBindBufferMemory(device_, buffer_, memory_, 0));
        void* data = nullptr;
        RETURN_IF_FAILED(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &data));
        floats_ = {static_cast<float*>(data), floats};
        return Done{};
    }
    [[nodiscard]] std::span<float> floats() const { return floats_; }
    [[nodiscard]] VkDescriptorBufferInfo whole() const { return {buffer_, 0, VK_WHOLE_SIZE}; }

  private:
    VkPhysicalDevice physical_;
    VkDevice device_;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::span<float> floats_;
};

/// The module and the pipeline of one job.
struct Pipeline {
    VkDevice device = VK_NULL_HANDLE;
    VkShaderModule module = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    ~Pipeline() {
        vkDestroyPipeline(device, pipeline, nullptr);
        vkDestroyShaderModule(device, module, nullptr);
    }

    Status make(const ComputeJob& job, VkPipelineLayout layout) {
        auto code = structure<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        code.codeSize = job.spirv.size_bytes();
        code.pCode = job.spirv.data();
        RETURN_IF_FAILED(vkCreateShaderModule(device, &code, nullptr, &module));
        const std::array<VkSpecializationMapEntry, 2> entries = {{{0, 0, 4}, {1, 4, 4}}};
        const VkSpecializationInfo constants{2, entries.data(), 8, job.constants.data()};
        auto create = structure<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
        create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        create.stage.module = module;
        create.stage.pName = "main";
        create.stage.pSpecializationInfo = &constants;
        create.layout = layout;
        RETURN_IF_FAILED(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline));
        return Done{};
    }
};

class Compute final : public VulkanCompute {
  public:
    ~Compute() override {
        if (device_ != VK_NULL_HANDLE) {
            vkDestroyDescriptorPool(device_, descriptors_, nullptr);
            vkDestroyCommandPool(device_, commands_, nullptr);
            vkDestroyPipelineLayout(device_, layout_, nullptr);
            vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
            vkDestroyDevice(device_, nullptr);
        }
        if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
    }

    Status make() {
        auto about = structure<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
        about.apiVersion = VK_API_VERSION_1_1;
        auto create = structure<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
        create.pApplicationInfo = &about;
        RETURN_IF_FAILED(vkCreateInstance(&create, nullptr, &instance_));
        if (const Status status = choose_device(); !status) return status;
        if (const Status status = make_device(); !status) return status;
        return make_layouts();
    }

    [[nodiscard]] std::string device() const override { return properties_.deviceName; }

    [[nodiscard]] Result<std::vector<float>> run(const ComputeJob& job) override {
        Buffer first(physical_, device_), second(physical_, device_), results(physical_, device_);
        const std::array<std::pair<Buffer*, std::size_t>, 3> buffers = {
            {{&first, job.first.size()}, {&second, job.second.size()}, {&results, job.results}}};
        for (const auto& [buffer, floats] : buffers)
            if (const Status status = buffer->make(floats); !status) return status.error();
        std::copy(job.first.begin(), job.first.end(), first.floats().begin());
        std::copy(job.second.begin(), job.second.end(), second.floats().begin());
        std::fill(results.floats().begin(), results.floats().end(), std::numeric_limits<float>::quiet_NaN());

        Pipeline pipeline{device_};
        if (const Status status = pipeline.make(job, layout_); !status) return status.error();
        VulkanImages images({physical_, device_, queue_, command_});
        // Drivers look at the whole set, also at samplers that the shader does not use.
        constexpr std::byte k_black{0};
        const ComputeTexture none{VK_FORMAT_R8_UNORM, 1, 1, {&k_black, 1}};
        for (const ComputeTexture& texture : job.textures.empty() ? std::span(&none, 1) : job.textures)
            if (const Status status = images.add(texture); !status) return status.error();
        bind({first.whole(), second.whole(), results.whole()}, images.descriptors());
        if (const Status status = submit(pipeline.pipeline, job.groups); !status) return status.error();
        return std::vector<float>(results.floats().begin(), results.floats().end());
    }

  private:
    Status choose_device() {
        std::uint32_t count = 0;
        RETURN_IF_FAILED(vkEnumeratePhysicalDevices(instance_, &count, nullptr));
        std::vector<VkPhysicalDevice> devices(count);
        if (count > 0) RETURN_IF_FAILED(vkEnumeratePhysicalDevices(instance_, &count, devices.data()));
        if (devices.empty()) return Error{"no Vulkan driver: install mesa-vulkan-drivers"};
        const bool gpu = std::getenv("LOBELIA_TEST_GPU") != nullptr;
        const auto preferred = [&](VkPhysicalDevice device) {
            VkPhysicalDeviceProperties properties;
            vkGetPhysicalDeviceProperties(device, &properties);
            return (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) != gpu;
        };
        std::stable_partition(devices.begin(), devices.end(), preferred);
        physical_ = devices.front();
        vkGetPhysicalDeviceProperties(physical_, &properties_);
        return Done{};
    }

    Status make_device() {
        std::uint32_t count = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
        std::vector<VkQueueFamilyProperties> families(count);
        vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
        const auto found = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& family) {
            return (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
        });
        if (found == families.end()) return Error{device() + " has no compute queue"};
        const float priority = 1;
        auto queue = structure<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
        queue.queueFamilyIndex = static_cast<std::uint32_t>(found - families.begin());
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        auto create = structure<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
        create.queueCreateInfoCount = 1;
        create.pQueueCreateInfos = &queue;
        RETURN_IF_FAILED(vkCreateDevice(physical_, &create, nullptr, &device_));
        vkGetDeviceQueue(device_, queue.queueFamilyIndex, 0, &queue_);
        auto pool = structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        pool.queueFamilyIndex = queue.queueFamilyIndex;
        RETURN_IF_FAILED(vkCreateCommandPool(device_, &pool, nullptr, &commands_));
        auto allocate = structure<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocate.commandPool = commands_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        RETURN_IF_FAILED(vkAllocateCommandBuffers(device_, &allocate, &command_));
        return Done{};
    }

    Status make_layouts() {
        std::array<VkDescriptorSetLayoutBinding, 4> bindings{};
        for (std::uint32_t i = 0; i < 3; ++i)
            bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
        auto set = structure<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
        bindings[3] = {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, k_most_textures, VK_SHADER_STAGE_COMPUTE_BIT,
                       nullptr};
        set.bindingCount = 4;
        set.pBindings = bindings.data();
        RETURN_IF_FAILED(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout_));
        auto layout = structure<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &set_layout_;
        RETURN_IF_FAILED(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_));

        const std::array<VkDescriptorPoolSize, 2> sizes = {
            {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, k_most_textures}}};
        auto pool = structure<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        pool.maxSets = 1;
        pool.poolSizeCount = sizes.size();
        pool.pPoolSizes = sizes.data();
        RETURN_IF_FAILED(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptors_));
        auto allocate = structure<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        allocate.descriptorPool = descriptors_;
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &set_layout_;
        RETURN_IF_FAILED(vkAllocateDescriptorSets(device_, &allocate, &descriptor_));
        return Done{};
    }

    /// The last of the images stands for the rest of the array, too.
    void bind(const std::array<VkDescriptorBufferInfo, 3>& buffers, std::vector<VkDescriptorImageInfo> images) {
        auto write = structure<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = descriptor_;
        write.descriptorCount = 3;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = buffers.data();
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
        images.resize(k_most_textures, images.back());
        write.dstBinding = 3;
        write.descriptorCount = k_most_textures;
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pBufferInfo = nullptr;
        write.pImageInfo = images.data();
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }

    Status submit(VkPipeline pipeline, std::array<std::uint32_t, 2> groups) {
        auto begin = structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        RETURN_IF_FAILED(vkBeginCommandBuffer(command_, &begin));
        vkCmdBindPipeline(command_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        vkCmdBindDescriptorSets(command_, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &descriptor_, 0, nullptr);
        vkCmdDispatch(command_, groups[0], groups[1], 1);
        // Make the results visible to the host.
        auto barrier = structure<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
        barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(command_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier,
                             0, nullptr, 0, nullptr);
        RETURN_IF_FAILED(vkEndCommandBuffer(command_));
        auto submission = structure<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        submission.commandBufferCount = 1;
        submission.pCommandBuffers = &command_;
        RETURN_IF_FAILED(vkQueueSubmit(queue_, 1, &submission, VK_NULL_HANDLE));
        RETURN_IF_FAILED(vkQueueWaitIdle(queue_));
        return Done{};
    }

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool commands_ = VK_NULL_HANDLE;
    VkCommandBuffer command_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkDescriptorSet descriptor_ = VK_NULL_HANDLE;
};

}  // namespace

Result<std::unique_ptr<VulkanCompute>> VulkanCompute::open() {
    auto compute = std::make_unique<Compute>();
    if (const Status status = compute->make(); !status) return status.error();
    return std::unique_ptr<VulkanCompute>(std::move(compute));
}

}  // namespace lobelia::test
