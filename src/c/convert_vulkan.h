// SPDX-License-Identifier: MIT
#pragma once

#include "c/convert.h"
#include "c/handles_vulkan.h"

/// Data of voxtact_vulkan.h as the C++ interface takes it.
namespace voxtact::c {

[[nodiscard]] ContextDesc toContextDesc(const vxt_context_desc* desc);
[[nodiscard]] QueueAccess toQueue(const vxt_queue* queue);

} // namespace voxtact::c
