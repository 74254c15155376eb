// SPDX-License-Identifier: MIT
#include "lab/measure/host_speed.h"

#include "core/base/try.h"
#include "lab/engines/engine.h"
#include "lab/measure/numbers.h"

#include <algorithm>
#include <vector>

namespace voxtact::lab {

namespace {

/// Seconds for all poses, median.
Result<double> medianSeconds(const Engine& host, const MeasureScene& scene, std::uint32_t repetitions) {
    VolumePart volume{.name = {}, .data = scene.volume, .points = scene.points, .domain = scene.domain};
    volume.threshold = scene.threshold;
    MeshPart mesh{.name = {}, .data = scene.mesh};
    VOXTACT_TRY(makeHost(volume));
    VOXTACT_TRY(makeReady(nullptr, mesh));
    const Work work{volume, mesh, scene.world_from_object, scene.view};
    VOXTACT_TRY(host.run(work, {})); // makes the threads and the table of opaque bricks
    std::vector<double> seconds;
    do {
        const Result<Pass> pass = host.run(work, {});
        VOXTACT_TRY(pass);
        seconds.push_back(pass->wallMilliseconds / 1000);
    } while (seconds.size() < repetitions);
    return std::max(medianOf(seconds), 1e-9);
}

} // namespace

MethodSpeed measureHost(const MeasureScene& scene, std::uint32_t repetitions) {
    MethodSpeed speed{{CountingMethod::Cpu, true, false, {}}};
    const MadeEngine host = makeHostEngine();
    const Result<double> seconds = host.ok() ? medianSeconds(*host, scene, repetitions) : host.error();
    if (!seconds.ok()) {
        speed.verdict.text = seconds.error().text;
        return speed;
    }
    const std::uint32_t threads = host->facts.threads;
    speed.verdict.trusted = true;
    speed.verdict.text = "the host, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
    speed.pairsPerSecond = static_cast<double>(scene.world_from_object.size()) / *seconds;
    return speed;
}

} // namespace voxtact::lab
