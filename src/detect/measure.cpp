// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "voxtact/detector.h"

#include <algorithm>
#include <chrono>

namespace voxtact {

namespace {

using Clock = std::chrono::steady_clock;

/// After so long no further repetition begins.
constexpr std::chrono::milliseconds kBudget{150};

/// The scene on the device.
struct DeviceScene {
    Volume volume;
    Mesh mesh;
    TransferFunction transferFunction;
};

Result<DeviceScene> uploadScene(const Context& context, const QueueAccess& queue, const MeasureScene& scene) {
    Result<Volume> volume = Volume::upload(context, queue, scene.volume.view(), {.name = "measured volume"});
    VOXTACT_TRY(volume);
    Result<Mesh> mesh = Mesh::upload(context, queue, scene.mesh.view(), {.name = "measured mesh"});
    VOXTACT_TRY(mesh);
    Result<TransferFunction> function = TransferFunction::upload(
        context, queue, {.points = scene.points, .domain = scene.domain}, "measured transfer function");
    VOXTACT_TRY(function);
    return DeviceScene{std::move(*volume), std::move(*mesh), std::move(*function)};
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Result<double> pairsPerSecond(BlockingDetector& detector, const MeasureScene& scene, const DeviceScene& onDevice,
                              std::uint32_t repetitions) {
    BatchItem item{&onDevice.mesh, &onDevice.volume, &onDevice.transferFunction,
                   std::span(scene.world_from_object).first(1)};
    const Batch batch{{&item, 1}, scene.view, scene.threshold};
    // One pair to begin with: drivers put off some of the compiling until a pipeline is used.
    VOXTACT_TRY(detector.detect(batch));
    item.world_from_object = scene.world_from_object;
    const auto begun = Clock::now();
    std::vector<double> seconds;
    for (std::uint32_t i = 0; i < std::max(repetitions, 1U) && (i == 0 || Clock::now() - begun < kBudget); ++i) {
        const Result<BatchAnswer> answer = detector.detect(batch);
        VOXTACT_TRY(answer);
        seconds.push_back(answer->wallMilliseconds / 1000);
    }
    return static_cast<double>(scene.world_from_object.size()) / std::max(median(std::move(seconds)), 1e-9);
}

Result<double> measure(const Context& context, const QueueAccess& queue, const MeasureDesc& desc,
                       const MeasureScene& scene, const DeviceScene& onDevice, CountingMethod method) {
    Result<BlockingDetector> detector = BlockingDetector::create(
        context, {.method = method, .filter = desc.filter.value_or(defaultFilter(method))}, queue);
    VOXTACT_TRY(detector);
    return pairsPerSecond(*detector, scene, onDevice, desc.repetitions);
}

Result<std::vector<MethodSpeed>> measureOn(const Context& context, const QueueAccess& queue, const MeasureDesc& desc,
                                           const MeasureScene& scene) {
    if (scene.world_from_object.empty()) {
        return refuse("MeasureDesc::scene has no pose");
    }
    Result<std::vector<SelfTestVerdict>> verdicts = selfTest(context, queue, desc.methods);
    VOXTACT_TRY(verdicts);
    const Result<DeviceScene> onDevice = uploadScene(context, queue, scene);
    VOXTACT_TRY(onDevice);
    std::vector<MethodSpeed> speeds;
    for (SelfTestVerdict& verdict : *verdicts) {
        MethodSpeed speed{std::move(verdict)};
        if (speed.verdict.trusted) {
            const Result<double> rate = measure(context, queue, desc, scene, *onDevice, speed.verdict.method);
            if (!rate.ok() && rate.error().code == ErrorCode::DeviceLost) {
                return rate.error();
            }
            speed.pairsPerSecond = rate.ok() ? *rate : 0;
            if (!rate.ok()) {
                speed.verdict.trusted = false;
                speed.verdict.text = rate.error().text;
            }
        }
        speeds.push_back(std::move(speed));
    }
    return speeds;
}

} // namespace

Result<std::vector<MethodSpeed>> measureMethods(const Context& context, const QueueAccess& queue,
                                                const MeasureDesc& desc) {
    return guard([&]() -> Result<std::vector<MethodSpeed>> {
        VOXTACT_TRY(checkFilter(desc.filter.value_or(Filter::Exact)));
        if (desc.scene == nullptr) {
            return refuse("MeasureDesc::scene is null; makeMeasureScene() gives one");
        }
        return measureOn(context, queue, desc, *desc.scene);
    });
}

} // namespace voxtact
