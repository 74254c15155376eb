// SPDX-License-Identifier: MIT
#include "host_side.h"

#include "failure.h"
#include "turn.h"

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

namespace voxtact::python {

namespace {

/// Sets of threads that are kept for ways of asking; others make room.
constexpr std::size_t kMostThreadSets = 8;
/// Where a yes or no is asked about so few, waking threads takes longer than the answer.
constexpr std::size_t kFewTriangles = std::size_t{1} << 14U;

/// Calls `ask` with a task whose `cancel` is ours, on a thread of its own, and lets Python handle signals meanwhile.
/// What a handler raises ends the call.
template <class Task, class Ask> auto interruptibly(Task task, const Ask& ask) {
    constexpr std::chrono::milliseconds kPatience{50};
    std::atomic<bool> cancel{false};
    task.cancel = &cancel;
    auto answer = std::async(std::launch::async, [&] { return ask(task); });
    try {
        while (answer.wait_for(kPatience) != std::future_status::ready) {
            handleSignals();
        }
    } catch (...) {
        cancel = true;
        answer.wait();
        throw;
    }
    return answer.get();
}

/// The one of this process that is kept for a key, or a new one.
template <class T, class Key, class Make>
T& keptOrMade(std::map<Key, OfThisProcess<T>>& all, const Key& key, const Make& make) {
    if (const auto found = all.find(key); found != all.end() && found->second.get() != nullptr) {
        return *found->second.get();
    }
    auto made = std::make_unique<T>(take(make())); // what cannot be made is not kept
    if (all.size() >= kMostThreadSets) {
        all.erase(all.begin());
    }
    OfThisProcess<T>& kept = all[key];
    kept = OfThisProcess<T>(std::move(made));
    return *kept.get();
}

} // namespace

HostSide::HostSide(const VolumeView& volume, const OpacityDesc& opacity, std::uint32_t threads)
    : volume_(take(cpu::Volume::create(volume))), function_(take(cpu::TransferFunction::create(opacity.desc()))),
      threads_(threads != 0 ? threads : std::max(std::thread::hardware_concurrency(), 1U)) {}

void HostSide::setOpacity(const OpacityDesc& opacity) {
    function_ = take(cpu::TransferFunction::create(opacity.desc()));
}

void HostSide::edit(const Edit& edit) {
    if (const auto* set = std::get_if<SetEdit>(&edit)) {
        take(volume_.set(set->region, set->value));
    } else {
        const auto& write = std::get<WriteEdit>(edit);
        take(volume_.write(write.box, write.voxels));
    }
}

std::vector<std::byte> HostSide::voxels(const VolumeView& given) const {
    std::vector<std::byte> all(given.voxels.size());
    take(volume_.read(VoxelBox{{}, given.grid.size}, all));
    return all;
}

void refuseWithoutDevice(CountingMethod method) {
    refuse(ErrorCode::Unsupported,
           std::string("the method ") + toString(method) + " needs a Vulkan device; make the scene with device=");
}

cpu::Detector& HostSide::detectorFor(const Question& question, std::uint32_t threads) {
    if (question.method.value_or(CountingMethod::Cpu) != CountingMethod::Cpu) {
        refuseWithoutDevice(*question.method);
    }
    if (question.filter.value_or(Filter::Exact) != Filter::Exact || question.overestimate) {
        refuse(ErrorCode::Unsupported, "the host engine has the filter exact alone, and no overestimate; for others "
                                       "make the scene with device=");
    }
    if (question.counters) {
        refuse(ErrorCode::Unsupported, "counters are of what the passes on a device do; for them make the scene with "
                                       "device=");
    }
    return keptOrMade(detectors_, std::pair(Question::Key(question.key()), threads), [&] {
        return cpu::Detector::create({.threads = threads,
                                      .boundary = question.boundary,
                                      .stopAtFirst = question.yesNo,
                                      .projection = question.projection,
                                      .outputs = question.outputs,
                                      .samplesPerVoxel = question.samplesPerVoxel,
                                      .resolution = question.resolution,
                                      .mostContacts = question.mostContacts});
    });
}

cpu::ClearanceMeter& HostSide::meterFor(const Distance& distance) {
    return keptOrMade(meters_, Distance::Key(distance.key()), [&] {
        return cpu::ClearanceMeter::create({.threads = threads_,
                                            .tolerance = distance.tolerance,
                                            .maximum = distance.maximum,
                                            .mostSteps = distance.mostSteps,
                                            .labelsAtAnyOpacity = distance.labelsAtAnyOpacity});
    });
}

cpu::AreaMeter& HostSide::meterFor(const Extent& extent) {
    return keptOrMade(areaMeters_, Extent::Key(extent.key()), [&] {
        return cpu::AreaMeter::create(
            {.threads = threads_, .tolerance = extent.tolerance, .mostSteps = extent.mostSteps});
    });
}

cpu::MotionChecker& HostSide::checkerFor(const Way& way) {
    return keptOrMade(checkers_, Way::Key(way.key()), [&] {
        return cpu::MotionChecker::create({.threads = threads_,
                                           .interpolation = way.interpolation,
                                           .resolution = way.resolution,
                                           .mostSteps = way.mostSteps});
    });
}

std::vector<cpu::BatchItem> HostSide::itemsOf(const Part& part, const LabelData* labels) const {
    std::vector<cpu::BatchItem> items;
    part.request.forPart(part.first, part.count, [&](const Request::Item& item, std::span<const Mat4> poses) {
        items.push_back({&item.mesh->onHost(), &volume_, &function_, poses, labels});
    });
    return items;
}

/// Of a count nothing can be said: one triangle may have all the fragments that there are.
bool HostSide::isLittle(const Part& part, const Question& question) noexcept {
    return question.yesNo && part.count * part.request.mostTriangles() <= kFewTriangles;
}

BatchAnswer HostSide::detect(const Part& part, const Question& question, double threshold, const LabelData* labels) {
    cpu::Detector& detector = detectorFor(question, isLittle(part, question) ? 1 : threads_);
    const std::vector<cpu::BatchItem> items = itemsOf(part, labels);
    const cpu::Batch batch{items, viewOf(question, volume_.grid()), threshold};
    const auto ask = [&](const cpu::Batch& asked) { return take(detector.detect(asked)); };
    return isLittle(part, question) ? ask(batch) : interruptibly(batch, ask);
}

ClearanceAnswer HostSide::measure(const Part& part, const Distance& distance, double threshold) {
    cpu::ClearanceMeter& meter = meterFor(distance);
    const std::vector<cpu::BatchItem> items = itemsOf(part, nullptr);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.measure(batch)); });
}

