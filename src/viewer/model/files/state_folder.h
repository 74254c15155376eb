// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// State that the window keeps between runs.
namespace voxtact::view {

/// Returns $XDG_STATE_HOME/voxtact, else ~/.local/state/voxtact; empty if neither is known. It need not exist.
[[nodiscard]] std::filesystem::path stateFolder();

/// Opened files, the last first, each once. Errors of the list's file are ignored.
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
