// SPDX-License-Identifier: MIT
#include "bench/engine_bench/bench.h"

#include "bench/engine_bench/parts.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "device/detector/pass_desc.h"
#include "device/outputs/output_parts.h"

#include <algorithm>
#include <array>
#include <thread>

namespace voxtact::lab {

namespace {

/// A label for each octant.
LabelData octants(const Grid& grid) {
    LabelData labels{grid, {}, {0, 1, 2, 3, 4, 5, 6, 7}};
    labels.indices.reserve(voxelCount(grid));
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const int octant =
                    (2 * x >= grid.size[0] ? 1 : 0) + (2 * y >= grid.size[1] ? 2 : 0) + (2 * z >= grid.size[2] ? 4 : 0);
                labels.indices.push_back(static_cast<std::uint16_t>(octant));
            }
        }
    }
    return labels;
}

/// Inputs of the engines of a mode, ready for use; they outlive the engines. `session`: null without a device.
struct BenchParts {
    const VolumePart& volume;
    const MeshPart& mesh;
    const device::Session* session;
};

/// Each output by itself.
std::vector<Outputs> oneOutput() {
    std::vector<Outputs> all;
    for (const OutputPartRow& part : outputParts()) {
        if (part.name != nullptr) {
            all.emplace_back().*part.output = true;
        }
    }
    return all;
}

/// The certified yes or no, the certified count, and the count in the view.
std::array<Count, 3> askedOfHost() {
    return {Count{.projection = Projection::Certified, .stopAtFirst = true}, Count{.projection = Projection::Certified},
            Count{}};
}

DetectorDesc methodOf(CountingMethod method, Projection projection = Projection::View, const Outputs& outputs = {}) {
    if (rowOf(projection).certified) {
        return CertifiedDesc{.outputs = outputs};
    }
    return RasterDesc{.method = method, .projection = projection, .filter = defaultFilter(method), .outputs = outputs};
}

/// Like askedOfHost().
std::array<DetectorDesc, 3> askedOf(CountingMethod method) {
    return {CertifiedDesc{.stopAtFirst = true}, CertifiedDesc{}, methodOf(method)};
}

DetectorDesc withDevicePoses(DetectorDesc desc) {
    std::visit([](auto& of) { of.devicePoses = true; }, desc);
    return desc;
}

bool can(const device::Session* session, CountingMethod method, Projection projection) {
    return session != nullptr && session->context.supports(method, projection);
}

bool can(const device::Session* session, const DetectorDesc& desc) {
    const PassDesc pass = passDesc(desc);
    return can(session, pass.method, pass.projection);
}

/// Projections of the host, and then outputs in two of them.
Result<void> addHostOutputs(Engines& engines) {
    constexpr std::array kOrder{Projection::View, Projection::Certified, Projection::TwoView, Projection::DominantAxis};
    for (const Projection projection : kOrder) {
        VOXTACT_TRY(add(engines, makeHostEngine({.projection = projection})));
    }
    for (const std::size_t bare : {std::size_t{0}, std::size_t{1}}) {
        for (const Outputs& outputs : oneOutput()) {
            VOXTACT_TRY(add(engines, makeHostEngine({.projection = kOrder.at(bare), .outputs = outputs}), bare, true));
        }
    }
    return {};
}

/// Projections of a method of the device, and then the outputs in one of them.
Result<void> addDeviceOutputs(const device::Session& session, CountingMethod method, Projection withOutputs,
                              Engines& engines) {
    const std::size_t view = engines.size();
    std::size_t bare = view;
    for (const Projection projection : projections()) {
        if (can(&session, method, projection)) {
            bare = projection == withOutputs ? engines.size() : bare;
            VOXTACT_TRY(add(engines, makeBlockingEngine(session, methodOf(method, projection)), view));
        }
    }
    for (const Outputs& outputs : oneOutput()) {
        VOXTACT_TRY(add(engines, makeBlockingEngine(session, methodOf(method, withOutputs, outputs)), bare, true));
    }
    return {};
}

