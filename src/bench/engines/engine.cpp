// SPDX-License-Identifier: MIT
#include "bench/engines/engine.h"

#include "bench/measure/stopwatch.h"
#include "core/base/try.h"
#include "device/outputs/output_parts.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

struct HostCount {
    cpu::HostEngine engine;
    Count question;
};

Result<Pass> runOnHost(HostCount& count, const Work& work, const Feeding& feeding) {
    const VolumePart& volume = *work.volume;
    const std::size_t batch = feeding.batch == 0 ? work.poses.size() : feeding.batch;
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    const Stopwatch watch;
    for (std::size_t first = 0; first < work.poses.size(); first += batch) {
        const cpu::BatchItem item{&*work.mesh->host, &*volume.host, &*volume.hostFunction,
                                  work.poses.subspan(first, std::min(batch, work.poses.size() - first)),
                                  volume.labels.values.empty() ? nullptr : &volume.labels};
        Result<BatchAnswer> answer = count.engine.ask(count.question, {{&item, 1}, work.view, volume.threshold});
        VOXTACT_TRY(answer);
        pass.pairs.insert(pass.pairs.end(), answer->pairs.begin(), answer->pairs.end());
        pass.triangles.insert(pass.triangles.end(), answer->triangles.begin(), answer->triangles.end());
    }
    pass.wallMilliseconds = watch.milliseconds();
    return pass;
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

MadeEngine makeHostEngine(const Count& question, std::uint32_t threads) {
    Result<cpu::HostEngine> engine = cpu::HostEngine::create(threads);
    VOXTACT_TRY(engine);
    EngineFacts facts = factsOf(CountingMethod::Cpu, question, engine->threads());
    return engineOf(std::move(facts), HostCount{std::move(*engine), question}, runOnHost);
}

} // namespace voxtact::lab
