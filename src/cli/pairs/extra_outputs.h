// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "voxtact/results.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

/// The outputs of `voxtact count` in addition to the counts, each in one place: its options, its part of a row, its
/// columns. Their files are in pair_files.h.
namespace voxtact::app {

struct Row;
class PairOutput;

constexpr std::uint32_t kDefaultMaxContacts = 1U << 20U;

/// Options of additional outputs.
struct ExtraOptions {
    std::filesystem::path triangles; ///< files to write; empty: not asked for
    std::filesystem::path contacts;
    Outputs asked; ///< those that a flag alone asks for
    std::optional<double> maxDepth;
    std::optional<std::uint32_t> maxContacts;

    [[nodiscard]] Outputs outputs() const;
    [[nodiscard]] std::uint32_t contactRoom() const { return maxContacts.value_or(kDefaultMaxContacts); }
};

void addExtraOptions(CLI::App& parser, ExtraOptions& options);

/// Additional outputs of a row.
struct ExtraAnswers;
/// Null: nothing was found.
using KeptExtra = std::shared_ptr<ExtraAnswers>;

[[nodiscard]] std::optional<Box> boundsOf(const KeptExtra& kept);

/// Gives the answers of a batch to the rows of its pairs, by the numbers in `batch`, and to the output.
void keepExtra(const BatchAnswer& answer, std::span<const std::uint32_t> batch, std::span<Row> rows,
               PairOutput& output);

struct ExtraColumn {
    std::string name;
    std::function<io::Cell(const KeptExtra&)> cell;
};

/// Returns the columns of the requested outputs. `names` of labels must outlive them.
[[nodiscard]] std::vector<ExtraColumn> extraColumns(const Outputs& outputs,
                                                    const std::map<std::int32_t, std::string>& names);

/// Rounds to a fraction of 1, for a short text.
[[nodiscard]] double rounded(double value, double parts);

} // namespace voxtact::app
