// SPDX-License-Identifier: MIT
#include "view/frame/host_answers.h"

#include "core/base/guard.h"
#include "core/base/try.h"

namespace voxtact::view {

namespace {

constexpr std::uint32_t kAnswerSide = 512; // as voxtact detect has it

} // namespace

Result<std::unique_ptr<HostAnswers>> HostAnswers::create(const State& state, std::function<void()> wake) {
    Result<cpu::Volume> volume = cpu::Volume::create(state.volume.view());
    VOXTACT_TRY(volume);
    Result<cpu::Mesh> mesh = cpu::Mesh::create(state.mesh.view());
    VOXTACT_TRY(mesh);
    return std::unique_ptr<HostAnswers>(new HostAnswers(std::move(*volume), std::move(*mesh), state, std::move(wake)));
}

HostAnswers::HostAnswers(cpu::Volume volume, cpu::Mesh mesh, const State& state, std::function<void()> wake)
    : volume_(std::move(volume)), mesh_(std::move(mesh)),
      labels_(state.labels ? std::optional(state.labels->map) : std::nullopt), domain_(state.document.domain),
      tableSize_(state.document.tableSize), view_{framingCamera(state.volume.grid, kAnswerSide, kAnswerSide),
                                                  kAnswerSide, kAnswerSide},
      wake_(std::move(wake)), thread_([this] { work(); }) {}

HostAnswers::~HostAnswers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    asked_.notify_one();
    thread_.join();
}

void HostAnswers::ask(Question question) {
    {
        const std::lock_guard lock(mutex_);
        question_ = std::move(question);
    }
    asked_.notify_one();
}

std::optional<Result<LiveAnswer>> HostAnswers::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
}

void HostAnswers::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        asked_.wait(lock, [this] { return stop_ || question_; });
        if (stop_) {
            return;
        }
        const Question question = *std::exchange(question_, std::nullopt);
        lock.unlock();
        Result<LiveAnswer> found = guard([&] { return answer(question); });
        lock.lock();
        answer_ = std::move(found);
        if (!stop_) {
            wake_();
        }
    }
}

Result<LiveAnswer> HostAnswers::answer(const Question& question) {
    auto detector = detectors_.find(question.projection);
    if (detector == detectors_.end()) {
        cpu::DetectorDesc desc;
        desc.projection = question.projection;
        desc.outputs = {.triangles = true, .contacts = true, .labels = labels_.has_value()};
        Result<cpu::Detector> made = cpu::Detector::create(desc);
        VOXTACT_TRY(made);
        detector = detectors_.emplace(question.projection, std::move(*made)).first;
    }
    const auto begun = State::Clock::now();
    const Result<cpu::TransferFunction> function =
        cpu::TransferFunction::create({question.edit.curve, domain_, tableSize_});
    VOXTACT_TRY(function);
    const cpu::BatchItem item{
        &mesh_, &volume_, &*function, {&question.edit.world_from_object, 1}, labels_ ? &*labels_ : nullptr};
    cpu::Batch batch;
    batch.items = {&item, 1};
    batch.view = view_;
    batch.threshold = question.edit.threshold;
    batch.cancel = &stop_;
    Result<BatchAnswer> found = detector->second.detect(batch);
    VOXTACT_TRY(found);
    const double milliseconds = std::chrono::duration<double, std::milli>(State::Clock::now() - begun).count();
    return liveAnswer(std::move(*found), question.revision, question.edit.world_from_object, milliseconds);
}

} // namespace voxtact::view
