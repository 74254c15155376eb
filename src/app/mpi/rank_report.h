// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

/// What the ranks of a job tell the first one when they have ended.
namespace voxtact::app {

/// How a rank has ended.
struct RankEnd {
    int status = 0;    ///< of its program
    bool done = false; ///< it has said that it asks for no more chunks
    std::string text;  ///< why it failed, or else its notes, a line each

    [[nodiscard]] std::string message() const;
    /// Of what message() returned.
    [[nodiscard]] static RankEnd of(const std::string& message);
};

/// The notes of the ranks: each is said once, with whose it is where there are several ranks.
class RankNotes {
  public:
    void add(int rank, const std::string& note);
    /// In the order in which they came first.
    [[nodiscard]] std::vector<std::string> lines(int ranks) const;

  private:
    std::vector<std::pair<std::string, std::vector<int>>> notes_; ///< and the ranks that say it, each once
};

} // namespace voxtact::app
