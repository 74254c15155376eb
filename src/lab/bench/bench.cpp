// SPDX-License-Identifier: MIT
#include "lab/bench/bench.h"

#include "core/base/try.h"
#include "lab/measure/random_poses.h"
#include "lab/measure/rounds.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace voxtact::lab {

namespace {

constexpr std::array<const char*, 2> kMeshes{"builtin:scalpel:3068", "builtin:ellipsoid:49998"};
constexpr std::size_t kCounting = 1; ///< the engine that the others are held against: it knows what is possible
/// Seconds of a sample: repeated up to the one, cut beyond the other.
constexpr double kShortest = 0.03;
constexpr double kLongest = 1.0;
constexpr std::size_t kFewestPoses = 8;

/// A set of poses with its engines, ready to be timed.
struct Case {
    const Engines* engines = nullptr;
    Work work;
    std::vector<Mat4> poses;
    std::vector<std::size_t> passes; ///< of a sample, by engine
    std::vector<std::size_t> some;   ///< poses of a pass, by engine
    std::size_t firstRow = 0;
};

/// Seconds.
struct Times {
    double wall = 0;
    double cpu = 0;
};

template <class Job> Result<Times> timed(Job&& job) {
    const std::clock_t cpu = std::clock();
    const Stopwatch wall;
    VOXTACT_TRY(job());
    // A tick at least, so that no rate is infinite.
    return Times{std::max(wall.milliseconds() / 1000, 1e-9),
                 static_cast<double>(std::max<std::clock_t>(std::clock() - cpu, 1)) / CLOCKS_PER_SEC};
}

Result<std::vector<Mat4>> makePoses(const std::string& kind, const BenchSettings& settings, const Work& work,
                                    Engine& yesNo) {
    const Grid& grid = work.volume->data.grid;
    const MeshView mesh = work.mesh->data.view();
    if (kind == "large") {
        return randomPoses(grid, mesh, settings.poses, settings.seed);
    }
    return onsetPoses(grid, mesh, settings.poses, settings.seed, [&](const Mat4& pose) -> Result<bool> {
        const Result<Pass> pass = yesNo.run(work.at({&pose, 1}), {});
        return pass.ok() ? Result<bool>(pass->pairs.front().hit) : Result<bool>(pass.error());
    });
}

/// Says where an engine does not count as the one that it must count as.
std::string compareCounts(std::span<const PairAnswer> bare, std::span<const PairAnswer> answers, const BenchRow& row) {
    for (std::size_t i = 0; i < bare.size(); ++i) {
        if (bare[i].count != answers[i].count) {
            return row.mesh + ", poses " + row.poses + ", pose " + std::to_string(i) + ": " + row.engine.name + " " +
                   row.engine.projection + " " + row.engine.question + " counts " + std::to_string(answers[i].count) +
                   ", without the output it is " + std::to_string(bare[i].count);
        }
    }
    return {};
}

/// Runs every engine once: its answers are judged, and say how long a sample is.
Result<void> verifyCase(Case& one, const std::string& kind, BenchResult& result) {
    const Result<Pass> certified = (*one.engines)[kCounting]->run(one.work, {});
    VOXTACT_TRY(certified);
    one.firstRow = result.rows.size();
    std::vector<std::vector<PairAnswer>> all;
    for (const std::unique_ptr<Engine>& engine : *one.engines) {
        std::vector<PairAnswer> answers;
        const Result<Times> took = timed([&]() -> Result<void> {
            Result<Pass> pass = engine->run(one.work, {});
            VOXTACT_TRY(pass);
            answers = std::move(pass->pairs);
            return {};
        });
        VOXTACT_TRY(took);
        BenchRow row{.mesh = one.work.mesh->name,
                     .triangles = one.work.mesh->triangles(),
                     .poses = kind,
                     .engine = engine->facts(),
                     .pairs = one.poses.size()};
        std::string disagreement = judgeEngine(certified->pairs, answers, row);
        if (disagreement.empty() && row.engine.sameCounts) {
            disagreement = compareCounts(all[row.engine.ratioTo], answers, row);
        }
        if (result.disagreement.empty()) {
            result.disagreement = disagreement;
        }
        all.push_back(std::move(answers));
        result.rows.push_back(std::move(row));
        const double fits = static_cast<double>(one.poses.size()) * std::min(1.0, kLongest / took->wall);
        one.some.push_back(std::min(one.poses.size(), std::max(kFewestPoses, static_cast<std::size_t>(fits))));
        one.passes.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(kShortest / took->wall))));
    }
    return {};
}

