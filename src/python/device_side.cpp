// SPDX-License-Identifier: MIT
#include "device_side.h"

#include "failure.h"

#include <algorithm>

namespace voxtact::python {

namespace {

/// Pipelines that are kept for ways of asking; the first in order make room.
constexpr std::size_t kMostDetectors = 8;
/// Of one answer's outputs, so that no device's limit is near.
constexpr std::size_t kOutputBytes = std::size_t{32} << 20U;
constexpr std::size_t kMostPairs = std::size_t{1} << 16U;

CountingMethod methodFor(const Question& question, const Context& context) {
    if (question.method) {
        if (*question.method == CountingMethod::Cpu) {
            refuseArgument("the method cpu is the host engine: make the scene without device=");
        }
        return *question.method;
    }
    if (question.projection == Projection::Conservative) {
        return CountingMethod::Compute;
    }
    return question.yesNo && !question.outputs.any() ? CountingMethod::QueryAny : context.defaultMethod();
}

DetectorDesc descOf(const Question& question, const Context& context) {
    DetectorDesc desc;
    desc.method = methodFor(question, context);
    desc.projection = question.projection;
    desc.filter = question.filter.value_or(defaultFilter(desc.method));
    desc.boundary = question.boundary;
    desc.outputs = question.outputs;
    desc.samplesPerVoxel = question.samplesPerVoxel;
    desc.resolution = question.resolution;
    desc.stopAtFirst = question.yesNo && question.projection == Projection::Conservative;
    desc.overestimate = question.overestimate;
    desc.counters = question.counters;
    desc.margin = question.margin;
    desc.poseTolerance = question.tolerance;
    desc.clearance = question.clearance;
    desc.motion = question.motion;
    desc.closest = question.clearance.has_value() && !question.toLabels;
    desc.labelClearances = question.toLabels;
    desc.labelsAtAnyOpacity = question.labelsAtAnyOpacity;
    return desc;
}

} // namespace

DeviceSide::DeviceSide(std::shared_ptr<Device> device, const VolumeView& volume, const OpacityDesc& opacity,
                       const LabelData* labels)
    : device_(std::move(device)),
      volume_(take(Volume::upload(device_->context(), device_->queue(), volume, {.bricks = true, .editable = true}))),
      function_(take(TransferFunction::upload(device_->context(), device_->queue(), opacity.desc()))) {
    if (labels != nullptr) {
        labels_.emplace(take(LabelMap::upload(device_->context(), device_->queue(), *labels)));
    }
}

void DeviceSide::setOpacity(const OpacityDesc& opacity) {
    function_ = take(TransferFunction::upload(device_->context(), device_->queue(), opacity.desc()));
}

void DeviceSide::edit(const Edit& edit) {
    device_->submit([&](VkCommandBuffer commands) {
        if (const auto* set = std::get_if<SetEdit>(&edit)) {
            return volume_.cmdSet(commands, set->region, set->value);
        }
        const auto& write = std::get<WriteEdit>(edit);
        return volume_.cmdWrite(commands, write.box, write.voxels);
    });
}

BlockingDetector& DeviceSide::detectorFor(const Question& question) {
    const Question::Key key = question.key();
    if (const auto found = detectors_.find(key); found != detectors_.end()) {
        return found->second;
    }
    if (detectors_.size() >= kMostDetectors) {
        detectors_.erase(detectors_.begin());
    }
    BlockingDetector detector = take(BlockingDetector::create(device_->context(), descOf(question, device_->context()),
                                                              device_->queue(), question.mostContacts));
    return detectors_.emplace(key, std::move(detector)).first->second;
}

DeviceSide::Uploaded& DeviceSide::uploaded(const std::shared_ptr<const Shape>& shape) {
    std::erase_if(meshes_, [](const auto& entry) { return entry.second.owner.expired(); });
    Uploaded& one = meshes_[shape.get()];
    one.owner = shape;
    return one;
}

const Mesh& DeviceSide::onDevice(const std::shared_ptr<const Shape>& shape) {
    Uploaded& one = uploaded(shape);
    if (!one.asked) {
        one.asked.emplace(
            take(Mesh::upload(device_->context(), device_->queue(), shape->data().view(), {.clusters = true})));
    }
    return *one.asked;
}

BatchAnswer DeviceSide::detect(const Request& request, std::size_t first, std::size_t count, const Question& question,
                               double threshold, std::span<const std::int32_t> labels) {
    BlockingDetector& detector = detectorFor(question);
    std::vector<BatchItem> items;
    request.forPart(first, count, [&](const Request::Item& item, std::span<const Mat4> poses) {
        items.push_back({&onDevice(item.mesh), &volume_, &function_, poses, labels_ ? &*labels_ : nullptr});
    });
    Result<BatchAnswer> answer = detector.detect({items, viewOf(question, volume_.grid()), threshold, labels});
    if (!answer.ok() && answer.error().code == ErrorCode::LimitExceeded && question.outputs.contacts) {
        answer.error().text += "; ask for fewer by most_contacts, which is " + std::to_string(question.mostContacts);
    }
    return take(std::move(answer));
}

MotionAnswer DeviceSide::move(const Request& request, std::size_t first, std::size_t count, const Question& question,
                              double threshold) {
    BlockingDetector& detector = detectorFor(question);
    std::vector<BatchItem> items;
    request.forSegments(first, count, [&](const Request::Item& item, std::span<const Mat4> poses) {
        items.push_back({&onDevice(item.mesh), &volume_, &function_, poses});
    });
    BatchAnswer answer = take(detector.detect({items, {}, threshold}));
    return {std::move(answer.motions), answer.wallMilliseconds};
}

std::size_t DeviceSide::mostPairs(const Request& request, const Question& question, std::size_t labels) noexcept {
    if (!question.outputs.triangles) {
        return labels == 0 ? kMostPairs
                           : std::clamp<std::size_t>(kOutputBytes / (sizeof(ClearanceResult) * labels), 1, kMostPairs);
    }
    return std::clamp<std::size_t>(kOutputBytes / (sizeof(std::uint32_t) * request.mostTriangles()), 1, kMostPairs);
}

} // namespace voxtact::python
