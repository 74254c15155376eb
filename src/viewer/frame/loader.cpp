// SPDX-License-Identifier: MIT
#include "viewer/frame/loader.h"

#include "core/base/guard.h"
#include "core/base/try.h"
#include "viewer/model/files/coarser.h"

#include <algorithm>

namespace voxtact::view {

namespace {

std::string sidesText(const Grid& grid) {
    return std::to_string(grid.size[0]) + " x " + std::to_string(grid.size[1]) + " x " + std::to_string(grid.size[2]);
}

/// The volume as coarse as its document wants it.
Result<void> coarsen(Given& given, Progress& progress) {
    const std::uint32_t factor = given.document.sources.coarser / given.coarserBy;
    if (factor < 2) {
        return {};
    }
    VOXTACT_TRY(progress.begin("downsampling the volume"));
    Result<VolumeData> volume = coarser(given.volume, factor, [&](double share) { return progress.tell(share); });
    VOXTACT_TRY(volume);
    const Result<ValueRange> values = checkVolume(volume->view());
    VOXTACT_TRY(values);
    given.volume = std::move(*volume);
    given.values = *values;
    given.coarserBy = given.document.sources.coarser;
    return {};
}

std::uint32_t largestSide(const Grid& grid) {
    return *std::ranges::max_element(grid.size);
}

Result<Volume> upload(const device::Session& session, const State& state, std::uint32_t maxSide) {
    if (maxSide != 0 && largestSide(state.volume.grid) > maxSide) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the volume has " + sidesText(state.volume.grid) + " voxels; --volume-side allows at most " +
                         std::to_string(maxSide) + " along a side"};
    }
    return Stage::upload(session, state.volume);
}

/// Returns the minimum factor for a limit of the sides; at least twice the current one.
std::uint32_t factorFor(const State& state, std::uint32_t maxSide) {
    std::uint32_t factor = 2 * state.coarserBy;
    while (maxSide != 0 && largestSide(state.volume.grid) * state.coarserBy > maxSide * factor) {
        factor += state.coarserBy;
    }
    return factor;
}

bool isTooLarge(const Error& error) {
    return error.code == ErrorCode::LimitExceeded || error.code == ErrorCode::OutOfMemory;
}

} // namespace

Loader::Loader(const device::Session& session, std::function<void()> wake)
    : session_(&session), wake_(std::move(wake)), thread_([this] { work(); }) {}

Loader::~Loader() {
    cancel();
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    asked_.notify_one();
    thread_.join();
}

void Loader::start(LoadTask task) {
    cancel();
    progress_ = std::make_shared<Progress>();
    {
        const std::lock_guard lock(mutex_);
        job_ = Job{std::move(task), progress_};
    }
    asked_.notify_one();
}

void Loader::cancel() {
    if (progress_) {
        progress_->cancel();
    }
    progress_.reset();
    const std::lock_guard lock(mutex_);
    job_.reset();
}

std::optional<std::variant<Loaded, LoadFailure>> Loader::take() {
    std::optional<Outcome> outcome;
    std::shared_ptr<Progress> of;
    {
        const std::lock_guard lock(mutex_);
        outcome = std::exchange(outcome_, std::nullopt);
        of = std::exchange(outcomeOf_, nullptr);
    }
    if (!outcome) {
        return std::nullopt;
    }
    if (of != progress_) { // cancelled after it was complete
        if (auto* const loaded = std::get_if<Loaded>(&*outcome)) {
            discard(std::move(loaded->stage));
        }
        return std::nullopt;
    }
    progress_.reset();
    return outcome;
}

void Loader::discard(std::unique_ptr<Stage> stage) {
    // std::function copies what it holds.
    run([kept = std::shared_ptr<Stage>(std::move(stage))]() mutable { kept.reset(); });
}

void Loader::run(std::function<void()> work) {
    {
        const std::lock_guard lock(mutex_);
        chores_.push_back(std::move(work));
    }
    asked_.notify_one();
}

void Loader::work() {
    while (true) {
        std::optional<Job> job;
        std::vector<std::function<void()>> chores;
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return stop_ || job_ || !chores_.empty(); });
            if (stop_) {
                return;
            }
            job = std::exchange(job_, std::nullopt);
            chores = std::exchange(chores_, {});
        }
        for (std::function<void()>& chore : chores) {
            chore();
        }
        chores.clear();
        if (!job) {
            continue;
        }
        Outcome outcome = done(*job);
        {
            const std::lock_guard lock(mutex_);
            outcome_ = std::move(outcome);
            outcomeOf_ = job->progress;
        }
        wake_();
    }
}

Loader::Outcome Loader::done(const Job& job) const {
    Progress& progress = *job.progress;
    LoadFailure failure;
    failure.opened = job.task.opened;
    Loaded loaded;
    loaded.opened = job.task.opened;
    const Result<void> made = guard([&]() -> Result<void> {
        Result<Given> given = job.task.read(progress);
        VOXTACT_TRY(given);
        VOXTACT_TRY(coarsen(*given, progress));
        VOXTACT_TRY(progress.begin("reading the voxels"));
        given->deviceName = session_->device.physical().name;
        loaded.state = std::make_unique<State>(std::move(*given));
        State& state = *loaded.state;
        VOXTACT_TRY(progress.begin("uploading the volume"));
        Result<Volume> volume = upload(*session_, state, job.task.maxSide);
        if (!volume.ok()) {
            if (isTooLarge(volume.error()) && largestSide(state.volume.grid) > 2) {
                failure.coarser = factorFor(state, job.task.maxSide);
                failure.tooLarge = std::make_unique<Given>(state.giveBack());
            }
            return volume.error();
        }
        Result<std::unique_ptr<Stage>> stage =
            Stage::create(*session_, state, std::move(*volume), job.task.stage, progress);
        VOXTACT_TRY(stage);
        loaded.stage = std::move(*stage);
        return {};
    });
    if (made.ok()) {
        return loaded;
    }
    failure.error = made.error();
    if (progress.cancelled()) {
        failure.error.code = ErrorCode::Cancelled;
    }
    return failure;
}

} // namespace voxtact::view