LabelClearanceAnswer HostSide::measureLabels(const Part& part, const Distance& distance, double threshold,
                                             const LabelData* labels, const std::vector<std::int32_t>& wanted) {
    cpu::ClearanceMeter& meter = meterFor(distance);
    const std::vector<cpu::BatchItem> items = itemsOf(part, labels);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.measureLabels(batch, wanted)); });
}

AreaAnswer HostSide::measure(const Part& part, const Extent& extent, double threshold) {
    cpu::AreaMeter& meter = meterFor(extent);
    const std::vector<cpu::BatchItem> items = itemsOf(part, nullptr);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.measure(batch)); });
}

TriangleAreaAnswer HostSide::measureTriangles(const Part& part, const Extent& extent, double threshold) {
    cpu::AreaMeter& meter = meterFor(extent);
    const std::vector<cpu::BatchItem> items = itemsOf(part, nullptr);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.measureTriangles(batch)); });
}

LabelAreaAnswer HostSide::measureLabels(const Part& part, const Extent& extent, double threshold,
                                        const LabelData* labels, const std::vector<std::int32_t>& wanted) {
    cpu::AreaMeter& meter = meterFor(extent);
    const std::vector<cpu::BatchItem> items = itemsOf(part, labels);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.measureLabels(batch, wanted)); });
}

