// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/memory/memory.h"

#include <cstdint>

namespace voxtact {

/// Of `count` queries, under a name for debuggers.
[[nodiscard]] Result<Owned<VkQueryPool>> makeQueryPool(ContextImpl& context, VkQueryType type, std::uint32_t count,
                                                       const char* name);

} // namespace voxtact
