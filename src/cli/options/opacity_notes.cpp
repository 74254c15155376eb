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
                (std::isinf(facts->moved) ? "skips opaque values"
                                          : "moves an end of the opaque values by " + number(facts->moved)) +
                "; only certified answers are exact; refine the table with --tf-size or --tf-domain"};
    }
    return {};
}

std::string presetNote(const std::string& preset, const ValueRange& data) {
    constexpr double kMaxAir = -200; // air is about -1000 HU: without lower values, the unit differs
    const LookPreset* const known = findLookPreset(preset);
    if (known == nullptr || !known->hounsfield || data.lo <= kMaxAir) {
        return {};
    }
    return "--preset " + preset + " expects Hounsfield units, with air at -1000; the values of the volume are " +
           number(data.lo) + " to " + number(data.hi) + "; use --opacity or --transfer-function instead";
}

void printOpacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                       const std::string& source, bool byTable) {
    for (const std::string& note : opacityNotes(function, data, threshold, source, byTable)) {
        printNoteOnce(note);
    }
}

} // namespace voxtact::app
