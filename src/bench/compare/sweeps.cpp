// SPDX-License-Identifier: MIT
#include "bench/compare/compare.h"
#include "bench/measure/numbers.h"
#include "bench/measure/rounds.h"
#include "core/base/try.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voxtact::lab {

namespace {

constexpr std::array<std::uint32_t, 4> kBatches{1, 16, 256, 1024};
/// Pairs of a point in the sweeps of triangles, fragments and voxels.
constexpr std::uint32_t kSweepPairs = 8;
constexpr double kGoldenRatio = 0.6180339887498949;
constexpr std::array<std::uint32_t, 6> kTriangles{256, 1024, 4096, 16384, 65536, 200000};
constexpr std::array<std::uint32_t, 6> kSides{64, 128, 256, 512, 1024, 2048};
/// Voxels per side of the volume, in quarters of the given one's.
constexpr std::array<std::uint32_t, 5> kQuarters{2, 3, 4, 6, 8};
constexpr std::uint32_t kFramesInFlight = 3;
constexpr std::size_t kWarmUpPairs = 16;
/// A sample is cut so that this many fit.
constexpr double kSamplesInShare = 3;
/// Maximum share of a sample in the time limit, described by describe().
constexpr double kLongestSample = 0.25;

/// A measurement that is repeated: what, by whom, and where its samples go.
struct Point {
    const Engine* engine = nullptr;
    Work work;
    Feeding feeding{};
    Series series{};
    double batchMilliseconds = 0; ///< kNoLimit: too long to be timed
    std::vector<Mat4> again{};    ///< the poses of a sample, where they are taken more than once
};

Point makePoint(Sweep sweep, const Engine& engine, const Work& work, Mode mode, std::uint32_t batch) {
    return {.engine = &engine,
            .work = work,
            .feeding = mode == Mode::Sync ? Feeding{1, 1} : Feeding{batch, kFramesInFlight},
            .series = seriesOf(sweep, engine.facts.name, work, mode, batch)};
}

Result<double> takeSample(Point& point) {
    const Result<Pass> pass = point.engine->run(point.work, point.feeding);
    VOXTACT_TRY(pass);
    const auto pairs = static_cast<double>(point.work.poses.size());
    Series& series = point.series;
    if (series.counts()) {
        const std::vector<std::uint64_t> counts = pass->counts();
        series.fragments = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0})) / pairs;
    }
    const double batches = pairs / series.batch;
    series.wall.push_back(pass->wallMilliseconds / batches);
    if (pass->gpuMilliseconds) {
        series.gpu.push_back(*pass->gpuMilliseconds / batches);
    }
    return pass->wallMilliseconds;
}

std::string describe(const Series& series) {
    return concat("no time of ", series.method, " for ",
                  series.mode == Mode::Sync ? "pairs submitted one by one" : concat("batches of ", series.batch), " (",
                  series.triangles, " triangles, ", series.width, "x", series.height, ", ", sizeText(series.voxels),
                  " voxels): it would take more than a quarter of the time limit");
}

/// Warms everything up once, which estimates the time of a batch. A batch longer than `most` is not timed, with a note.
Result<void> warmUp(Point& point, double most, CompareResult& result) {
    Work some = point.work;
    some.poses = some.poses.first(std::min<std::size_t>(some.poses.size(), kWarmUpPairs));
    // The first pass may make pipelines: only the second one says how long a batch takes.
    VOXTACT_TRY(point.engine->run(some, point.feeding));
    const Result<Pass> pass = point.engine->run(some, point.feeding);
    VOXTACT_TRY(pass);
    point.batchMilliseconds = pass->wallMilliseconds / static_cast<double>(some.poses.size()) * point.series.batch;
    if (point.batchMilliseconds > most) {
        result.notes.push_back(describe(point.series));
        point.batchMilliseconds = kNoLimit;
    }
    return {};
}