/// A method of the device, polled and waited for; empty: an empty submission.
Result<void> addTicks(const device::Session& session, const std::optional<DetectorDesc>& desc, Engines& engines) {
    for (const Awaiting awaiting : {Awaiting::Poll, Awaiting::Wait}) {
        VOXTACT_TRY(add(engines, makeTickEngine(session, desc, awaiting)));
    }
    return {};
}

Result<void> addDeviceTicks(const device::Session& session, Engines& engines) {
    for (const CountingMethod method : countingMethods()) {
        for (const DetectorDesc& desc : askedOf(method)) {
            if (rowOf(method).host || !can(&session, method, passDesc(desc).projection)) {
                continue;
            }
            VOXTACT_TRY(addTicks(session, desc, engines));
            if (rowOf(method).coverage == Coverage::Computed) {
                VOXTACT_TRY(addTicks(session, withDevicePoses(desc), engines));
            }
        }
    }
    return {};
}

/// The first is the host's yes or no on one thread, the second the host's count.
Result<void> addCertified(const BenchParts& parts, Engines& engines) {
    const auto host = askedOfHost();
    VOXTACT_TRY(add(engines, makeHostEngine(host[0], 1)));
    for (const Count& question : {host[1], host[0], host[2]}) {
        VOXTACT_TRY(add(engines, makeHostEngine(question)));
    }
    const auto computed = askedOf(CountingMethod::Compute);
    for (const DetectorDesc& desc : {computed[0], computed[1], methodOf(CountingMethod::Query)}) {
        if (can(parts.session, desc)) {
            VOXTACT_TRY(add(engines, makeBlockingEngine(*parts.session, desc)));
        }
    }
    for (const FclScalar scalar : {FclScalar::Float, FclScalar::Double}) {
        if (parts.volume.fcl != nullptr) {
            VOXTACT_TRY(add(engines, makeFclEngine(parts.volume, parts.mesh, scalar)));
        }
    }
    return {};
}

/// The first is the host's count in the view, the second the host's in the projection certified.
Result<void> addOutputs(const BenchParts& parts, Engines& engines) {
    VOXTACT_TRY(addHostOutputs(engines));
    constexpr std::pair<CountingMethod, Projection> kOfDevice[] = {
        {CountingMethod::Query, Projection::View},
        {CountingMethod::Atomic, Projection::View},
        {CountingMethod::Compute, Projection::Certified},
    };
    for (const auto& [method, withOutputs] : kOfDevice) {
        if (can(parts.session, method, withOutputs)) {
            VOXTACT_TRY(addDeviceOutputs(*parts.session, method, withOutputs, engines));
        }
    }
    return {};
}

/// An empty submission, the host, and every method of the device, polled and waited for.
Result<void> addLatency(const BenchParts& parts, Engines& engines) {
    if (parts.session != nullptr) {
        VOXTACT_TRY(addTicks(*parts.session, std::nullopt, engines));
    }
    const std::uint32_t threads = std::max(1U, std::thread::hardware_concurrency());
    for (const Count& question : askedOfHost()) {
        VOXTACT_TRY(add(engines, makeHostEngine(question, 1)));
        if (threads > 1) {
            VOXTACT_TRY(add(engines, makeHostEngine(question, threads)));
        }
    }
    if (parts.session != nullptr) {
        VOXTACT_TRY(addDeviceTicks(*parts.session, engines));
    }
    return {};
}

/// The first is the host's certified yes or no, the second its count in the view.
Result<void> addBatches(const BenchParts& parts, Engines& engines) {
    const auto host = askedOfHost();
    VOXTACT_TRY(add(engines, makeHostEngine(host[0])));
    VOXTACT_TRY(add(engines, makeHostEngine(host[2])));
    const auto computed = askedOf(CountingMethod::Compute);
    for (const DetectorDesc& desc :
         {computed[0], computed[2], methodOf(CountingMethod::Query), methodOf(CountingMethod::Atomic)}) {
        if (can(parts.session, desc)) {
            VOXTACT_TRY(add(engines, makeDeviceEngine(*parts.session, desc)));
        }
    }
    for (const DetectorDesc& desc : {computed[0], computed[2]}) {
        if (can(parts.session, desc)) {
            VOXTACT_TRY(add(engines, makeBlockingEngine(*parts.session, withDevicePoses(desc))));
        }
    }
    return {};
}

