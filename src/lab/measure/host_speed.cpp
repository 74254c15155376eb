// SPDX-License-Identifier: MIT
#include "lab/measure/host_speed.h"

#include "core/try.h"
#include "lab/compare/compare_result.h"
#include "lab/engines/engine.h"

#include <algorithm>
#include <vector>

namespace voxtact::lab {

namespace {

/// Seconds for all poses, median.
Result<double> medianSeconds(Engine& host, const MeasureScene& scene, std::uint32_t repetitions) {
    VolumePart volume{.name = {}, .data = scene.volume, .points = scene.points, .domain = scene.domain};
    volume.threshold = scene.threshold;
    MeshPart mesh{.name = {}, .data = scene.mesh};
    VOXTACT_TRY(makeHost(volume));
    VOXTACT_TRY(makeReady(nullptr, mesh));
    std::vector<double> seconds;
    // The first one, which makes the threads and the table of opaque bricks, does not count.
    for (std::uint32_t i = 0; i <= std::max(repetitions, 1U); ++i) {
        const Result<Pass> pass = host.run({volume, mesh, scene.world_from_object, scene.view}, {});
        VOXTACT_TRY(pass);
        if (i > 0) {
            seconds.push_back(pass->wallMilliseconds / 1000);
        }
    }
    return std::max(spreadOf(std::move(seconds)).median, 1e-9);
}

} // namespace

MethodSpeed measureHost(const MeasureScene& scene, std::uint32_t repetitions) {
    MethodSpeed speed{{CountingMethod::Cpu, true, false, {}}};
    const MadeEngine host = makeHostEngine();
    if (!host.ok()) {
        speed.verdict.text = host.error().text;
        return speed;
    }
    const Result<double> seconds = medianSeconds(**host, scene, repetitions);
    if (!seconds.ok()) {
        speed.verdict.text = seconds.error().text;
        return speed;
    }
    const std::uint32_t threads = (*host)->facts().threads;
    speed.verdict.trusted = true;
    speed.verdict.text = "the host, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
    speed.pairsPerSecond = static_cast<double>(scene.world_from_object.size()) / *seconds;
    return speed;
}

} // namespace voxtact::lab
