/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_H
#define VOXTACT_VOXTACT_H

#include "voxtact/voxtact_base.h"
#include "voxtact/voxtact_data.h"
#include "voxtact/voxtact_engine.h"
#include "voxtact/voxtact_files.h"

/// @file
/// voxtact in C: data, the host engine, files and builtins. Nothing here needs Vulkan; what runs on a Vulkan device is
/// in voxtact_vulkan.h. The words are those of the C++ headers, whose comments say more: vxt_host_volume is
/// voxtact::cpu::Volume, and vxt_volume_view is voxtact::VolumeView.
///
/// Structs that begin with `struct_size` can grow. Fill one with zeros, set `struct_size` to its `sizeof`, and set what
/// you need: `vxt_distance question = {.struct_size = sizeof question, .tolerance = 0.1};`. A library that
/// knows more members takes the defaults of those that are missing; one that knows fewer refuses members that are not
/// zero. In an array of them all have the same `struct_size`. A struct without `struct_size` never changes.
///
/// Functions that can fail return a vxt_result, and vxt_last_error() has the reason. One that makes an object sets the
/// pointer to null where it fails. Every `..._destroy()` accepts null. Nothing is thrown, printed or aborted. Pointers
/// in arguments are read during the call only, unless their comment says otherwise. A truth value is 0 or not 0. Text
/// is UTF-8 and ends with a 0.
///
/// Matrices are 16 doubles, column by column: the element in row r and column c is at [4 * c + r]. `b_from_a` takes
/// points of space a to space b.
///
/// Thread-safety: functions that take an object as const are safe from any thread; all others need the caller's lock
/// for the objects that they take as not const.

#endif