/// Gives the points of one mode and batch the same poses, as many as the slowest method answers in `most` ms.
void takeSamePoses(std::span<Point> group, double most, const CompareRun& run) {
    std::vector<double> milliseconds;
    std::ranges::transform(group, std::back_inserter(milliseconds), &Point::batchMilliseconds);
    const std::size_t batch = group.front().series.batch;
    const SampleSize size = sampleSize(milliseconds, most, group.front().work.poses.size() / batch);
    const std::size_t pairs = size.batches * batch;
    for (std::size_t i = 0; i < group.size(); ++i) {
        Point& point = group[i];
        point.series.pairs = static_cast<std::uint32_t>(pairs);
        point.work.poses = point.work.poses.first(pairs);
        for (std::size_t pass = 0; size.passes[i] > 1 && pass < size.passes[i]; ++pass) {
            point.again.insert(point.again.end(), point.work.poses.begin(), point.work.poses.end());
        }
        point.work.poses = point.again.empty() ? point.work.poses : point.again;
    }
    const Series& series = group.front().series;
    if (pairs < run.scene.poses.size() && series.sweep == Sweep::Batch) {
        run.result.notes.push_back(
            concat(series.mode == Mode::Sync ? "waited for: " : "in flight, batches of " + grouped(batch) + ": ",
                   "all methods are timed on the same ", grouped(pairs), " of the ", grouped(run.scene.poses.size()),
                   " poses; increase --time-limit for more"));
    }
}

/// Each point has its share of the time.
Result<void> measure(const CompareRun& run, std::vector<Point>& points) {
    const double limit = run.settings.timeLimit * 1000;
    const double share = limit / static_cast<double>(points.size());
    for (Point& point : points) {
        VOXTACT_TRY(warmUp(point, limit * kLongestSample, run.result));
    }
    run.step(1);
    const auto wayOf = [](const Point& point) { return std::pair(point.series.mode, point.series.batch); };
    for (auto first = points.begin(); first != points.end();) {
        const auto last = std::ranges::find_if(first, points.end(),
                                               [&](const Point& point) { return wayOf(point) != wayOf(*first); });
        takeSamePoses({first, last}, share / kSamplesInShare, run);
        first = last;
    }
    std::vector<Timed> things;
    for (Point& point : points) {
        if (point.batchMilliseconds != kNoLimit) {
            things.push_back({.take = [&point](const Turn&) { return takeSample(point); }, .limit = share});
        }
    }
    VOXTACT_TRY(takeRounds(things, {.repeats = run.settings.repeats, .step = run.step}));
    return {};
}

/// Returns the series of the measured points. Methods that count 0 or 1 take the fragments of a neighbour on the same
/// poses.
std::vector<Series> seriesOf(std::vector<Point>& points) {
    std::vector<Series> measured;
    for (Point& point : points) {
        Series& own = point.series;
        const auto found = std::ranges::find_if(points, [&own](const Point& other) {
            const Series& series = other.series;
            return series.fragments && series.mode == own.mode && series.batch == own.batch &&
                   series.triangles == own.triangles && series.width == own.width && series.voxels == own.voxels;
        });
        if (!own.fragments && found != points.end()) {
            own.fragments = found->series.fragments;
        }
        if (!own.wall.empty()) {
            measured.push_back(own);
        }
    }
    return measured;
}

/// In the order of mode and batch.
void addSorted(std::vector<Series> measured, CompareResult& result) {
    std::ranges::stable_sort(measured, {}, [](const Series& series) { return std::pair(series.mode, series.batch); });
    std::ranges::move(measured, std::back_inserter(result.series));
}

/// `count` poses, again from the start where there are no more: one pose repeated would be cache-warm. In an order
/// whose every beginning is spread over all of them, so that a part of a path of poses is not one end of it.
std::vector<Mat4> cycled(std::span<const Mat4> poses, std::size_t count) {
    auto step = static_cast<std::size_t>(std::lround(static_cast<double>(poses.size()) * kGoldenRatio));
    while (std::gcd(step, poses.size()) != 1) {
        ++step;
    }
    std::vector<Mat4> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        out.push_back(poses[i * step % poses.size()]);
    }
    return out;
}

