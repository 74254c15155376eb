/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_H
#define VOXTACT_VOXTACT_VULKAN_H

#include "voxtact/voxtact_vulkan_context.h"
#include "voxtact/voxtact_vulkan_detect.h"
#include "voxtact/voxtact_vulkan_scene.h"

/// @file
/// voxtact on a Vulkan device, in C. What holds for voxtact.h holds here. What each `..._cmd_...()` expects and leaves,
/// and which bound state it loses, stands above its namesake in context.h, scene.h and detector.h. Vulkan handles are
/// the caller's: nothing here frees, writes or transitions them. Objects keep what they need of the context, so the
/// order in which they end does not matter; all of them end before the device. The parts have headers of their own.

#endif
