// SPDX-License-Identifier: MIT
#include "viewer/frame/device_answers.h"

#include "core/base/try.h"
#include "core/method/method_table.h"

namespace voxtact::view {

const Detector* Detectors::find(const MethodChoice& method) const {
    const std::lock_guard lock(mutex_);
    const auto found = detectors_.find({method.count, method.projection});
    return found == detectors_.end() ? nullptr : &found->second;
}

Result<const Detector*> Detectors::get(const MethodChoice& method) {
    if (const Detector* const found = find(method)) {
        return found;
    }
    const Outputs outputs{.triangles = true, .contacts = true, .labels = labels_};
    Result<Detector> made = rowOf(method.projection).certified
                                ? Detector::certified(*context_, {.outputs = outputs})
                                : Detector::raster(*context_, {.method = method.count,
                                                               .projection = method.projection,
                                                               .filter = defaultFilter(method.count),
                                                               .outputs = outputs});
    VOXTACT_TRY(made);
    const std::lock_guard lock(mutex_);
    return &detectors_.try_emplace(Key(method.count, method.projection), std::move(*made)).first->second;
}

DeviceAnswers::DeviceAnswers(const device::Session& session, const DeviceScene& scene,
                             std::shared_ptr<Detectors> detectors)
    : detectors_(std::move(detectors)) {
    const std::uint64_t labels = scene.labels() == nullptr ? 0 : scene.labels()->values().size();
    desc_.timestamps = session.device.hasTimestamps();
    desc_.queueFamily = session.device.queueAccess().family;
    desc_.maxPairs = scene.meshes();
    desc_.room = {.triangles = scene.triangles(), .labels = labels * scene.meshes()};
}

std::vector<MethodChoice> DeviceAnswers::choices(const Context& context) {
    std::vector<MethodChoice> out;
    for (const ProjectionRow& projection : kProjectionTable) {
        for (const MethodRow& method : kMethodTable) {
            const bool fits = method.certified || !projection.certified;
            if (fits && (method.host || context.supports(method.method, projection.projection))) {
                out.push_back({method.method, projection.projection});
            }
        }
    }
    return out;
}

Result<void> DeviceAnswers::record(VkCommandBuffer commands, const DeviceScene& scene, const LiveQuestion& question,
                                   std::uint32_t slot) {
    const Result<const Detector*> detector = detectors_->get(question.method);
    VOXTACT_TRY(detector);
    const bool certified = rowOf(question.method.projection).certified;
    std::optional<Results>& results = results_[certified ? 1 : 0][slot];
    if (!results) {
        Result<Results> made = Results::create(**detector, desc_);
        VOXTACT_TRY(made);
        results = std::move(*made);
    }
    const AskedPairs pairs = scene.pairs(question.edit);
    VOXTACT_TRY((*detector)->cmdDetect(commands, pairs.batch, *results));
    VOXTACT_TRY(results->cmdReadBack(commands));
    asked_[slot] = Asked{question.revision, question.edit.instruments, certified};
    return {};
}

std::optional<Result<LiveAnswer>> DeviceAnswers::collect(std::uint32_t slot, double wallMilliseconds) {
    if (!asked_[slot]) {
        return std::nullopt;
    }
    const Asked asked = *std::exchange(asked_[slot], std::nullopt);
    Results& results = *results_[asked.certified ? 1 : 0][slot];
    return [&]() -> Result<LiveAnswer> {
        const auto pairs = results.read();
        VOXTACT_TRY(pairs);
        BatchAnswer batch;
        VOXTACT_TRY(results.readOutputs(batch));
        for (const PairResult& pair : *pairs) {
            batch.pairs.push_back(unpack(pair));
        }
        const Result<double> gpu = results.gpuMilliseconds();
        return liveAnswer(std::move(batch), asked.revision, asked.instruments, gpu.ok() ? *gpu : wallMilliseconds);
    }();
}

} // namespace voxtact::view
