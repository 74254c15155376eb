// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// What the window keeps from run to run.
namespace voxtact::view {

/// $XDG_STATE_HOME/voxtact, else ~/.local/state/voxtact; empty where neither is known. It need not be there.
[[nodiscard]] std::filesystem::path stateFolder();

/// Files that were opened, the last first, each once. All that can go wrong with the file where they are kept is that
/// nothing is kept.
class RecentFiles {
  public:
    static constexpr std::size_t kMost = 12;

    /// Of a file as add() writes it; an empty path, a missing file and one that is anything else: none.
    explicit RecentFiles(std::filesystem::path file = {});

    [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }
    /// As an absolute path; written at once. What is builtin is no file.
    void add(const std::string& path);

  private:
    std::filesystem::path file_;
    std::vector<std::string> paths_;
};

} // namespace voxtact::view
