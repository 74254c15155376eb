/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_H
#define VOXTACT_VOXTACT_H

#include "voxtact/voxtact_base.h"
#include "voxtact/voxtact_data.h"
#include "voxtact/voxtact_engine.h"
#include "voxtact/voxtact_files.h"

/// @file
/// C interface: data, the host engine, files and builtins. It needs no Vulkan; voxtact_vulkan.h has the functions for
/// Vulkan devices. The terms are those of the C++ headers, whose comments have more detail: vxt_host_volume is
/// voxtact::cpu::Volume, and vxt_volume_view is voxtact::VolumeView.
///
/// Structs that begin with `struct_size` can grow. Fill one with zeros, set `struct_size` to its `sizeof`, and set the
/// members that you need: `vxt_distance question = {.struct_size = sizeof question, .tolerance = 0.1};`. A newer
/// library uses the defaults of missing members; an older library refuses unknown members that are not zero. All
/// elements of an array have the same `struct_size`. A struct without `struct_size` never changes.
///
/// Functions that can fail return a vxt_result; vxt_last_error() returns the reason. On failure a creating function
/// sets its pointer to null. Every `..._destroy()` accepts null. Nothing throws, prints or aborts. Pointers in
/// arguments are read during the call only, unless their comment says otherwise. A truth value is 0 or not 0. Text is
/// UTF-8 and ends with a 0.
///
/// Matrices are 16 doubles, column-major: the element in row r and column c is at [4 * c + r]. `b_from_a` maps points
/// of space a to space b.
///
/// Thread-safety: functions that take an object as const are safe from any thread. All others need the caller's lock
/// for the objects that they take as not const.

#endif
