// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_window.h"

#include <span>

namespace voxtact::app {

/// Notes on a mesh that is a thousand times too small or too large for a volume, or far from it at all poses, usually
/// because of a wrong unit or space; and on a mesh that encloses an opaque region without touching it.
class FitNotes {
  public:
    /// Both arguments must outlive the notes.
    FitNotes(const PairOptions& options, const PairInputs& inputs);

    /// Poses per job that bring the mesh's box near the volume; selectPoses() counts them.
    [[nodiscard]] std::vector<std::uint64_t>& near() noexcept { return near_; }
    /// Counts the poses, and checks the size of the mesh at the first pose of each job.
    void look(const Window& window, const Grid& grid, const OpaqueVoxels& opaque);
    /// Counts a touch, or a distance within the margin, as near, also if the boxes are apart.
    void lookAtAnswers(std::span<const Row> rows);
    /// Appends the notes. Call after all windows.
    void addTo(std::vector<std::string>& notes) const;

  private:
    const PairOptions& options_;
    const PairInputs& inputs_;
    std::vector<std::uint64_t> near_;
    std::vector<std::uint64_t> poses_;
    std::vector<std::string> sizes_; ///< the note of each job; empty: none
    struct First {
        std::vector<Mat4> poses; ///< a sample of the first window, beginning with its first pose
        Grid grid;               ///< of the volume
        OpaqueVoxels opaque;     ///< null: a pose touches
    };
    std::vector<First> first_; ///< of each job
};

} // namespace voxtact::app