/// Properties of one mode.
struct ModeRow {
    BenchDefaults defaults;
    Result<void> (*addEngines)(const BenchParts& parts, Engines& engines);
    Result<void> (*run)(const BenchRun& run);
    std::uint64_t (*steps)(const BenchSettings& settings); ///< that `run` takes
};

/// In the order of BenchMode.
const ModeRow& modeOf(BenchMode mode) {
    static const std::array<ModeRow, 4> kRows{{
        {{.meshes = {"builtin:scalpel:3068", "builtin:ellipsoid:49998"}},
         addCertified,
         benchPoses,
         [](const BenchSettings& settings) { return std::uint64_t{2} * settings.repetitions; }},
        {{.volume = "builtin:head:128"},
         addOutputs,
         benchPoses,
         [](const BenchSettings& settings) { return std::uint64_t{settings.repetitions}; }},
        {{.number = 10000},
         addLatency,
         benchTicks,
         [](const BenchSettings& settings) { return std::uint64_t{tickRounds(settings.number)} + 1; }},
        {{.number = 100000, .repetitions = 3},
         addBatches,
         benchBatches,
         [](const BenchSettings& settings) { return std::uint64_t{batchSizes(settings.number).size()}; }},
    }};
    return kRows.at(static_cast<std::size_t>(mode));
}

} // namespace

BenchDefaults defaultsOf(BenchMode mode) {
    return modeOf(mode).defaults;
}

std::size_t BenchRun::addRow(const Engine& engine, const char* poses, std::size_t pairs) const {
    result.rows.push_back({.mesh = work.mesh->name,
                           .triangles = work.mesh->triangles(),
                           .poses = poses,
                           .engine = engine.facts,
                           .pairs = pairs});
    return result.rows.size() - 1;
}

Result<void> BenchRun::time(std::vector<Timed>& things, Rounds rounds) const {
    rounds.stop = [this] { return !result.disagreement.empty(); };
    VOXTACT_TRY(takeRounds(things, rounds));
    return {};
}

std::function<Result<bool>(const Mat4& pose)> touchesBy(const Engine& engine, const Work& work) {
    return [&engine, work](const Mat4& pose) -> Result<bool> {
        const Result<Pass> pass = engine.run(work.at({&pose, 1}), {});
        return pass.ok() ? Result<bool>(pass->pairs.front().hit) : Result<bool>(pass.error());
    };
}

Result<void> bench(const BenchSettings& settings, const device::Session* session, VolumePart& volume,
                   std::vector<MeshPart> meshes, const Steps& steps, BenchResult& result) {
    if (settings.mode == BenchMode::Outputs) {
        volume.labels = octants(volume.data.grid);
    }
    if (session != nullptr) {
        VOXTACT_TRY(upload(*session, {.bricks = true}, volume));
    }
    if (settings.mode == BenchMode::Certified) {
        result.notes.push_back(makeOctree(volume));
    }
    const ModeRow& mode = modeOf(settings.mode);
    steps.begin(mode.steps(settings) * meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(makeReady(session, mesh));
        Engines engines;
        VOXTACT_TRY(mode.addEngines({volume, mesh, session}, engines));
        VOXTACT_TRY(mode.run({.settings = settings,
                              .work = {volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}},
                              .engines = engines,
                              .limit = settings.timeLimit * 1000 / static_cast<double>(meshes.size()),
                              .step = steps.step,
                              .result = result}));
    }
    if (session != nullptr) {
        noteMissedTimes(*session, result.notes);
    }
    return {};
}

} // namespace voxtact::lab
