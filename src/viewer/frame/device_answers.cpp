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
    DetectorDesc desc;
    desc.method = method.count;
    desc.projection = method.projection;
    desc.filter = defaultFilter(method.count);
    desc.outputs = {.triangles = true, .contacts = true, .labels = labels_};
    Result<Detector> made = Detector::create(*context_, desc); // owners of a detector do not wait
    VOXTACT_TRY(made);
    const std::lock_guard lock(mutex_);
    return &detectors_.try_emplace(Key(method.count, method.projection), std::move(*made)).first->second;
}

Result<DeviceAnswers> DeviceAnswers::create(const device::Session& session, const DeviceScene& scene,
                                            std::shared_ptr<Detectors> detectors) {
    DeviceAnswers out(std::move(detectors));
    ResultsDesc desc;
    desc.timestamps = session.device.hasTimestamps();
    desc.queueFamily = session.device.queueAccess().family;
    desc.maxPairs = scene.meshes();
    const std::uint64_t labels = scene.labels() == nullptr ? 0 : scene.labels()->values().size();
    desc.room = OutputRoom{.triangles = scene.triangles(), .labels = labels * scene.meshes()};
    for (std::uint32_t slot = 0; slot < kFramesInFlight; ++slot) {
        Result<Results> results = Results::create(session.context, desc);
        VOXTACT_TRY(results);
        out.results_.push_back(std::move(*results));
    }
    return out;
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
    const AskedPairs pairs = scene.pairs(question.edit);
    VOXTACT_TRY((*detector)->cmdDetect(commands, pairs.batch, results_[slot]));
    VOXTACT_TRY(results_[slot].cmdReadBack(commands));
    asked_[slot] = Asked{question.revision, question.edit.instruments};
    return {};
}

std::optional<Result<LiveAnswer>> DeviceAnswers::collect(std::uint32_t slot, double wallMilliseconds) {
    if (!asked_[slot]) {
        return std::nullopt;
    }
    const Asked asked = *std::exchange(asked_[slot], std::nullopt);
    return [&]() -> Result<LiveAnswer> {
        const auto pairs = results_[slot].read();
        VOXTACT_TRY(pairs);
        BatchAnswer batch;
        VOXTACT_TRY(results_[slot].readOutputs(batch));
        for (const PairResult& pair : *pairs) {
            batch.pairs.push_back(unpack(pair));
        }
        const Result<double> gpu = results_[slot].gpuMilliseconds();
        return liveAnswer(std::move(batch), asked.revision, asked.instruments, gpu.ok() ? *gpu : wallMilliseconds);
    }();
}

} // namespace voxtact::view
