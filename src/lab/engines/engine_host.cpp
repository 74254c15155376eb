// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "lab/engines/engine.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>

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

} // namespace

MadeEngine makeHostEngine(const cpu::DetectorDesc& desc) {
    Result<cpu::Detector> detector = cpu::Detector::create(desc);
    VOXTACT_TRY(detector);
    EngineFacts facts = factsOf(CountingMethod::Cpu, desc, detector->threads());
    return engineOf(std::move(facts), std::move(*detector), runOnHost);
}

} // namespace voxtact::lab
