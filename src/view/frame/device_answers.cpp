// SPDX-License-Identifier: MIT
#include "view/frame/device_answers.h"

#include "core/base/try.h"
#include "core/method/method_table.h"

namespace voxtact::view {

Result<DeviceAnswers> DeviceAnswers::create(const device::Session& session, const DeviceScene& scene) {
    DeviceAnswers out(session);
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

Result<void> DeviceAnswers::record(VkCommandBuffer commands, DeviceScene& scene, const State& state,
                                   std::uint32_t slot) {
    const MethodChoice& method = state.method;
    const std::pair key(method.count, method.projection);
    auto detector = detectors_.find(key);
    if (detector == detectors_.end()) {
        DetectorDesc desc;
        desc.method = method.count;
        desc.projection = method.projection;
        desc.filter = defaultFilter(method.count);
        desc.outputs = {.triangles = true, .contacts = true, .labels = scene.labels() != nullptr};
        Result<Detector> made = Detector::create(session_->context, desc);
        VOXTACT_TRY(made);
        detector = detectors_.emplace(key, std::move(*made)).first;
    }
    VOXTACT_TRY(detector->second.cmdDetect(commands, scene.batch(state), results_[slot]));
    VOXTACT_TRY(results_[slot].cmdReadBack(commands));
    asked_[slot] = Asked{state.revision, state.document.edit.instruments};
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
