// SPDX-License-Identifier: MIT
#include "app/bench_run.h"

#include "app/inputs.h"
#include "app/output_paths.h"
#include "app/progress.h"
#include "app/random_poses.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;
using Engines = std::vector<std::unique_ptr<Engine>>;

constexpr std::array<const char*, 2> kMeshes{"builtin:scalpel:3068", "builtin:ellipsoid:49998"};
constexpr const char* kOpacity = "40:0,80:1";
constexpr std::size_t kCounting = 1; ///< the engine that the others are held against: it knows what is possible
/// The large scene is for engines that skip what cannot touch.
const char* defaultVolume(BenchMode mode) {
    return mode == BenchMode::Outputs ? "builtin:head:128" : "builtin:head:256";
}

/// Seconds of a sample: repeated up to the one, cut beyond the other.
constexpr double kShortest = 0.03;
constexpr double kLongest = 1.0;
constexpr std::size_t kFewestPoses = 8;

/// A set of poses with its engines, ready to be timed.
struct Case {
    const Engines* engines = nullptr;
    std::vector<Mat4> poses;
    std::vector<std::size_t> passes; ///< of a sample, by engine
    std::vector<std::size_t> some;   ///< poses of a pass, by engine
    std::size_t firstRow = 0;
};

struct Times {
    double wall = 0;
    double cpu = 0;
};

template <class Work> Result<Times> timed(Work&& work) {
    const std::clock_t cpu = std::clock();
    const auto wall = Clock::now();
    if (Result<void> done = work(); !done.ok()) {
        return done.error();
    }
    // A tick at least, so that no rate is infinite.
    return Times{std::max(std::chrono::duration<double>(Clock::now() - wall).count(), 1e-9),
                 static_cast<double>(std::max<std::clock_t>(std::clock() - cpu, 1)) / CLOCKS_PER_SEC};
}

Result<BenchVolume> loadBenchVolume(const BenchOptions& options, const std::string& source) {
    Result<VolumeData> data = loadVolume(source);
    if (!data.ok()) {
        return data.error();
    }
    const Result<ValueRange> range = checkVolume(data->view());
    if (!range.ok()) {
        return range.error();
    }
    TransferFunctionOptions wanted = options.transferFunction;
    if (options.volumes.empty() && wanted.path.empty() && !wanted.opacity) {
        wanted.opacity = kOpacity;
    }
    Result<std::vector<ControlPoint>> points = loadControlPoints(wanted);
    if (!points.ok()) {
        return points.error();
    }
    const ValueRange domain = tableDomain(wanted, data->type, *range);
    std::vector<ControlPoint> ramp = points->empty() ? defaultRamp(domain) : std::move(*points);
    Result<cpu::Volume> host = cpu::Volume::create(data->view());
    if (!host.ok()) {
        return host.error();
    }
    Result<cpu::TransferFunction> function = cpu::TransferFunction::create({ramp, domain, wanted.tableSize});
    if (!function.ok()) {
        return function.error();
    }
    const View view{framingCamera(data->grid, 512, 512), 512, 512};
    return BenchVolume{.data = std::move(*data),
                       .points = std::move(ramp),
                       .domain = domain,
                       .tableSize = wanted.tableSize,
                       .threshold = wanted.threshold,
                       .view = view,
                       .host = std::move(*host),
                       .hostFunction = std::move(*function),
                       .device = std::nullopt,
                       .deviceFunction = std::nullopt,
                       .fcl = std::nullopt,
                       .labels = {},
                       .deviceLabels = std::nullopt};
}

Result<BenchMesh> loadBenchMesh(const BenchOptions& options, const std::string& source) {
    Result<MeshData> data = loadMesh(source, options.meshes);
    if (!data.ok()) {
        return data.error();
    }
    Result<cpu::Mesh> host = cpu::Mesh::create(data->view());
    if (!host.ok()) {
        return host.error();
    }
    return BenchMesh{source, std::move(*data), std::move(*host), std::nullopt};
}

