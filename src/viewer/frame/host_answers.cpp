// SPDX-License-Identifier: MIT
#include "viewer/frame/host_answers.h"

#include "core/base/guard.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

namespace voxtact::view {

namespace {

double since(State::Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(State::Clock::now() - begun).count();
}

} // namespace

Result<std::unique_ptr<HostAnswers>> HostAnswers::create(const State& state, std::function<void()> wake) {
    Result<cpu::HostEngine> engine = cpu::HostEngine::create();
    VOXTACT_TRY(engine);
    Result<cpu::Volume> volume = cpu::Volume::create(state.volume.view());
    VOXTACT_TRY(volume);
    std::vector<cpu::Mesh> meshes;
    for (const MeshData& data : state.meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        meshes.push_back(std::move(*mesh));
    }
    return std::unique_ptr<HostAnswers>(
        new HostAnswers(std::move(*engine), std::move(*volume), std::move(meshes), state, std::move(wake)));
}

HostAnswers::HostAnswers(cpu::HostEngine engine, cpu::Volume volume, std::vector<cpu::Mesh> meshes, const State& state,
                         std::function<void()> wake)
    : engine_(std::move(engine)), volume_(std::move(volume)), meshes_(std::move(meshes)),
      labels_(state.labels ? std::optional(state.labels->map) : std::nullopt), domain_(state.document.domain),
      tableSize_(state.document.tableSize), view_(answerView(state.volume.grid)), wake_(std::move(wake)),
      thread_([this] { work(); }) {}

HostAnswers::~HostAnswers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        newer_ = true;
    }
    asked_.notify_one();
    thread_.join();
}

void HostAnswers::ask(LiveQuestion question, const HoleWrites& writes) {
    {
        const std::lock_guard lock(mutex_);
        const std::span<const HoleWrite> news = writes.from(written_);
        writes_.insert(writes_.end(), news.begin(), news.end());
        written_ = writes.end();
        question_ = std::move(question);
        newer_ = true;
    }
    asked_.notify_one();
}

void HostAnswers::compare(LiveQuestion question) {
    {
        const std::lock_guard lock(mutex_);
        compare_ = std::move(question);
    }
    asked_.notify_one();
}

std::optional<Result<LiveAnswer>> HostAnswers::takeCompared() {
    const std::lock_guard lock(mutex_);
    return std::exchange(compared_, std::nullopt);
}

std::optional<Result<LiveAnswer>> HostAnswers::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
}

std::optional<Result<LiveMeasures>> HostAnswers::takeDistances() {
    const std::lock_guard lock(mutex_);
    return std::exchange(distances_, std::nullopt);
}

template <class Found> void HostAnswers::give(std::optional<Result<Found>>& to, Result<Found> found) {
    const std::lock_guard lock(mutex_);
    to = std::move(found);
    if (!stop_) {
        wake_();
    }
}

void HostAnswers::work() {
    while (true) {
        LiveQuestion question;
        std::vector<HoleWrite> writes;
        bool compared = false;
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return stop_ || question_ || compare_; });
            if (stop_) {
                return;
            }
            compared = !question_;
            question = *std::exchange(compared ? compare_ : question_, std::nullopt);
            writes = std::exchange(writes_, {});
            newer_ = false;
        }
        if (compared) {
            give(compared_, guard([&] { return answer(question, newer_); }));
        } else {
            follow(question, writes);
        }
    }
}

/// The live question: first updates the volume.
void HostAnswers::follow(const LiveQuestion& question, const std::vector<HoleWrite>& writes) {
    for (const HoleWrite& write : writes) {
        if (const Result<void> written = volume_.write(write.hole->box, write.voxels()); !written.ok()) {
            give(distances_, Result<LiveMeasures>(written.error()));
        }
    }
    if (rowOf(question.method.count).host) {
        give(answer_, guard([&] { return answer(question, stop_); }));
    }
    const Result<LiveMeasures> distances = guard([&] { return measure(question); });
    give(distances_, distances);
    if (!distances.ok()) {
        return;
    }
    Result<LiveMeasures> all = *distances;
    for (const auto more : {&HostAnswers::withAreas, &HostAnswers::withOverlaps}) {
        all = guard([&] { return (this->*more)(question, std::move(*all)); });
        if (all.ok() || all.error().code != ErrorCode::Cancelled) {
            give(distances_, all);
        }
        if (!all.ok()) {
            return;
        }
    }
}

