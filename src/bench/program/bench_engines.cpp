// SPDX-License-Identifier: MIT
#include "bench/program/bench.h"
#include "bench/program/lab_run.h"
#include "cli/options/inputs.h"
#include "core/base/try.h"

namespace voxtact::app {

using namespace lab;

namespace {

Result<VolumePart> loadBenchVolume(const BenchOptions& options, const std::string& source) {
    TransferFunctionOptions wanted = options.transferFunction;
    if (options.volumes.empty() && wanted.path.empty() && !wanted.opacity) {
        wanted.opacity = kDefaultOpacity;
    }
    Result<VolumePart> volume = loadVolumePart(source, wanted);
    VOXTACT_TRY(volume);
    VOXTACT_TRY(makeHost(*volume));
    return volume;
}

Result<std::vector<MeshPart>> loadBenchMeshes(const BenchOptions& options) {
    std::vector<MeshPart> meshes;
    for (const std::string& source :
         options.meshes.sources.empty() ? defaultsOf(options.settings.mode).meshes : options.meshes.sources) {
        Result<MeshPart> mesh = loadMeshPart(source, options.meshes);
        VOXTACT_TRY(mesh);
        meshes.push_back(std::move(*mesh));
    }
    return meshes;
}

/// Opens the device's session; empty, with a note, if there is no device and none was requested.
Result<std::optional<device::Session>> openBenchSession(const BenchOptions& options, BenchResult& result) {
    Result<device::Session> session = openSession(options.device);
    if (session.ok()) {
        return std::optional(std::move(*session));
    }
    if (!options.device.wanted.empty() || options.device.validate) {
        return session.error();
    }
    result.notes.push_back("no device: " + session.error().text);
    return std::optional<device::Session>();
}

/// Measures on the scene that the options name.
Result<void> measure(const BenchOptions& options, const CLI::App& parser, const device::Session* session,
                     BenchResult& result) {
    Result<VolumePart> volume = loadBenchVolume(options, result.volume);
    VOXTACT_TRY(volume);
    result.voxels = volume->data.grid.size;
    result.threshold = volume->threshold;
    result.opacity = opacityText(volume->points);
    result.domain = volume->domain;
    result.tableSize = volume->tableSize;
    const Provenance provenance = provenanceOf(parser);
    result.machine =
        session == nullptr ? describeHost(provenance) : describeMachine(*session, volume->data.type, provenance);
    Result<std::vector<MeshPart>> meshes = loadBenchMeshes(options);
    VOXTACT_TRY(meshes);
    ShownSteps shown(options.progress, "voxtact bench");
    return bench(options.settings, session, *volume, std::move(*meshes), shown.steps(), result);
}

} // namespace

Outcome runBenchEngines(const BenchOptions& options, const CLI::App& parser) {
    if (options.volumes.size() > 1) {
        return badArgument("--volume: a benchmark needs only one; leave out the others");
    }
    if (const Result<void> writable =
            checkOutputs({{"--output", options.output.path}},
                         inputPaths(options.volumes, options.meshes, options.transferFunction, {}));
        !writable.ok()) {
        return writable.error();
    }
    BenchResult result;
    result.volume = options.volumes.empty() ? defaultsOf(options.settings.mode).volume : options.volumes.front();
    std::shared_ptr<const device::ValidationMessages> messages;
    {
        const Result<std::optional<device::Session>> session = openBenchSession(options, result);
        VOXTACT_TRY(session);
        messages = session->has_value() ? (**session).instance.messages() : nullptr;
        VOXTACT_TRY(measure(options, parser, session->has_value() ? &**session : nullptr, result));
    }
    if (messages != nullptr) {
        if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
            return invalid;
        }
    }
    Outcome outcome;
    if (!result.disagreement.empty()) {
        outcome = {kExitVerify, "engines disagree: " + result.disagreement};
        if (options.mode == BenchMode::Certified || options.mode == BenchMode::Outputs) {
            return outcome;
        }
        // Writes earlier results.
        result.notes.push_back(outcome.text);
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeBench(out, options.output.format(), options.settings, result);
        return {};
    });
    return written.ok() ? outcome : Outcome(written.error());
}

} // namespace voxtact::app