BatchAnswer HostSide::within(const Part& part, double margin, double threshold) {
    const cpu::ClearanceDesc usual;
    cpu::ClearanceMeter& meter = meterFor({usual.tolerance, usual.maximum, usual.mostSteps});
    const std::vector<cpu::BatchItem> items = itemsOf(part, nullptr);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(meter.within(batch, margin)); });
}

MotionAnswer HostSide::move(const Part& part, const Way& way, double threshold) {
    cpu::MotionChecker& checker = checkerFor(way);
    std::vector<cpu::BatchItem> items;
    part.request.forSegments(part.first, part.count, [&](const Request::Item& item, std::span<const Mat4> poses) {
        items.push_back({&item.mesh->onHost(), &volume_, &function_, poses});
    });
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(checker.check(batch)); });
}

BatchAnswer HostSide::around(const Part& part, const PoseTolerance& tolerance, double threshold) {
    const cpu::MotionDesc usual;
    cpu::MotionChecker& checker = checkerFor({usual.interpolation, usual.resolution, usual.mostSteps});
    const std::vector<cpu::BatchItem> items = itemsOf(part, nullptr);
    return interruptibly(cpu::Batch{items, {}, threshold},
                         [&](const cpu::Batch& batch) { return take(checker.around(batch, tolerance)); });
}

TrackedClearance HostSide::track(cpu::ClearanceTracker& tracker, const Shape& mesh, const Mat4& world_from_object,
                                 double threshold) const {
    return take(tracker.track({&mesh.onHost(), &volume_, &function_, {&world_from_object, 1}}, threshold));
}

PlanAnswer HostSide::plan(const PlanWish& wish, double threshold, const LabelData* labels) {
    cpu::Planner planner = take(cpu::Planner::create(
        {.threads = threads_, .tolerance = wish.tolerance, .maximum = wish.maximum, .mostSteps = wish.mostSteps}));
    std::vector<cpu::PlanObstacle> obstacles;
    if (!wish.avoid.empty()) {
        obstacles.push_back({&volume_, nullptr, threshold, labels, wish.avoid, "avoid"});
    }
    std::optional<cpu::Volume> other;
    std::optional<cpu::TransferFunction> opaque;
    if (wish.avoided) {
        if (wish.avoided->volume != nullptr) {
            other = take(cpu::Volume::create(wish.avoided->volume->view()));
        }
        opaque = take(cpu::TransferFunction::create(wish.avoided->opacity.desc()));
        obstacles.push_back({other ? &*other : &volume_, &*opaque, threshold, nullptr, {}, "avoid_opacity"});
    }
    cpu::PlanTask task;
    task.target = wish.target;
    task.surface.entries = wish.entries;
    task.surface.borderEntries = wish.borderEntries;
    if (wish.entryRadius) {
        task.surface.radius = *wish.entryRadius;
    } else if (wish.entryLabel) {
        task.surface.labels = labels;
        task.surface.label = *wish.entryLabel;
    } else {
        task.surface.volume = &volume_;
        task.surface.transferFunction = &function_;
        task.surface.threshold = threshold;
    }
    task.obstacles = obstacles;
    task.needle = wish.needle;
    if (wish.mesh != nullptr) {
        task.mesh = cpu::PlanMesh{&wish.mesh->onHost(), wish.tip, wish.axis};
    }
    task.margin = wish.margin;
    task.triangleClearances = wish.triangleClearances;
    task.longest = wish.longest;
    task.steepest = wish.steepest;
    return interruptibly(task, [&](const cpu::PlanTask& asked) { return take(planner.plan(asked)); });
}

} // namespace voxtact::python
