// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>
#include <string_view>
#include <vector>

namespace voxtact::app {

/// What is to be said of a transfer function under which nothing of a volume is opaque, or under which what its points
/// make opaque is lost between two entries of its table: both are true answers to what was hardly meant. `data`: the
/// values of the volume; `source`: its name; `who`: what the points were given by. None of a function that
/// sampleTable() refuses.
[[nodiscard]] std::vector<std::string> opacityNotes(const TransferFunctionDesc& function, const ValueRange& data,
                                                    double threshold, const std::string& source,
                                                    std::string_view who = "the transfer function");

/// What is to be said of a preset in Hounsfield units and values that are others; empty: nothing.
[[nodiscard]] std::string presetNote(const std::string& preset, const ValueRange& data);

/// Says what opacityNotes() has on standard error, and each note once, however many volumes it is true of. One thread
/// at a time.
void printOpacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                       const std::string& source, std::string_view who = "the transfer function");

} // namespace voxtact::app
