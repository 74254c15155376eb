// SPDX-License-Identifier: MIT
#include "app/bench/bench.h"
#include "app/options/inputs.h"
#include "app/options/lab_run.h"
#include "core/base/try.h"

namespace voxtact::app {

using namespace lab;

namespace {

Result<VolumePart> loadBenchVolume(const BenchOptions& options, const std::string& source) {
    Result<VolumeData> data = loadVolume(source);
    VOXTACT_TRY(data);
    const Result<ValueRange> range = checkVolume(data->view());
    VOXTACT_TRY(range);
    TransferFunctionOptions wanted = options.transferFunction;
    if (options.volumes.empty() && wanted.path.empty() && !wanted.opacity) {
        wanted.opacity = kDefaultOpacity;
    }
    Result<std::vector<ControlPoint>> points = loadControlPoints(wanted);
    VOXTACT_TRY(points);
    VolumePart volume;
    volume.name = source;
    volume.domain = tableDomain(wanted, data->type, *range);
    volume.points = points->empty() ? defaultRamp(volume.domain) : std::move(*points);
    volume.tableSize = wanted.tableSize;
    volume.threshold = wanted.threshold;
    volume.data = std::move(*data);
    VOXTACT_TRY(makeHost(volume));
    return volume;
}

Result<std::vector<MeshPart>> loadBenchMeshes(const BenchOptions& options) {
    std::vector<MeshPart> meshes;
    for (const std::string& source :
         options.meshes.sources.empty() ? defaultMeshes(options.settings.mode) : options.meshes.sources) {
        Result<MeshData> mesh = loadMesh(source, options.meshes);
        VOXTACT_TRY(mesh);
        meshes.push_back({.name = source, .data = std::move(*mesh)});
    }
    return meshes;
}

/// The device's session; none, with a note, where there is no device and none was asked for.
Result<std::optional<device::Session>> openBenchSession(const BenchOptions& options, BenchScene& scene) {
    Result<device::Session> session = openSession(options.device);
    if (session.ok()) {
        return std::optional(std::move(*session));
    }
    if (!options.device.wanted.empty() || options.device.validate) {
        return session.error();
    }
    scene.notes.push_back("no device: " + session.error().text);
    return std::optional<device::Session>();
}

/// Measures something of engines on the scene that the options name. `session` may be null.
using Measure = std::function<Result<void>(const device::Session* session, VolumePart& volume,
                                           std::vector<MeshPart> meshes, const Steps& steps)>;
using Write = std::function<void(std::ostream& out)>;

/// `keepsRest`: what was measured before a disagreement is written, with a note that says so.
Outcome runOnScene(const BenchOptions& options, const CLI::App& parser, BenchScene& scene, bool keepsRest,
                   const Measure& measure, const Write& write) {
    if (options.volumes.size() > 1) {
        return badArgument("one --volume is enough, not several");
    }
    if (const Result<void> writable =
            checkOutputs({{"--output", options.output.path}},
                         inputPaths(options.volumes, options.meshes, options.transferFunction, {}));
        !writable.ok()) {
        return writable.error();
    }
    scene.volume = options.volumes.empty() ? defaultVolume(options.settings.mode) : options.volumes.front();
    std::shared_ptr<const device::ValidationMessages> messages;
    {
        const Result<std::optional<device::Session>> opened = openBenchSession(options, scene);
        VOXTACT_TRY(opened);
        const device::Session* session = opened->has_value() ? &**opened : nullptr;
        // What is on the device must end before the session.
        Result<VolumePart> volume = loadBenchVolume(options, scene.volume);
        VOXTACT_TRY(volume);
        scene.voxels = volume->data.grid.size;
        scene.threshold = volume->threshold;
        const Provenance provenance = provenanceOf(parser);
        scene.machine =
            session == nullptr ? describeHost(provenance) : describeMachine(*session, volume->data.type, provenance);
        Result<std::vector<MeshPart>> meshes = loadBenchMeshes(options);
        VOXTACT_TRY(meshes);
        if (session != nullptr) {
            messages = session->instance.messages();
        }
        ShownSteps shown(options.progress, "voxtact bench");
        VOXTACT_TRY(measure(session, *volume, std::move(*meshes), shown.steps()));
    }
    if (messages != nullptr) {
        if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
            return invalid;
        }
    }
    const std::string wrong =
        scene.disagreement.empty() ? std::string() : "engines that must agree do not: " + scene.disagreement;
    if (!wrong.empty()) {
        if (!keepsRest) {
            return {kExitVerify, wrong};
        }
        scene.notes.push_back(wrong);
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        write(out);
        return {};
    });
    VOXTACT_TRY(written);
    return wrong.empty() ? Outcome() : Outcome{kExitVerify, wrong};
}

} // namespace

Outcome runBenchEngines(const BenchOptions& options, const CLI::App& parser) {
    BenchResult result;
    return runOnScene(
        options, parser, result, false,
        [&](const device::Session* session, VolumePart& volume, std::vector<MeshPart> meshes, const Steps& steps) {
            return bench(options.settings, session, volume, std::move(meshes), steps, result);
        },
        [&](std::ostream& out) { writeBench(out, options.output.format(), options.settings, result); });
}

Outcome runLatency(const BenchOptions& options, const CLI::App& parser) {
    LatencyResult result;
    const LatencySettings& settings = options.latencySettings;
    return runOnScene(
        options, parser, result, true,
        [&](const device::Session* session, VolumePart& volume, std::vector<MeshPart> meshes, const Steps& steps) {
            return measureLatency(settings, session, volume, std::move(meshes), steps, result);
        },
        [&](std::ostream& out) { writeLatency(out, options.output.format(), settings, result); });
}

Outcome runBatches(const BenchOptions& options, const CLI::App& parser) {
    BatchesResult result;
    const BatchesSettings& settings = options.batchesSettings;
    return runOnScene(
        options, parser, result, true,
        [&](const device::Session* session, VolumePart& volume, std::vector<MeshPart> meshes, const Steps& steps) {
            return measureBatches(settings, session, volume, std::move(meshes), steps, result);
        },
        [&](std::ostream& out) { writeBatches(out, options.output.format(), settings, result); });
}

} // namespace voxtact::app
