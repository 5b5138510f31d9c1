// In place of vulkan_compute.cpp where Vulkan was not found.
#include "vulkan_compute.h"

namespace lobelia::test {

Result<std::unique_ptr<VulkanCompute>> VulkanCompute::open() {
    return Error{"built without Vulkan: install libvulkan-dev and configure again"};
}

}  // namespace lobelia::test
