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

/// What a mode does with a mesh, and the steps of it.
struct Part {
    Result<void> (*run)(const BenchRun& run);
    std::uint64_t steps;
};

Part partOf(const BenchSettings& settings) {
    switch (settings.mode) {
    case BenchMode::Certified:
        return {benchPoses, std::uint64_t{2} * settings.repetitions};
    case BenchMode::Outputs:
        return {benchPoses, settings.repetitions};
    case BenchMode::Latency:
        return {benchTicks, std::uint64_t{tickRounds(settings.number)} + 1};
    case BenchMode::Batches:
        break;
    }
    return {benchBatches, batchSizes(settings.number).size()};
}

} // namespace

BenchSettings defaultSettings(BenchMode mode) {
    BenchSettings settings{.mode = mode};
    if (mode == BenchMode::Latency) {
        settings.number = 10000;
    } else if (mode == BenchMode::Batches) {
        settings.number = 100000;
        settings.repetitions = 3;
    }
    return settings;
}

const char* defaultVolume(BenchMode mode) {
    // The large scene is for engines that skip what cannot touch.
    return mode == BenchMode::Outputs ? "builtin:head:128" : "builtin:head:256";
}

std::vector<std::string> defaultMeshes(BenchMode mode) {
    std::vector<std::string> meshes{"builtin:scalpel:3068"};
    if (mode == BenchMode::Certified) {
        meshes.emplace_back("builtin:ellipsoid:49998");
    }
    return meshes;
}

std::size_t BenchRun::addRow(const Engine& engine, const char* poses, std::size_t pairs) const {
    result.rows.push_back({.mesh = work.mesh->name,
                           .triangles = work.mesh->triangles(),
                           .poses = poses,
                           .engine = engine.facts(),
                           .pairs = pairs});
    return result.rows.size() - 1;
}

Result<void> BenchRun::time(std::vector<Timed>& things, Rounds rounds) const {
    rounds.stop = [this] { return !result.disagreement.empty(); };
    const Result<std::uint64_t> taken = takeRounds(things, rounds);
    return taken.ok() ? Result<void>() : taken.error();
}

std::function<Result<bool>(const Mat4& pose)> touchesBy(Engine& engine, const Work& work) {
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
    const Part part = partOf(settings);
    steps.begin(part.steps * meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(makeReady(session, mesh));
        const Result<Engines> engines = makeBenchEngines(settings.mode, volume, mesh, session);
        VOXTACT_TRY(engines);
        VOXTACT_TRY(part.run({.settings = settings,
                              .work = {volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}},
                              .engines = *engines,
                              .limit = settings.timeLimit * 1000 / static_cast<double>(meshes.size()),
                              .step = steps.step,
                              .result = result}));
    }
    return {};
}

} // namespace voxtact::lab
