// SPDX-License-Identifier: MIT
#include "host_side.h"

#include "failure.h"

#include <thread>

namespace voxtact::python {

namespace {

/// Sets of threads that are kept for ways of asking; the oldest make room.
constexpr std::size_t kMostKept = 8;
/// Where a yes or no is asked about so few, waking threads takes longer than the answer.
constexpr std::size_t kFewTriangles = std::size_t{1} << 14U;

/// The one of this process that is kept for a key, or a new one.
template <class T, class Key, class Make>
T& keptOrMade(std::map<Key, OfThisProcess<T>>& all, const Key& key, const Make& make) {
    if (const auto found = all.find(key); found != all.end() && found->second.get() != nullptr) {
        return *found->second.get();
    }
    if (all.size() >= kMostKept) {
        all.erase(all.begin());
    }
    OfThisProcess<T>& kept = all[key];
    kept = OfThisProcess<T>(std::make_unique<T>(take(make())));
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

cpu::Detector& HostSide::detectorFor(const Question& question, std::uint32_t threads) {
    if (question.method.value_or(CountingMethod::Cpu) != CountingMethod::Cpu) {
        refuse(ErrorCode::Unsupported, std::string("the method ") + toString(*question.method) +
                                           " needs a Vulkan device; make the scene with device=");
    }
    if (question.filter.value_or(Filter::Exact) != Filter::Exact || question.overestimate) {
        refuse(ErrorCode::Unsupported, "the host engine has the filter exact alone, and no overestimate; for others "
                                       "make the scene with device=");
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
                                            .mostSteps = distance.mostSteps});
    });
}

template <class Ask>
auto HostSide::asked(const Part& part, double threshold, const LabelData* labels, const View& view,
                     const Ask& ask) const {
    std::vector<cpu::BatchItem> items;
    part.request.forPart(part.first, part.count, [&](const Request::Item& item, std::span<const Mat4> poses) {
        items.push_back({&item.mesh->onHost(), &volume_, &function_, poses, labels});
    });
    return take(ask(cpu::Batch{items, view, threshold}));
}

BatchAnswer HostSide::detect(const Part& part, const Question& question, double threshold, const LabelData* labels) {
    const bool few = question.yesNo && part.count * part.request.mostTriangles() <= kFewTriangles;
    cpu::Detector& detector = detectorFor(question, few ? 1 : threads_);
    return asked(part, threshold, labels, viewOf(question, volume_.grid()),
                 [&](const cpu::Batch& batch) { return detector.detect(batch); });
}

ClearanceAnswer HostSide::measure(const Part& part, const Distance& distance, double threshold) {
    cpu::ClearanceMeter& meter = meterFor(distance);
    return asked(part, threshold, nullptr, {}, [&](const cpu::Batch& batch) { return meter.measure(batch); });
}

LabelClearanceAnswer HostSide::measureLabels(const Part& part, const Distance& distance, double threshold,
                                             const LabelData* labels, const std::vector<std::int32_t>& wanted) {
    cpu::ClearanceMeter& meter = meterFor(distance);
    return asked(part, threshold, labels, {},
                 [&](const cpu::Batch& batch) { return meter.measureLabels(batch, wanted); });
}

BatchAnswer HostSide::within(const Part& part, double margin, double threshold) {
    const cpu::ClearanceDesc usual;
    cpu::ClearanceMeter& meter = meterFor({usual.tolerance, usual.maximum, usual.mostSteps});
    return asked(part, threshold, nullptr, {}, [&](const cpu::Batch& batch) { return meter.within(batch, margin); });
}

} // namespace voxtact::python
