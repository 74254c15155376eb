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

/// Outputs of `voxtact count` in addition to the counts: options, row data and columns. pair_files.h writes their
/// files.
namespace voxtact::app {

struct Row;
class PairOutput;

constexpr std::uint32_t kDefaultMaxContacts = 1U << 20U;

/// Options of additional outputs.
struct ExtraOptions {
    std::filesystem::path triangles; ///< files to write; empty: not requested
    std::filesystem::path contacts;
    Outputs asked; ///< outputs requested by a flag alone
    std::optional<double> maxDepth;
    std::optional<std::uint32_t> maxContacts;

    [[nodiscard]] Outputs outputs() const;
    [[nodiscard]] std::uint32_t contactRoom() const { return maxContacts.value_or(kDefaultMaxContacts); }
};

void addExtraOptions(CLI::App& parser, ExtraOptions& options);

/// Additional outputs of a row.
struct ExtraAnswers;
/// Null: no results.
using KeptExtra = std::shared_ptr<ExtraAnswers>;

[[nodiscard]] std::optional<Box> boundsOf(const KeptExtra& kept);

/// Distributes the answers of a batch to the rows with the indices in `batch`, and to the output.
void keepExtra(const BatchAnswer& answer, std::span<const std::uint32_t> batch, std::span<Row> rows,
               PairOutput& output);

struct ExtraColumn {
    std::string name;
    std::function<io::Cell(const KeptExtra&)> cell;
};

/// Returns the columns of the requested outputs. `names` must outlive them.
[[nodiscard]] std::vector<ExtraColumn> extraColumns(const Outputs& outputs,
                                                    const std::map<std::int32_t, std::string>& names);

/// Rounds to a fraction of 1, for a short text.
[[nodiscard]] double rounded(double value, double parts);

} // namespace voxtact::app
