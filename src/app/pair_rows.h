// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect_run.h"

/// Which pairs of a volume are put to an engine, and where their answers go.
namespace voxtact::app {

/// Poses of one mesh, and their numbers in the file.
struct SelectedPoses {
    std::vector<Mat4> world_from_object;
    std::vector<std::uint32_t> numbers;
};

/// Of each mesh the poses at which its box comes near the volume: the others have no survivor. All poses where that
/// does not follow (--boundary clamp), and with --timing, which is about every pair.
[[nodiscard]] std::vector<SelectedPoses> selectPoses(const DetectOptions& options, const DetectInputs& inputs,
                                                     const Grid& grid);

/// The rows of one volume: every pose of every mesh, those that are not selected with the answer that nothing touches.
class PairRows {
  public:
    /// `answer` says by which method and in which projection. The rows are appended to the run's. All arguments must
    /// outlive it.
    PairRows(const DetectOptions& options, const DetectInputs& inputs, const std::vector<SelectedPoses>& selected,
             std::uint32_t volume, const PairAnswer& answer, DetectRun& run);

    /// The answer for a pose of SelectedPoses.
    void add(const TimedAnswer& timed);
    /// The answers beside the counts of the pairs that were added since the last time.
    void addOutputs(const BatchAnswer& answer);

  private:
    const ExtraOptions& extra_;
    const std::vector<SelectedPoses>& selected_;
    DetectRun& run_;
    std::size_t firstRow_;
    std::size_t poses_;
    std::vector<std::uint32_t> batch_; ///< rows of the pairs of the current batch
};

} // namespace voxtact::app
