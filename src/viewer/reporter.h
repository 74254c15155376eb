// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <filesystem>

namespace voxtact::view {

/// Writes --report-state after changes.
class Reporter {
  public:
    /// An empty path: nothing is written.
    explicit Reporter(std::filesystem::path path) : path_(std::move(path)) {}

    [[nodiscard]] Result<void> write(const State& state);

  private:
    /// Changes that cause a new file.
    struct Seen {
        std::uint64_t revision = 0;
        std::uint64_t measured = 0; ///< revision of the distances
        bool areas = false;         ///< and it has areas
        std::size_t chosen = 0;
        bool settled = false;
        std::string error;
        std::string question;
        std::optional<std::string> field;
        std::string step;     ///< step of loading
        bool loaded = false;  ///< statistics of the last loading are known
        double chartFrom = 0; ///< values of the curve's chart
        double chartTo = 0;
        bool saving = false; ///< a picture is being made
        bool comparing = false;
        std::uint64_t comparison = 0; ///< its serial
        std::size_t compared = 0;     ///< methods that have answered
        std::vector<std::string> notes;
        std::size_t offers = 0;
        std::string status;

        [[nodiscard]] bool operator==(const Seen&) const = default;
    };
    [[nodiscard]] static Seen look(const State& state);

    std::filesystem::path path_;
    Seen seen_;
};

} // namespace voxtact::view
