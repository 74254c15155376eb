// SPDX-License-Identifier: MIT
#include "app/options/opacity_notes.h"

#include "app/output/standard_streams.h"
#include "core/base/text.h"
#include "voxtact/looks.h"

namespace voxtact::app {

namespace {

std::string rangeText(const ValueRange& range) {
    return number(range.lo) + (range.lo < range.hi ? " to " + number(range.hi) : "");
}

} // namespace

std::vector<std::string> opacityNotes(const TransferFunctionDesc& function, const ValueRange& data, double threshold,
                                      const std::string& source, std::string_view who) {
    const Result<OpacityFacts> facts = checkOpacity(function, data, threshold);
    if (!facts.ok()) {
        return {};
    }
    if (!facts->reaches) {
        return {"no opacity of " + std::string(who) + " reaches the threshold " + number(threshold) +
                ": nothing touches"};
    }
    std::vector<std::string> notes;
    for (const ValueRange& lost : facts->lost) {
        notes.push_back(source + ": the entries of the table, " + number(facts->spacing) + " apart, pass over what " +
                        std::string(who) + " makes opaque at " + rangeText(lost) +
                        ": nothing touches it; --tf-size and --tf-domain bring them nearer to each other");
    }
    if (notes.empty() && !facts->any) {
        notes.push_back(source + ": none of its values, " + rangeText(data) + ", is opaque under " + std::string(who) +
                        ": nothing touches");
    }
    return notes;
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
                       const std::string& source, std::string_view who) {
    for (const std::string& note : opacityNotes(function, data, threshold, source, who)) {
        printNoteOnce(note);
    }
}

} // namespace voxtact::app