/// The octree, or a note that says why there is none.
void addFcl(BenchVolume& volume, BenchResult& result) {
    const Result<OpaqueCells> cells =
        opaqueCells(volume.data.view(), {volume.points, volume.domain, volume.tableSize}, volume.threshold);
    if (fclVersion().empty() || !cells.ok()) {
        result.notes.push_back("FCL: " + (cells.ok() ? "not built in" : cells.error().text));
        return;
    }
    Result<FclVolume> made = FclVolume::create(*cells);
    if (!made.ok()) {
        result.notes.push_back("FCL: " + made.error().text);
        return;
    }
    volume.fcl.emplace(std::move(*made));
    result.notes.push_back(fclVersion() + ": BVHModel of OBBRSS against an octree of opaque voxels" +
                           (cells->resampled ? ", which are no cubes: cells of the smallest spacing, each with the "
                                               "value of the voxel at its centre"
                                             : ""));
}

/// The device's session; none, with a note, where there is no device and none was asked for.
Result<std::optional<Session>> openBenchSession(const BenchOptions& options, BenchResult& result) {
    Result<Session> session = openSession(options.device);
    if (session.ok()) {
        return std::optional(std::move(*session));
    }
    if (!options.device.wanted.empty() || options.device.validate) {
        return session.error();
    }
    result.notes.push_back("no device: " + session.error().text);
    return std::optional<Session>();
}

Result<std::vector<Mat4>> makePoses(const std::string& kind, const BenchOptions& options, const BenchVolume& volume,
                                    const BenchMesh& mesh, Engine& yesNo) {
    const Grid& grid = volume.data.grid;
    if (kind == "large") {
        return randomPoses(grid, mesh.data.view(), options.poses, options.seed);
    }
    return onsetPoses(grid, mesh.data.view(), options.poses, options.seed, [&yesNo](const Mat4& pose) -> Result<bool> {
        const Result<std::vector<EngineAnswer>> answer = yesNo.run({&pose, 1});
        return answer.ok() ? Result<bool>(answer->front().hit) : Result<bool>(answer.error());
    });
}

