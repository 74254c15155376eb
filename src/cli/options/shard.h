// SPDX-License-Identifier: MIT
#pragma once

#include "cli/output/output.h"

#include <cstdint>
#include <initializer_list>
#include <utility>

namespace CLI {
class App;
} // namespace CLI

namespace voxtact::app {

/// A contiguous part of a run's rows: number `index`, from 1, of `count`. The concatenated CSV of all parts is the CSV
/// of the whole run.
struct Shard {
    std::uint32_t index = 1;
    std::uint32_t count = 1;

    [[nodiscard]] bool isPart() const noexcept { return count > 1; }
    /// Returns true if the part has the CSV header.
    [[nodiscard]] bool hasHead() const noexcept { return index == 1; }
    /// Returns the first row of the part, and the end of its rows.
    [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> range(std::uint64_t rows) const noexcept;
};

void addShardOption(CLI::App& parser, Shard& shard);

/// Refuses formats other than CSV, and given options (is given, name) that describe the whole run. Rows of a part are
/// CSV by default.
[[nodiscard]] Result<void> checkShard(const Shard& shard, OutputOptions& output,
                                      std::initializer_list<std::pair<bool, const char*>> whole);

} // namespace voxtact::app