Result<cpu::Batch> HostAnswers::batchOf(const LiveQuestion& question, const std::atomic<bool>& cancel) {
    if (!function_ || !sameCurve(functionOf_, question.edit.curve)) {
        Result<cpu::TransferFunction> made = cpu::TransferFunction::create({question.edit.curve, domain_, tableSize_});
        VOXTACT_TRY(made);
        function_ = std::move(*made);
        functionOf_ = question.edit.curve;
    }
    const std::vector<Instrument>& instruments = question.edit.instruments;
    poses_.clear();
    for (const Instrument& instrument : instruments) {
        poses_.push_back(instrument.world_from_object);
    }
    items_.clear();
    for (std::size_t i = 0; i < instruments.size(); ++i) {
        const cpu::Mesh& mesh = meshes_[instruments[i].mesh];
        items_.push_back({&mesh, &volume_, &*function_, {&poses_[i], 1}, labels_ ? &*labels_ : nullptr});
    }
    cpu::Batch batch;
    batch.items = items_;
    batch.view = view_;
    batch.threshold = question.edit.threshold;
    batch.cancel = &cancel;
    return batch;
}

Result<LiveAnswer> HostAnswers::answer(const LiveQuestion& question, const std::atomic<bool>& cancel) {
    const auto begun = State::Clock::now();
    const Result<cpu::Batch> batch = batchOf(question, cancel);
    VOXTACT_TRY(batch);
    Result<BatchAnswer> found =
        engine_.ask(Count{.projection = question.method.projection,
                          .outputs = {.triangles = true, .contacts = true, .labels = labels_.has_value()}},
                    *batch);
    VOXTACT_TRY(found);
    return liveAnswer(std::move(*found), question.revision, question.edit.instruments, since(begun));
}

Result<LiveMeasures> HostAnswers::measure(const LiveQuestion& question) {
    const auto begun = State::Clock::now();
    const Result<cpu::Batch> batch = batchOf(question, newer_);
    VOXTACT_TRY(batch);
    const Result<DistanceAnswer> found = engine_.ask(Distance{}, *batch);
    VOXTACT_TRY(found);
    LiveMeasures out{question.revision, {}, since(begun)};
    for (std::size_t i = 0; i < found->pairs.size(); ++i) {
        out.meshes.push_back({question.edit.instruments[i].mesh, found->pairs[i], {}});
    }
    return out;
}

Result<LiveMeasures> HostAnswers::withAreas(const LiveQuestion& question, LiveMeasures distances) {
    const auto begun = State::Clock::now();
    const Result<cpu::Batch> batch = batchOf(question, newer_);
    VOXTACT_TRY(batch);
    const Result<AreaAnswer> found = engine_.ask(Area{}, *batch);
    VOXTACT_TRY(found);
    for (std::size_t i = 0; i < found->pairs.size(); ++i) {
        distances.meshes[i].area = found->pairs[i];
    }
    distances.milliseconds += since(begun);
    return distances;
}

Result<LiveMeasures> HostAnswers::withOverlaps(const LiveQuestion& question, LiveMeasures measures) {
    const auto begun = State::Clock::now();
    Result<cpu::Batch> batch = batchOf(question, newer_);
    VOXTACT_TRY(batch);
    for (std::size_t i = 0; i < items_.size(); ++i) {
        batch->items = std::span(items_).subspan(i, 1);
        const Result<OverlapAnswer> found = engine_.ask(Overlap{}, *batch);
        if (found.ok()) {
            measures.meshes[i].overlap = found->pairs[0];
        } else if (found.error().code != ErrorCode::InvalidArgument) { // a mesh with holes has no inside
            return found.error();
        }
    }
    measures.milliseconds += since(begun);
    return measures;
}

} // namespace voxtact::view
