// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <string>
#include <string_view>
#include <vector>

namespace voxtact::app {

/// Returns a note if a transfer function makes nothing of a volume opaque; with `byTable`, also if its table moves an
/// end of the opaque values by more than a hundredth of the volume's range. `data`: range of the volume's values;
/// `source`: its name; `who`: the option with the points. Returns none if sampleTable() refuses the function.
[[nodiscard]] std::vector<std::string> opacityNotes(const TransferFunctionDesc& function, const ValueRange& data,
                                                    double threshold, const std::string& source, bool byTable,
                                                    std::string_view who = "the transfer function");

/// Returns the note for a preset in Hounsfield units on other values; otherwise empty.
[[nodiscard]] std::string presetNote(const std::string& preset, const ValueRange& data);

/// Prints opacityNotes() on standard error, each note once, also for several volumes. One thread at a time.
void printOpacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                       const std::string& source, bool byTable);

} // namespace voxtact::app