/// Says where an engine does not count as the one that it must count as.
std::string compareCounts(std::span<const EngineAnswer> bare, std::span<const EngineAnswer> answers,
                          const BenchRow& row) {
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
Result<void> verifyCase(Case& one, const BenchMesh& mesh, const std::string& kind, BenchResult& result) {
    std::vector<EngineAnswer> certified;
    Result<Times> first = timed([&]() -> Result<void> {
        Result<std::vector<EngineAnswer>> answers = (*one.engines)[kCounting]->run(one.poses);
        if (!answers.ok()) {
            return answers.error();
        }
        certified = std::move(*answers);
        return {};
    });
    if (!first.ok()) {
        return first.error();
    }
    one.firstRow = result.rows.size();
    std::vector<std::vector<EngineAnswer>> all;
    for (const std::unique_ptr<Engine>& engine : *one.engines) {
        std::vector<EngineAnswer> answers;
        const Result<Times> took = timed([&]() -> Result<void> {
            Result<std::vector<EngineAnswer>> run = engine->run(one.poses);
            if (!run.ok()) {
                return run.error();
            }
            answers = std::move(*run);
            return {};
        });
        if (!took.ok()) {
            return took.error();
        }
        BenchRow row{.mesh = mesh.name,
                     .triangles = static_cast<std::uint32_t>(mesh.data.indices.size() / 3),
                     .poses = kind,
                     .engine = engine->facts(),
                     .pairs = one.poses.size()};
        std::string disagreement = judgeEngine(certified, answers, row);
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

/// A sample of every engine, one after the other.
Result<void> timeRound(const Case& one, BenchResult& result) {
    for (std::size_t i = 0; i < one.engines->size(); ++i) {
        const auto poses = std::span(one.poses).first(one.some[i]);
        const Result<Times> took = timed([&]() -> Result<void> {
            for (std::size_t pass = 0; pass < one.passes[i]; ++pass) {
                if (Result<std::vector<EngineAnswer>> run = (*one.engines)[i]->run(poses); !run.ok()) {
                    return run.error();
                }
            }
            return {};
        });
        if (!took.ok()) {
            return took.error();
        }
        BenchRow& row = result.rows[one.firstRow + i];
        const auto pairs = static_cast<double>(poses.size() * one.passes[i]);
        row.wallRate.push_back(pairs / took->wall);
        row.cpuRate.push_back(pairs / took->cpu);
        const BenchRow& beside = result.rows[one.firstRow + row.engine.ratioTo];
        row.wallRatio.push_back(row.wallRate.back() / beside.wallRate.back());
        row.cpuRatio.push_back(row.cpuRate.back() / beside.cpuRate.back());
    }
    return {};
}

/// Around the onset of contact there are hardly any survivors to have outputs of.
std::span<const char* const> kindsOf(BenchMode mode) {
    static constexpr std::array kKinds{"large", "onset"};
    return std::span(kKinds).first(mode == BenchMode::Outputs ? 1 : 2);
}

/// The sets of poses of a mesh: verified, then timed.
Result<void> benchMesh(const BenchOptions& options, const BenchVolume& volume, const std::string& source,
                       const Session* session, const std::function<void()>& step, BenchResult& result) {
    Result<BenchMesh> mesh = loadBenchMesh(options, source);
    if (!mesh.ok()) {
        return mesh.error();
    }
    if (session != nullptr) {
        if (Result<void> uploaded = uploadMesh(*session, *mesh); !uploaded.ok()) {
            return uploaded;
        }
    }
    const bool outputs = options.mode == BenchMode::Outputs;
    const Result<Engines> engines =
        outputs ? makeOutputEngines(volume, *mesh, session) : makeEngines(volume, *mesh, session);
    if (!engines.ok()) {
        return engines.error();
    }
    for (const char* kind : kindsOf(options.mode)) {
        Result<std::vector<Mat4>> poses = makePoses(kind, options, volume, *mesh, *engines->front());
        if (!poses.ok()) {
            return poses.error();
        }
        Case one{.engines = &*engines, .poses = std::move(*poses), .passes = {}, .some = {}};
        if (Result<void> verified = verifyCase(one, *mesh, kind, result); !verified.ok()) {
            return verified;
        }
        for (std::uint32_t round = 0; round < options.repetitions && result.disagreement.empty(); ++round) {
            if (Result<void> done = timeRound(one, result); !done.ok()) {
                return done;
            }
            step();
        }
    }
    return {};
}

std::vector<std::string> meshesOf(const BenchOptions& options) {
    if (!options.meshes.sources.empty()) {
        return options.meshes.sources;
    }
    return {kMeshes.begin(), kMeshes.begin() + (options.mode == BenchMode::Outputs ? 1 : kMeshes.size())};
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

Result<void> benchAll(const BenchOptions& options, const Session* session, BenchVolume& volume, BenchResult& result) {
    if (options.mode == BenchMode::Outputs) {
        volume.labels = octants(volume.data.grid);
    }
    if (session != nullptr) {
        if (Result<void> uploaded = uploadVolume(*session, volume); !uploaded.ok()) {
            return uploaded;
        }
    }
    if (options.mode == BenchMode::Certified) {
        addFcl(volume, result);
    }
    const std::vector<std::string> meshes = meshesOf(options);
    Progress progress(options.progress, "voxtact bench",
                      kindsOf(options.mode).size() * options.repetitions * meshes.size());
    std::uint64_t steps = 0;
    for (const std::string& mesh : meshes) {
        if (Result<void> done = benchMesh(
                options, volume, mesh, session, [&] { progress.update(++steps); }, result);
            !done.ok()) {
            return done;
        }
    }
    return {};
}

} // namespace

Outcome runBenchEngines(const BenchOptions& options) {
    if (options.volumes.size() > 1) {
        return badArgument("one --volume is enough, not several");
    }
    if (const Result<void> writable =
            checkOutputs({{"--output", options.output.path}},
                         inputPaths(options.volumes, options.meshes, options.transferFunction, {}));
        !writable.ok()) {
        return writable.error();
    }
    BenchResult result;
    result.volume = options.volumes.empty() ? defaultVolume(options.mode) : options.volumes.front();
    std::shared_ptr<const ValidationMessages> messages;
    {
        const Result<std::optional<Session>> opened = openBenchSession(options, result);
        if (!opened.ok()) {
            return opened.error();
        }
        const Session* session = opened->has_value() ? &**opened : nullptr;
        // What is on the device must end before the session.
        Result<BenchVolume> volume = loadBenchVolume(options, result.volume);
        if (!volume.ok()) {
            return volume.error();
        }
        result.voxels = volume->data.grid.size;
        result.machine = session == nullptr ? describeHost() : describeMachine(*session, volume->data.type);
        if (session != nullptr) {
            messages = session->instance.messages();
        }
        if (const Result<void> done = benchAll(options, session, *volume, result); !done.ok()) {
            return done.error();
        }
    }
    if (messages != nullptr) {
        if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
            return invalid;
        }
    }
    if (!result.disagreement.empty()) {
        return {kExitVerify, "engines that must agree do not: " + result.disagreement};
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeBench(out, options, result);
        return {};
    });
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace voxtact::app
