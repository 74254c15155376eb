// SPDX-License-Identifier: MIT
#include "lab/host_speed.h"

#include "voxtact/cpu.h"

#include <algorithm>
#include <vector>

namespace voxtact::app {

namespace {

struct HostScene {
    cpu::Volume volume;
    cpu::Mesh mesh;
    cpu::TransferFunction transferFunction;
};

Result<HostScene> makeHostScene(const MeasureScene& scene) {
    Result<cpu::Volume> volume = cpu::Volume::create(scene.volume.view());
    if (!volume.ok()) {
        return volume.error();
    }
    Result<cpu::Mesh> mesh = cpu::Mesh::create(scene.mesh.view());
    if (!mesh.ok()) {
        return mesh.error();
    }
    Result<cpu::TransferFunction> function =
        cpu::TransferFunction::create({.points = scene.points, .domain = scene.domain});
    if (!function.ok()) {
        return function.error();
    }
    return HostScene{std::move(*volume), std::move(*mesh), std::move(*function)};
}

/// Seconds for all poses, median.
Result<double> medianSeconds(cpu::Detector& detector, const MeasureScene& scene, std::uint32_t repetitions) {
    const Result<HostScene> host = makeHostScene(scene);
    if (!host.ok()) {
        return host.error();
    }
    const cpu::BatchItem item{&host->mesh, &host->volume, &host->transferFunction, scene.world_from_object};
    const cpu::Batch batch{{&item, 1}, scene.view, scene.threshold};
    std::vector<double> seconds;
    // The first one, which makes the threads and the table of opaque bricks, does not count.
    for (std::uint32_t i = 0; i <= std::max(repetitions, 1U); ++i) {
        const Result<BatchAnswer> answer = detector.detect(batch);
        if (!answer.ok()) {
            return answer.error();
        }
        if (i > 0) {
            seconds.push_back(answer->wallMilliseconds / 1000);
        }
    }
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return std::max(*middle, 1e-9);
}

} // namespace

MethodSpeed measureHost(const MeasureScene& scene, std::uint32_t repetitions) {
    MethodSpeed speed{{CountingMethod::Cpu, true, false, {}}};
    Result<cpu::Detector> detector = cpu::Detector::create();
    if (!detector.ok()) {
        speed.verdict.text = detector.error().text;
        return speed;
    }
    const Result<double> seconds = medianSeconds(*detector, scene, repetitions);
    if (!seconds.ok()) {
        speed.verdict.text = seconds.error().text;
        return speed;
    }
    const std::uint32_t threads = detector->threads();
    speed.verdict.trusted = true;
    speed.verdict.text = "the host, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
    speed.pairsPerSecond = static_cast<double>(scene.world_from_object.size()) / *seconds;
    return speed;
}

} // namespace voxtact::app
