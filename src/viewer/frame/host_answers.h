// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"
#include "voxtact/cpu.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace voxtact::view {

/// Answers of the host engine, with distances, areas and overlaps, on a separate thread: answers the last of several
/// questions. A new question cancels measurements and comparisons.
class HostAnswers {
  public:
    /// Copies its inputs from the state. `wake`: called from its thread when there is an answer.
    [[nodiscard]] static Result<std::unique_ptr<HostAnswers>> create(const State& state, std::function<void()> wake);
    ~HostAnswers();

    /// Measures the distance, then the area, and answers if the question's method is the host's. `writes`: to the
    /// volume since it was read.
    void ask(LiveQuestion question, const HoleWrites& writes);
    /// Number of the first write that was not applied yet.
    [[nodiscard]] std::uint64_t written() const { return written_; }
    /// Asks a question of a comparison, if idle.
    void compare(LiveQuestion question);
    /// Returns the result of a comparison's question, once; Cancelled if another question cancelled it.
    [[nodiscard]] std::optional<Result<LiveAnswer>> takeCompared();
    /// Returns the newest answer, once; empty if there is no new one.
    [[nodiscard]] std::optional<Result<LiveAnswer>> take();
    /// Returns the distances, then with areas, then with overlaps.
    [[nodiscard]] std::optional<Result<LiveMeasures>> takeDistances();

  private:
    HostAnswers(cpu::HostEngine engine, cpu::Volume volume, std::vector<cpu::Mesh> meshes, const State& state,
                std::function<void()> wake);
    void work();
    template <class Found> void give(std::optional<Result<Found>>& to, Result<Found> found);
    /// Valid until the next call.
    [[nodiscard]] Result<cpu::Batch> batchOf(const LiveQuestion& question, const std::atomic<bool>& cancel);
    [[nodiscard]] Result<LiveAnswer> answer(const LiveQuestion& question, const std::atomic<bool>& cancel);
    [[nodiscard]] Result<LiveMeasures> measure(const LiveQuestion& question);
    /// Adds the overlaps of closed meshes.
    [[nodiscard]] Result<LiveMeasures> withOverlaps(const LiveQuestion& question, LiveMeasures measures);
    /// Adds the areas to the distances.
    [[nodiscard]] Result<LiveMeasures> withAreas(const LiveQuestion& question, LiveMeasures distances);
    void follow(const LiveQuestion& question, const std::vector<HoleWrite>& writes);

    cpu::HostEngine engine_;
    cpu::Volume volume_;
    std::vector<cpu::Mesh> meshes_; ///< by their numbers in Sources::meshes
    std::optional<LabelData> labels_;
    ValueRange domain_;
    std::uint32_t tableSize_;
    View view_;
    std::function<void()> wake_;
    std::optional<cpu::TransferFunction> function_;
    Curve functionOf_; ///< what function_ was made from
    std::vector<Mat4> poses_;
    std::vector<cpu::BatchItem> items_;

    std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<LiveQuestion> question_;
    std::optional<LiveQuestion> compare_;
    std::vector<HoleWrite> writes_; ///< that are to be done before it
    std::uint64_t written_ = 0;     ///< that were taken over
    std::optional<Result<LiveAnswer>> answer_;
    std::optional<Result<LiveAnswer>> compared_;
    std::optional<Result<LiveMeasures>> distances_;
    std::atomic<bool> stop_ = false;
    std::atomic<bool> newer_ = false; ///< a question waits
    std::thread thread_;
};

} // namespace voxtact::view
