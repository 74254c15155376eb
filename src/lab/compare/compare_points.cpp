// SPDX-License-Identifier: MIT
#include "lab/compare/compare_points.h"

#include "core/try.h"

#include <algorithm>
#include <numeric>

namespace voxtact::lab {

namespace {

constexpr std::uint32_t kFramesInFlight = 3;
constexpr std::size_t kWarmUpPairs = 16;
/// A sample is cut so that this many fit.
constexpr double kSamplesInShare = 3;
/// Of the time limit; describe() says it in words.
constexpr double kLongestSample = 0.25;

Result<void> takeSample(Point& point) {
    const Result<Pass> pass = point.engine->run(point.work, point.feeding);
    VOXTACT_TRY(pass);
    const auto pairs = static_cast<double>(point.work.poses.size());
    if (point.engine->name() != toString(CountingMethod::QueryAny)) {
        point.series.fragments =
            std::accumulate(pass->pairs.begin(), pass->pairs.end(), 0.0,
                            [](double sum, const PairAnswer& pair) { return sum + static_cast<double>(pair.count); }) /
            pairs;
    }
    point.spent += pass->wallMilliseconds;
    const double batches = pairs / point.series.batch;
    point.series.wall.push_back(pass->wallMilliseconds / batches);
    if (pass->gpuMilliseconds) {
        point.series.gpu.push_back(*pass->gpuMilliseconds / batches);
    }
    return {};
}

/// Everything is made and touched once. Cuts a sample that would take too long, to whole batches; false where even one
/// batch would.
Result<bool> warmUp(Point& point, double share, double most) {
    Work some = point.work;
    some.poses = some.poses.first(std::min<std::size_t>(some.poses.size(), kWarmUpPairs));
    // The first pass may make pipelines: only the second one says how long a batch takes.
    VOXTACT_TRY(point.engine->run(some, point.feeding));
    const Result<Pass> pass = point.engine->run(some, point.feeding);
    VOXTACT_TRY(pass);
    const double aBatch = pass->wallMilliseconds / static_cast<double>(some.poses.size()) * point.series.batch;
    const std::size_t all = point.work.poses.size() / point.series.batch;
    const auto fitting = static_cast<std::size_t>(std::min(share / kSamplesInShare / aBatch, static_cast<double>(all)));
    point.work.poses = point.work.poses.first(std::max<std::size_t>(fitting, 1) * point.series.batch);
    point.series.pairs = static_cast<std::uint32_t>(point.work.poses.size());
    return aBatch <= most;
}

std::string describe(const Series& series) {
    return "no time of " + series.method + " for batches of " + std::to_string(series.batch) + " (" +
           std::to_string(series.triangles) + " triangles, " + std::to_string(series.width) + "x" +
           std::to_string(series.height) + ", " + sizeText(series.voxels) +
           " voxels): one would take more than a quarter of the sweep's time";
}

/// A query says nothing of how many: the fragments are those of its neighbours.
void shareFragments(std::vector<Point>& points) {
    for (Point& point : points) {
        if (point.series.fragments) {
            continue;
        }
        for (const Point& other : points) {
            const Series& series = other.series;
            if (series.fragments && series.triangles == point.series.triangles && series.width == point.series.width &&
                series.voxels == point.series.voxels) {
                point.series.fragments = series.fragments;
                break;
            }
        }
    }
}

} // namespace

Point makePoint(Sweep sweep, Engine& engine, const Work& work, Mode mode, std::uint32_t batch) {
    Point point{.engine = &engine, .work = work, .series = {}};
    point.feeding = mode == Mode::Sync ? Feeding{1, 1} : Feeding{batch, kFramesInFlight};
    point.series = {.sweep = sweep,
                    .method = engine.name(),
                    .mode = mode,
                    .batch = batch,
                    .width = work.view.width,
                    .height = work.view.height,
                    .triangles = work.mesh->triangles(),
                    .pairs = static_cast<std::uint32_t>(work.poses.size()),
                    .fragments = std::nullopt,
                    .wall = {},
                    .gpu = {},
                    .voxels = work.volume->data.grid.size};
    return point;
}

void addPoints(Sweep sweep, const Engines& engines, const Work& work, std::vector<Point>& points) {
    const auto pairs = static_cast<std::uint32_t>(work.poses.size());
    for (const std::unique_ptr<Engine>& engine : engines) {
        points.push_back(makePoint(sweep, *engine, work, Mode::Pipelined, pairs));
    }
}

Result<void> verifyPoint(const Engines& engines, const Work& work, std::span<const std::uint32_t> poses,
                         const std::string& where, Sweep sweep, CompareResult& result) {
    const Result<std::vector<NamedCounts>> counts = countAll(engines, work);
    VOXTACT_TRY(counts);
    for (Verdict& verdict : judgeCounts(*counts, poses)) {
        if (verdict.failed()) {
            verdict.rule += " (" + where + ")";
            verdict.sweep = toString(sweep);
            result.verdicts.push_back(std::move(verdict));
        }
    }
    return {};
}

Result<void> measure(std::vector<Point>& points, const CompareSettings& settings, CompareResult& result,
                     const std::function<void()>& step) {
    const double limit = settings.timeLimit * 1000;
    const double share = limit / static_cast<double>(points.size());
    for (Point& point : points) {
        const Result<bool> fits = warmUp(point, share, limit * kLongestSample);
        VOXTACT_TRY(fits);
        point.finished = !*fits;
        if (point.finished) {
            result.notes.push_back(describe(point.series));
        }
    }
    step();
    for (std::uint32_t round = 0; round < settings.repeats; ++round) {
        for (Point& point : points) {
            const double next = round == 0 ? 0 : point.spent / round;
            if (point.finished || point.spent + next > share) {
                point.finished = true;
                continue;
            }
            VOXTACT_TRY(takeSample(point));
        }
        step();
    }
    return {};
}

Result<void> measureVerified(std::vector<Point>& points, const CompareSettings& settings, CompareResult& result,
                             const std::function<void()>& step) {
    if (result.firstFailure() != nullptr && !settings.keepGoing) {
        return {};
    }
    Result<void> done = measure(points, settings, result, step);
    collect(points, result);
    return done;
}

void collect(std::vector<Point>& points, CompareResult& result) {
    shareFragments(points);
    std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return std::pair(a.series.mode, a.series.batch) < std::pair(b.series.mode, b.series.batch);
    });
    for (Point& point : points) {
        if (!point.series.wall.empty()) {
            result.series.push_back(std::move(point.series));
        }
    }
}

} // namespace voxtact::lab