/// Pairs that wait for each other do not care how many there are: measured once.
Series scaled(Series series, std::uint32_t batch) {
    series.batch = batch;
    for (std::vector<double>* const times : {&series.wall, &series.gpu}) {
        std::ranges::for_each(*times, [batch](double& time) { time *= batch; });
    }
    return series;
}

Result<void> timeBatches(const CompareRun& run) {
    const Work work(run.scene);
    std::array<std::vector<Mat4>, kBatches.size()> poses;
    const std::vector<Mat4> one = cycled(work.poses, work.poses.size());
    std::vector<Point> points;
    for (std::size_t i = 0; i < kBatches.size(); ++i) {
        const std::size_t batch = kBatches[i];
        const std::size_t batches = (std::max(work.poses.size(), batch) + batch - 1) / batch;
        poses[i] = cycled(work.poses, batches * batch);
        for (const Engine& engine : run.engines) {
            points.push_back(makePoint(Sweep::Batch, engine, work.at(poses[i]), Mode::Pipelined, kBatches[i]));
        }
    }
    for (const Engine& engine : run.engines) {
        points.push_back(makePoint(Sweep::Batch, engine, work.at(one), Mode::Sync, 1));
    }
    VOXTACT_TRY(measure(run, points));
    std::vector<Series> measured = seriesOf(points);
    for (std::size_t i = 0, end = measured.size(); i < end; ++i) {
        for (std::size_t batch = 1; measured[i].mode == Mode::Sync && batch < kBatches.size(); ++batch) {
            measured.push_back(scaled(measured[i], kBatches[batch]));
        }
    }
    addSorted(std::move(measured), run.result);
    return {};
}

/// A point of the other sweeps, which all engines take.
struct Swept {
    Scene scene;       ///< at the poses of all points
    std::string where; ///< says which point it is
};

/// A builtin of another size: "builtin:head:128" as "builtin:head:64".
std::string resized(const std::string& source, std::uint32_t size) {
    return source.substr(0, source.find(':', std::string_view("builtin:").size())) + ":" + std::to_string(size);
}

/// That a point is left out, and why.
void leaveOut(const CompareRun& run, const std::string& what, const Error& why) {
    run.result.notes.push_back("no point of " + what + ": " + why.text);
}

/// These set the size of a point. They return false if it is unsupported, with a note.
Result<bool> sizeMesh(const CompareRun& run, std::uint32_t triangles, Swept& point) {
    point.where = std::to_string(triangles) + " triangles";
    point.scene.mesh = std::make_shared<MeshPart>();
    const Result<void> loaded =
        put(run.settings.load.mesh(resized(run.scene.mesh->name, triangles)), point.scene.mesh->data);
    if (!loaded.ok()) {
        leaveOut(run, point.where, loaded.error());
        return false;
    }
    VOXTACT_TRY(makeReady(&run.session, *point.scene.mesh));
    return true;
}

Result<bool> sizeViewport(const CompareRun& run, std::uint32_t side, Swept& point) {
    View& view = point.scene.view;
    view.height =
        static_cast<std::uint32_t>(std::max(1L, std::lround(static_cast<double>(side) * view.height / view.width)));
    view.width = side;
    point.where = concat("--size ", view.width, "x", view.height);
    return checkViewport(run.session, {view.width, view.height}).ok();
}

Result<bool> sizeVolume(const CompareRun& run, std::uint32_t quarters, Swept& point) {
    const VolumePart& like = *run.scene.volume;
    point.scene.volume =
        std::make_shared<VolumePart>(VolumePart{.name = resized(like.name, like.data.grid.size[0] * quarters / 4),
                                                .data = {},
                                                .points = like.points,
                                                .domain = like.domain,
                                                .tableSize = like.tableSize,
                                                .threshold = like.threshold});
    VolumePart& sized = *point.scene.volume;
    const Result<void> loaded = put(run.settings.load.volume(sized.name), sized.data);
    const Result<void> ready = loaded.ok() ? makeReady(run.session, {}, sized) : loaded;
    run.step(1);
    if (!ready.ok()) {
        const bool tooLarge =
            ready.error().code == ErrorCode::LimitExceeded || ready.error().code == ErrorCode::OutOfMemory;
        leaveOut(run, sized.name, ready.error());
        return loaded.ok() && !tooLarge ? Result<bool>(ready.error()) : false;
    }
    // In both engines by now, and as many bytes as either.
    sized.data.voxels = {};
    point.where = sizeText(sized.data.grid.size) + " voxels";
    return true;
}

