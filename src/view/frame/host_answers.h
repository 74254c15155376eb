// SPDX-License-Identifier: MIT
#pragma once

#include "view/state.h"
#include "voxtact/cpu.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace voxtact::view {

/// Answers of the host engine and clearances, on a thread of its own: of several questions the last is answered. A
/// clearance that is being measured gives way to a new question.
class HostAnswers {
  public:
    struct Question {
        std::uint64_t revision = 0;
        Edit edit;
        Projection projection = Projection::Conservative;
        bool answer = false; ///< not only the clearance
    };

    /// Copies what it needs of the state. `wake`: called from its thread when there is an answer.
    [[nodiscard]] static Result<std::unique_ptr<HostAnswers>> create(const State& state, std::function<void()> wake);
    ~HostAnswers();

    /// `writes`: all to the volume since it was read.
    void ask(Question question, std::span<const HoleWrite> writes);
    /// The newest answer, once; nothing where there is no new one.
    [[nodiscard]] std::optional<Result<LiveAnswer>> take();
    /// The same of clearances.
    [[nodiscard]] std::optional<Result<LiveClearance>> takeClearance();

  private:
    HostAnswers(cpu::Volume volume, std::vector<cpu::Mesh> meshes, const State& state, std::function<void()> wake);
    void work();
    template <class Found> void give(std::optional<Result<Found>>& to, Result<Found> found);
    /// Valid until the next call.
    [[nodiscard]] Result<cpu::Batch> batchOf(const Question& question, const std::atomic<bool>& cancel);
    [[nodiscard]] Result<LiveAnswer> answer(const Question& question);
    [[nodiscard]] Result<LiveClearance> measure(const Question& question);

    cpu::Volume volume_;
    std::vector<cpu::Mesh> meshes_; ///< by their numbers in Sources::meshes
    std::optional<LabelData> labels_;
    ValueRange domain_;
    std::uint32_t tableSize_;
    View view_;
    std::function<void()> wake_;
    std::map<Projection, cpu::Detector> detectors_;
    std::optional<cpu::ClearanceMeter> meter_;
    std::optional<cpu::TransferFunction> function_;
    Curve functionOf_; ///< what function_ was made from
    std::vector<Mat4> poses_;
    std::vector<cpu::BatchItem> items_;

    std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<Question> question_;
    std::vector<HoleWrite> writes_; ///< that are to be done before it
    std::size_t written_ = 0;       ///< that were taken over, of all
    std::optional<Result<LiveAnswer>> answer_;
    std::optional<Result<LiveClearance>> clearance_;
    std::atomic<bool> stop_ = false;
    std::atomic<bool> newer_ = false; ///< there is a question that nobody looks at yet
    std::thread thread_;
};

} // namespace voxtact::view
