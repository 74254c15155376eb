// SPDX-License-Identifier: MIT
#include "cli/options/opacity_notes.h"

#include "cli/output/standard_streams.h"
#include "core/base/text.h"
#include "voxtact/looks.h"

#include <cmath>

namespace voxtact::app {

namespace {

std::string rangeText(const ValueRange& range) {
    return number(range.lo) + (range.lo < range.hi ? " to " + number(range.hi) : "");
}

} // namespace

std::vector<std::string> opacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                                      const std::string& source, bool byTable, std::string_view who) {
    const Result<OpacityFacts> facts = checkOpacity(function, data, threshold);
    if (!facts.ok()) {
        return {};
    }
    if (!facts->reaches) {
        return {"no opacity of " + std::string(who) + " reaches the threshold " + number(threshold) +
                ": nothing touches"};
    }
    if (!facts->any) {
        return {source + ": none of its values, " + rangeText(data) + ", is opaque under " + std::string(who) +
                ": nothing touches"};
    }
    constexpr double kNoted = 0.01; // of the data's range
    if (byTable && facts->moved > kNoted * (data.hi - data.lo)) {
        return {source + ": the table of the transfer function " +
                (std::isinf(facts->moved) ? "passes over opaque values"
                                          : "moves an end of the opaque values by " + number(facts->moved)) +
                "; only certified answers are exact; --tf-size and --tf-domain make the table finer"};
    }
    return {};
}

std::string presetNote(const std::string& preset, const ValueRange& data) {
    constexpr double kLeast = -200; // air is at -1000: where nothing is below this the numbers are others
    const LookPreset* const known = findLookPreset(preset);
    if (known == nullptr || !known->hounsfield || data.lo <= kLeast) {
        return {};
    }
    return "--preset " + preset + " is in Hounsfield units, in which air is -1000; the volume's values, " +
           number(data.lo) + " to " + number(data.hi) +
           ", are others: --opacity and --transfer-function say what is seen";
}

void printOpacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                       const std::string& source, bool byTable) {
    for (const std::string& note : opacityNotes(function, data, threshold, source, byTable)) {
        printNoteOnce(note);
    }
}

} // namespace voxtact::app
