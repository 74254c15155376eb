// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/inputs.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Labels in options: numbers or names.
namespace voxtact::app {

/// A number or name of a label.
using LabelWord = std::string;

/// Returns the number if the word is one, also if no voxel has the label; empty for a name.
[[nodiscard]] std::optional<std::int32_t> labelNumber(const LabelWord& word);
/// Returns the labels of voxels with this number or name: several may share a name. Never empty. `option`: for
/// messages.
[[nodiscard]] Result<std::vector<std::int32_t>> labelsOf(const NamedLabels& labels, const LabelWord& word,
                                                         const std::string& option);
/// Returns the only such label; refuses several.
[[nodiscard]] Result<std::int32_t> labelOf(const NamedLabels& labels, const LabelWord& word, const std::string& option);
/// Returns the name of a label, or its number if it has none.
[[nodiscard]] std::string labelName(const std::map<std::int32_t, std::string>& names, std::int32_t label);

} // namespace voxtact::app
