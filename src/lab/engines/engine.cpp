// SPDX-License-Identifier: MIT
#include "lab/engines/engine.h"

#include "core/base/try.h"
#include "detect/outputs/output_parts.h"
#include "lab/measure/numbers.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

Result<Pass> runOnHost(cpu::Detector& detector, const Work& work, const Feeding& feeding) {
    const VolumePart& volume = *work.volume;
    const std::size_t batch = feeding.batch == 0 ? work.poses.size() : feeding.batch;
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    const Stopwatch watch;
    for (std::size_t first = 0; first < work.poses.size(); first += batch) {
        const cpu::BatchItem item{&*work.mesh->host, &*volume.host, &*volume.hostFunction,
                                  work.poses.subspan(first, std::min(batch, work.poses.size() - first)),
                                  volume.labels.values.empty() ? nullptr : &volume.labels};
        Result<BatchAnswer> answer = detector.detect({{&item, 1}, work.view, volume.threshold});
        VOXTACT_TRY(answer);
        pass.pairs.insert(pass.pairs.end(), answer->pairs.begin(), answer->pairs.end());
        pass.triangles.insert(pass.triangles.end(), answer->triangles.begin(), answer->triangles.end());
    }
    pass.wallMilliseconds = watch.milliseconds();
    return pass;
}

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

BatchItem Work::onDevice() const {
    return {&*mesh->device, &*volume->device, &*volume->deviceFunction, poses,
            volume->deviceLabels ? &*volume->deviceLabels : nullptr};
}

std::vector<std::uint64_t> Pass::counts() const {
    std::vector<std::uint64_t> counts;
    std::ranges::transform(pairs, std::back_inserter(counts), &PairAnswer::count);
    return counts;
}

Result<void> add(Engines& engines, MadeEngine engine, std::size_t ratioTo, bool sameCounts) {
    VOXTACT_TRY(engine);
    engine->facts.ratioTo = ratioTo;
    engine->facts.sameCounts = sameCounts;
    engines.push_back(std::move(*engine));
    return {};
}

std::string questionOf(bool yesNo, const Outputs& outputs) {
    const auto asked = [&](const OutputPartRow& part) { return outputs.*part.output; };
    const auto found = std::ranges::find_if(outputParts(), asked);
    return yesNo ? "yes/no" : found == outputParts().end() ? "count" : std::string("count, ") + found->name;
}

MadeEngine makeHostEngine(const cpu::DetectorDesc& desc) {
    Result<cpu::Detector> detector = cpu::Detector::create(desc);
    VOXTACT_TRY(detector);
    EngineFacts facts = factsOf(CountingMethod::Cpu, desc, detector->threads());
    return engineOf(std::move(facts), std::move(*detector), runOnHost);
}

MethodSpeed measureHost(const MeasureScene& scene, std::uint32_t repetitions) {
    MethodSpeed speed{{CountingMethod::Cpu, true, false, {}}};
    const MadeEngine host = makeHostEngine();
    const Result<double> seconds = host.ok() ? medianSeconds(*host, scene, repetitions) : host.error();
    if (!seconds.ok()) {
        speed.verdict.text = seconds.error().text;
        return speed;
    }
    speed.verdict.trusted = true;
    speed.verdict.text = "the host, " + counted(host->facts.threads, "thread");
    speed.pairsPerSecond = static_cast<double>(scene.world_from_object.size()) / *seconds;
    return speed;
}

} // namespace voxtact::lab