/// A sample of an engine, and its ratio to that of the same round which it is held against.
Result<double> takeSample(const Case& one, std::size_t engine, BenchResult& result) {
    const auto poses = std::span(one.poses).first(one.some[engine]);
    const Result<Times> took = timed([&]() -> Result<void> {
        for (std::size_t pass = 0; pass < one.passes[engine]; ++pass) {
            VOXTACT_TRY((*one.engines)[engine]->run(one.work.at(poses), {}));
        }
        return {};
    });
    VOXTACT_TRY(took);
    BenchRow& row = result.rows[one.firstRow + engine];
    const auto pairs = static_cast<double>(poses.size() * one.passes[engine]);
    row.wallRate.push_back(pairs / took->wall);
    row.cpuRate.push_back(pairs / took->cpu);
    const BenchRow& beside = result.rows[one.firstRow + row.engine.ratioTo];
    row.wallRatio.push_back(row.wallRate.back() / beside.wallRate.back());
    row.cpuRatio.push_back(row.cpuRate.back() / beside.cpuRate.back());
    return took->wall * 1000;
}

/// Around the onset of contact there are hardly any survivors to have outputs of.
std::span<const char* const> kindsOf(BenchMode mode) {
    static constexpr std::array kKinds{"large", "onset"};
    return std::span(kKinds).first(mode == BenchMode::Outputs ? 1 : 2);
}

/// The sets of poses of a mesh: verified, then timed.
Result<void> benchMesh(const BenchSettings& settings, const VolumePart& volume, MeshPart& mesh,
                       const device::Session* session, const std::function<void()>& step, BenchResult& result) {
    VOXTACT_TRY(makeReady(session, mesh));
    const Result<Engines> engines = makeBenchEngines(settings.mode, volume, mesh, session);
    VOXTACT_TRY(engines);
    const Work work{volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}};
    for (const char* kind : kindsOf(settings.mode)) {
        Result<std::vector<Mat4>> poses = makePoses(kind, settings, work, *engines->front());
        VOXTACT_TRY(poses);
        Case one{.engines = &*engines, .work = {}, .poses = std::move(*poses), .passes = {}, .some = {}};
        one.work = work.at(one.poses);
        VOXTACT_TRY(verifyCase(one, kind, result));
        std::vector<Timed> things;
        for (std::size_t i = 0; i < engines->size(); ++i) {
            things.push_back({.take = [&, i](const Turn&) { return takeSample(one, i, result); }});
        }
        VOXTACT_TRY(takeRounds(things, {.repeats = settings.repetitions, .step = step, .stop = [&] {
                                            return !result.disagreement.empty();
                                        }}));
    }
    return {};
}

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

} // namespace

std::string judgeEngine(std::span<const PairAnswer> certified, std::span<const PairAnswer> answers, BenchRow& row) {
    std::string disagreement;
    for (std::size_t i = 0; i < certified.size(); ++i) {
        const PairAnswer& truth = certified[i];
        const PairAnswer& answer = answers[i];
        const bool none = !truth.hit && !truth.possible;
        row.contacts += truth.hit ? 1 : 0;
        row.untouched += none ? 1 : 0;
        row.missed += truth.hit && !answer.hit ? 1 : 0;
        row.wrong += none && answer.hit ? 1 : 0;
        const std::uint64_t expected = row.engine.question == "yes/no" ? (truth.hit ? 1 : 0) : truth.count;
        if (row.engine.certified && disagreement.empty() &&
            (answer.hit != truth.hit || answer.possible != truth.possible || answer.count != expected)) {
            disagreement = row.mesh + ", poses " + row.poses + ", pose " + std::to_string(i) + ": " + row.engine.name +
                           " " + row.engine.question + " says " + std::to_string(answer.count) + ", it must be " +
                           std::to_string(expected);
        }
    }
    return disagreement;
}

const char* defaultVolume(BenchMode mode) {
    // The large scene is for engines that skip what cannot touch.
    return mode == BenchMode::Outputs ? "builtin:head:128" : "builtin:head:256";
}

std::vector<std::string> defaultMeshes(BenchMode mode) {
    return {kMeshes.begin(), kMeshes.begin() + (mode == BenchMode::Certified ? kMeshes.size() : 1)};
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
    steps.begin(kindsOf(settings.mode).size() * settings.repetitions * meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(benchMesh(settings, volume, mesh, session, steps.step, result));
    }
    return {};
}

} // namespace voxtact::lab