/// Returns the supported ones.
Result<std::vector<Swept>> pointsOf(const CompareRun& run, Sweep sweep) {
    using Sizes = std::span<const std::uint32_t>;
    const bool meshes = sweep == Sweep::Triangles;
    const bool viewports = sweep == Sweep::Fragments;
    const std::string& source = meshes ? run.scene.mesh->name : run.scene.volume->name;
    std::vector<Swept> points;
    if (!viewports && !source.starts_with("builtin:")) {
        run.result.notes.push_back(concat("no sweep of ", toString(sweep), ": the ", meshes ? "mesh" : "volume",
                                          " is no builtin, so its size is fixed"));
        return points;
    }
    const auto resize = meshes ? sizeMesh : viewports ? sizeViewport : sizeVolume;
    const Scene some = run.scene.withPoses(kSweepPairs);
    for (const std::uint32_t size : meshes ? Sizes(kTriangles) : viewports ? Sizes(kSides) : Sizes(kQuarters)) {
        Swept point{some, {}};
        const Result<bool> had = resize(run, size, point);
        VOXTACT_TRY(had);
        if (*had) {
            points.push_back(std::move(point));
        }
    }
    return points;
}

/// The counts of a point agree before it is timed: adds the verdicts that failed.
Result<void> verify(const CompareRun& run, Sweep sweep, const Swept& point) {
    const Result<std::vector<NamedCounts>> counts = countAll(run.engines, Work(point.scene));
    VOXTACT_TRY(counts);
    for (CompareVerdict& verdict : judgeCounts(*counts, point.scene.poseNumbers)) {
        if (verdict.failed()) {
            verdict.rule += " (" + point.where + ")";
            verdict.sweep = toString(sweep);
            run.result.verdicts.push_back(std::move(verdict));
        }
    }
    return {};
}

} // namespace

SampleSize sampleSize(std::span<const double> milliseconds, double most, std::size_t all) {
    const auto fitting = [&](double batch) { // a coarse clock may say 0
        return std::max<std::size_t>(1, static_cast<std::size_t>(std::min(most / batch, static_cast<double>(all))));
    };
    SampleSize size{.batches = all};
    for (const double batch : milliseconds) {
        size.batches = batch == kNoLimit ? size.batches : std::min(size.batches, fitting(batch));
    }
    for (const double batch : milliseconds) {
        size.passes.push_back(batch == kNoLimit ? 0 : fitting(batch) / size.batches);
    }
    return size;
}

std::uint64_t stepsOf(Sweep sweep, std::uint32_t repeats) noexcept {
    // A volume takes longer to make than to be measured on.
    return std::uint64_t{repeats} + 1 + (sweep == Sweep::Voxels ? kQuarters.size() : 0);
}

Result<void> timeSweep(const CompareRun& run, Sweep sweep) {
    if (sweep == Sweep::Batch) {
        return timeBatches(run);
    }
    const Result<std::vector<Swept>> all = pointsOf(run, sweep);
    VOXTACT_TRY(all);
    std::vector<Point> points;
    for (const Swept& one : *all) {
        VOXTACT_TRY(verify(run, sweep, one));
        for (const Engine& engine : run.engines) {
            points.push_back(makePoint(sweep, engine, Work(one.scene), Mode::Pipelined,
                                       static_cast<std::uint32_t>(one.scene.poses.size())));
        }
    }
    if (points.empty() || run.ended()) {
        return {};
    }
    VOXTACT_TRY(measure(run, points));
    addSorted(seriesOf(points), run.result);
    return {};
}

} // namespace voxtact::lab
