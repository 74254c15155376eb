// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/inputs.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Labels as an option names them.
namespace voxtact::app {

/// A label by its number, or by its name.
using LabelWord = std::string;

/// A number of a label, which no voxel needs to have; nothing where the word is a name.
[[nodiscard]] std::optional<std::int32_t> labelNumber(const LabelWord& word);
/// All labels that voxels have of a number or a name: several may be called the same. Never none. `option` is for
/// messages.
[[nodiscard]] Result<std::vector<std::int32_t>> labelsOf(const NamedLabels& labels, const LabelWord& word,
                                                         const std::string& option);
/// The only one.
[[nodiscard]] Result<std::int32_t> labelOf(const NamedLabels& labels, const LabelWord& word, const std::string& option);
/// The name of a label, or its number where it has none.
[[nodiscard]] std::string labelName(const std::map<std::int32_t, std::string>& names, std::int32_t label);

} // namespace voxtact::app
