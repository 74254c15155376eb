// SPDX-License-Identifier: MIT
#include "cli/options/label_words.h"
#include "cli/output/text_for_messages.h"
#include "core/base/try.h"

#include <algorithm>
#include <charconv>

namespace voxtact::app {

namespace {

std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMax = 8;
    std::string out;
    for (std::size_t i = 0; i < std::min(names.size(), kMax); ++i) {
        out += (i > 0 ? ", " : "") + names[i];
    }
    return names.size() > kMax ? out + ", ..." : out;
}

/// Returns the labels of voxels, ascending. The list of labels may have a 0 that no voxel has.
std::vector<std::int32_t> presentLabels(const LabelData& labels) {
    std::vector<bool> seen(labels.values.size());
    for (const std::uint16_t index : labels.indices) {
        seen[index] = true;
    }
    std::vector<std::int32_t> present;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i]) {
            present.push_back(labels.values[i]);
        }
    }
    return present;
}

} // namespace

std::optional<std::int32_t> labelNumber(const LabelWord& word) {
    std::int32_t number = 0;
    const char* const end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(word.data(), end, number);
    return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

Result<std::vector<std::int32_t>> labelsOf(const NamedLabels& labels, const LabelWord& word,
                                           const std::string& option) {
    const std::optional<std::int32_t> number = labelNumber(word);
    std::vector<std::string> names;
    std::vector<std::int32_t> matches;
    for (const std::int32_t value : presentLabels(labels.labels)) {
        const auto name = labels.names.find(value);
        if (number ? value == *number : name != labels.names.end() && name->second == word) {
            matches.push_back(value);
        }
        names.push_back(number || name == labels.names.end() ? std::to_string(value) : name->second);
    }
    if (!matches.empty()) {
        return matches;
    }
    const std::string meant = nearestName(word, names);
    return badArgument(option + ": no voxel of the label map has the label " + forMessage(word) +
                       (meant.empty() ? "; it has " + listOf(names) : ", did you mean " + meant + "?"));
}

Result<std::int32_t> labelOf(const NamedLabels& labels, const LabelWord& word, const std::string& option) {
    const Result<std::vector<std::int32_t>> matches = labelsOf(labels, word, option);
    VOXTACT_TRY(matches);
    if (matches->size() > 1) {
        return badArgument(option + ": " + std::to_string(matches->size()) + " labels are called " + forMessage(word) +
                           ", " + std::to_string((*matches)[0]) + " and " + std::to_string((*matches)[1]) +
                           " among them; give a label number instead");
    }
    return matches->front();
}

std::string labelName(const std::map<std::int32_t, std::string>& names, std::int32_t label) {
    const auto name = names.find(label);
    return name == names.end() ? std::to_string(label) : name->second;
}

} // namespace voxtact::app
