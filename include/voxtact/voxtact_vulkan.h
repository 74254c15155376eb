/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_H
#define VOXTACT_VOXTACT_VULKAN_H

#include "voxtact/voxtact_vulkan_context.h"
#include "voxtact/voxtact_vulkan_detect.h"
#include "voxtact/voxtact_vulkan_scene.h"

/// @file
/// voxtact on a Vulkan device, in C. The conventions of voxtact.h apply. context.h, scene.h and detector.h document the
/// required and resulting states of each `..._cmd_...()` function, and the bound state it loses. Vulkan handles are the
/// caller's: no function frees, writes or transitions them. Objects keep the parts of the context that they need, so
/// they can be destroyed in any order, before the device. The parts have headers of their own.

#endif
