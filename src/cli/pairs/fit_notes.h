// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_window.h"

#include <span>

namespace voxtact::app {

/// Notes on a mesh that is a thousand times too small or too large for a volume, or far from it at all poses, usually
/// because of a wrong unit or space; and on a mesh that encloses an opaque region without touching it.
class FitNotes {
  public:
    /// Both must outlive it.
    FitNotes(const PairOptions& options, const PairInputs& inputs);

    /// Per job: 0 if no pose brings the mesh's box near the volume; selectPoses() counts.
    [[nodiscard]] std::vector<std::uint64_t>& near() noexcept { return near_; }
    /// Counts the poses, and checks the size of the mesh at the first pose of each job.
    void look(const Window& window, const Grid& grid, const OpaqueVoxels& opaque);
    /// A touch, or a distance within the requested one, counts as near, whatever the box.
    void lookAtAnswers(std::span<const Row> rows);
    /// Once all windows have been examined.
    void addTo(std::vector<std::string>& notes) const;

  private:
    const PairOptions& options_;
    const PairInputs& inputs_;
    std::vector<std::uint64_t> near_;
    std::vector<std::uint64_t> poses_;
    std::vector<std::string> sizes_; ///< the note of each job; empty: none
    struct First {
        std::vector<Mat4> poses; ///< some of the first window, its first one at first
        Grid grid;               ///< of the volume
        OpaqueVoxels opaque;     ///< null: something touches at one of the poses
    };
    std::vector<First> first_; ///< of each job
};

} // namespace voxtact::app
