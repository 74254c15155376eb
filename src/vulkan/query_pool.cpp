// SPDX-License-Identifier: MIT
#include "vulkan/query_pool.h"

#include "vulkan/debug.h"

namespace voxtact {

Result<Owned<VkQueryPool>> makeQueryPool(ContextImpl& context, VkQueryType type, std::uint32_t count,
                                         const char* name) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = type;
    info.queryCount = count;
    VkQueryPool handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateQueryPool(context.device, &info, context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a query pool");
    }
    nameObject(context, VK_OBJECT_TYPE_QUERY_POOL, handle, name);
    return Owned<VkQueryPool>(
        context, handle, [](ContextImpl& c, VkQueryPool pool) { c.vk.DestroyQueryPool(c.device, pool, c.allocator); });
}

} // namespace voxtact
