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

/// Answers of the host engine, on a thread of its own: of several questions the last is answered.
class HostAnswers {
  public:
    struct Question {
        std::uint64_t revision = 0;
        Edit edit;
        Projection projection = Projection::Conservative;
    };

    /// Copies what it needs of the state. `wake`: called from its thread when there is an answer.
    [[nodiscard]] static Result<std::unique_ptr<HostAnswers>> create(const State& state, std::function<void()> wake);
    ~HostAnswers();

    void ask(Question question);
    /// The newest answer, once; nothing where there is no new one.
    [[nodiscard]] std::optional<Result<LiveAnswer>> take();

  private:
    HostAnswers(cpu::Volume volume, cpu::Mesh mesh, const State& state, std::function<void()> wake);
    void work();
    [[nodiscard]] Result<LiveAnswer> answer(const Question& question);

    cpu::Volume volume_;
    cpu::Mesh mesh_;
    std::optional<LabelData> labels_;
    ValueRange domain_;
    std::uint32_t tableSize_;
    View view_;
    std::function<void()> wake_;
    std::map<Projection, cpu::Detector> detectors_;

    std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<Question> question_;
    std::optional<Result<LiveAnswer>> answer_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

} // namespace voxtact::view
