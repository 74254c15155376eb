// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>
#include <string_view>
#include <vector>

namespace voxtact::app {

/// Returns a note on a transfer function under which nothing of a volume is opaque; with `byTable`, also on one whose
/// table moves an end of the opaque values by more than a hundredth of the volume's range. `data`: the values of the
/// volume; `source`: its name; `who`: the option that gave the points. None for a function that sampleTable() refuses.
[[nodiscard]] std::vector<std::string> opacityNotes(const TransferFunctionDesc& function, const ValueRange& data,
                                                    double threshold, const std::string& source, bool byTable,
                                                    std::string_view who = "the transfer function");

/// Returns the note for a preset in Hounsfield units on other values; otherwise empty.
[[nodiscard]] std::string presetNote(const std::string& preset, const ValueRange& data);

/// Says what opacityNotes() has on standard error, and each note once, however many volumes it is true of. One thread
/// at a time.
void printOpacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                       const std::string& source, bool byTable);

} // namespace voxtact::app
