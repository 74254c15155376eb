// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// State that the window keeps between runs.
namespace voxtact::view {

/// $XDG_STATE_HOME/voxtact, else ~/.local/state/voxtact; empty where neither is known. It need not be there.
[[nodiscard]] std::filesystem::path stateFolder();

/// Files that were opened, the last first, each once. All that can go wrong with the file where they are kept is that
/// nothing is kept.
class RecentFiles {
  public:
    static constexpr std::size_t kMost = 12;

    /// Reads a file written by add(); an empty path, a missing or an invalid file give an empty list.
    explicit RecentFiles(std::filesystem::path file = {});

    [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }
    /// Adds a file as an absolute path, and writes immediately. Skips builtins.
    void add(const std::string& path);

  private:
    std::filesystem::path file_;
    std::vector<std::string> paths_;
};

} // namespace voxtact::view
