// Calls of Vulkan as results.
#pragma once

#include <fmt/format.h>
#include <vulkan/vulkan.h>

#include "lobelia/result.h"

namespace lobelia::test {

inline Status checked(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return Done{};
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return Error{"no Vulkan driver: install mesa-vulkan-drivers"};
    return Error{fmt::format("{} returned {}", call, static_cast<int>(result))};
}

/// Returns a structure of Vulkan with zeros besides its type.
template <class T>
T structure(VkStructureType type) {
    T zeros{};
    zeros.sType = type;
    return zeros;
}

#define RETURN_IF_FAILED(call)                                                                           \
    do {                                                                                                 \
        if (const Status status = ::lobelia::test::checked(call, #call); !status) return status.error(); \
    } while (false)

/// Allocates memory of one of the kinds that `needs` allows, with these properties.
inline Result<VkDeviceMemory> allocated(VkPhysicalDevice physical, VkDevice device, const VkMemoryRequirements& needs,
                                        VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties kinds;
    vkGetPhysicalDeviceMemoryProperties(physical, &kinds);
    auto allocate = structure<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocate.allocationSize = needs.size;
    for (std::uint32_t i = kinds.memoryTypeCount; i-- > 0;)
        if ((needs.memoryTypeBits >> i & 1) != 0 && (kinds.memoryTypes[i].propertyFlags & wanted) == wanted)
            allocate.memoryTypeIndex = i;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    RETURN_IF_FAILED(vkAllocateMemory(device, &allocate, nullptr, &memory));
    return memory;
}

}  // namespace lobelia::test
