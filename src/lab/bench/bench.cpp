// SPDX-License-Identifier: MIT
#include "lab/bench/bench.h"

#include "core/base/try.h"
#include "lab/bench/parts.h"

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

/// What is of one mode alone.
struct ModeRow {
    BenchDefaults defaults;
    void (*addEngines)(const BenchParts& parts, EngineList& engines);
    Result<void> (*run)(const BenchRun& run);
    std::uint64_t (*steps)(const BenchSettings& settings); ///< that `run` takes
};

/// In the order of BenchMode.
const ModeRow& rowOf(BenchMode mode) {
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
    return rowOf(mode).defaults;
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
    const Result<std::uint64_t> taken = takeRounds(things, rounds);
    return taken.ok() ? Result<void>() : taken.error();
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
    const ModeRow& mode = rowOf(settings.mode);
    steps.begin(mode.steps(settings) * meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(makeReady(session, mesh));
        EngineList list;
        mode.addEngines({volume, mesh, session}, list);
        const Result<Engines> engines = list.take();
        VOXTACT_TRY(engines);
        VOXTACT_TRY(mode.run({.settings = settings,
                              .work = {volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}},
                              .engines = *engines,
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
