// SPDX-License-Identifier: MIT
#include "app/compare_timing.h"

#include "app/inputs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<std::uint32_t, 4> kBatches{1, 16, 256, 1024};
constexpr std::uint32_t kFramesInFlight = 3;
/// Pairs of a point in the sweeps of triangles and fragments.
constexpr std::uint32_t kSweepPairs = 8;
constexpr std::size_t kWarmUpPairs = 16;
constexpr double kGoldenRatio = 0.6180339887498949;
/// A sample is cut so that this many fit.
constexpr double kSamplesInShare = 3;
/// Of the time limit.
constexpr double kLongestSample = 0.25;
constexpr std::array<std::uint32_t, 6> kTriangles{256, 1024, 4096, 16384, 65536, 200000};
constexpr std::array<std::uint32_t, 6> kSides{64, 128, 256, 512, 1024, 2048};

/// A measurement that is repeated: what, by whom, and where its samples go.
struct Point {
    MethodRunner* runner = nullptr;
    Work work;
    std::uint32_t perSubmission = 1;
    std::uint32_t frames = 1;
    Series series;
    double spent = 0; ///< ms
    bool finished = false;
};

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

Result<void> takeSample(Point& point) {
    const Result<MethodRunner::Pass> pass = point.runner->run(point.work, point.perSubmission, point.frames);
    if (!pass.ok()) {
        return pass.error();
    }
    const auto pairs = static_cast<double>(point.work.poses.size());
    if (point.runner->method() != CountingMethod::QueryAny) {
        point.series.fragments =
            std::accumulate(pass->counts.begin(), pass->counts.end(), 0.0,
                            [](double sum, std::uint64_t count) { return sum + static_cast<double>(count); }) /
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
    const Result<MethodRunner::Pass> pass = point.runner->run(some, point.perSubmission, point.frames);
    if (!pass.ok()) {
        return pass.error();
    }
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
           std::to_string(series.height) + "): one would take too much of --time-limit";
}

/// The warm-up, then rounds. Each point has its share of the time and takes samples as long as they fit, one at least.
Result<void> measure(std::vector<Point>& points, const CompareOptions& options, CompareResult& result,
                     const std::function<void()>& step) {
    const double limit = options.timeLimit * 1000;
    const double share = limit / static_cast<double>(points.size());
    for (Point& point : points) {
        const Result<bool> fits = warmUp(point, share, limit * kLongestSample);
        if (!fits.ok()) {
            return fits.error();
        }
        point.finished = !*fits;
        if (point.finished) {
            result.notes.push_back(describe(point.series));
        }
    }
    step();
    for (std::uint32_t round = 0; round < options.repeats; ++round) {
        for (Point& point : points) {
            const double next = round == 0 ? 0 : point.spent / round;
            if (point.finished || point.spent + next > share) {
                point.finished = true;
                continue;
            }
            if (Result<void> done = takeSample(point); !done.ok()) {
                return done;
            }
        }
        step();
    }
    return {};
}

/// A query says nothing of how many: the fragments are those of its neighbours.
void shareFragments(std::vector<Point>& points) {
    for (Point& point : points) {
        if (point.series.fragments) {
            continue;
        }
        for (const Point& other : points) {
            const Series& series = other.series;
            if (series.fragments && series.triangles == point.series.triangles && series.width == point.series.width) {
                point.series.fragments = series.fragments;
                break;
            }
        }
    }
}

Point makePoint(Sweep sweep, MethodRunner& runner, const Work& work, Mode mode, std::uint32_t batch) {
    Point point{.runner = &runner, .work = work, .perSubmission = 1, .frames = 1, .series = {}};
    point.perSubmission = mode == Mode::Sync ? 1 : batch;
    point.frames = mode == Mode::Sync ? 1 : kFramesInFlight;
    point.series = {.sweep = sweep,
                    .method = runner.name(),
                    .mode = mode,
                    .batch = batch,
                    .width = work.view.width,
                    .height = work.view.height,
                    .triangles = static_cast<std::uint32_t>(work.subject->data.indices.size() / 3),
                    .pairs = static_cast<std::uint32_t>(work.poses.size()),
                    .fragments = std::nullopt,
                    .wall = {},
                    .gpu = {}};
    return point;
}

/// Pairs that wait for each other do not care how many there are: measured once, over all poses.
Series scaled(const Series& one, std::uint32_t batch) {
    Series series = one;
    series.batch = batch;
    for (double& time : series.wall) {
        time *= batch;
    }
    for (double& time : series.gpu) {
        time *= batch;
    }
    return series;
}

/// The counts of a point agree before it is timed.
Result<void> verifyPoint(const Runners& runners, const Work& work, std::span<const std::uint32_t> poses,
                         const std::string& where, Sweep sweep, CompareResult& result) {
    const Result<std::vector<NamedCounts>> counts = countAll(runners, work);
    if (!counts.ok()) {
        return counts.error();
    }
    for (Verdict& verdict : judgeCounts(*counts, poses)) {
        if (verdict.failed()) {
            verdict.rule += " (" + where + ")";
            verdict.sweep = toString(sweep);
            result.verdicts.push_back(std::move(verdict));
        }
    }
    return {};
}

Result<MeshData> sizedMesh(const std::string& source, std::uint32_t triangles) {
    return loadMesh(
        source.substr(0, source.find(':', std::string_view("builtin:").size())) + ":" + std::to_string(triangles), {});
}

void addPoints(Sweep sweep, const Runners& runners, const Work& work, std::vector<Point>& points) {
    const auto pairs = static_cast<std::uint32_t>(work.poses.size());
    for (const std::unique_ptr<MethodRunner>& runner : runners) {
        points.push_back(makePoint(sweep, *runner, work, Mode::Pipelined, pairs));
    }
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

/// The poses of the sweeps of triangles and fragments, and their numbers.
struct SweepPoses {
    std::vector<Mat4> poses;
    std::vector<std::uint32_t> numbers;
};

SweepPoses sweepPoses(const CompareData& data) {
    SweepPoses out;
    for (const std::uint32_t index : spreadEvenly(kSweepPairs, static_cast<std::uint32_t>(data.poses.size()))) {
        out.poses.push_back(data.poses[index]);
        out.numbers.push_back(data.poseNumbers[index]);
    }
    return out;
}

/// Times points whose counts were verified; nothing where one failed and the run is not to go on.
Result<void> measureVerified(std::vector<Point>& points, const CompareOptions& options, CompareResult& result,
                             const std::function<void()>& step) {
    if (result.firstFailure() != nullptr && !options.keepGoing) {
        return {};
    }
    Result<void> done = measure(points, options, result, step);
    collect(points, result);
    return done;
}

} // namespace

std::uint64_t stepsOf(Sweep /*sweep*/, std::uint32_t repeats) noexcept {
    return std::uint64_t{repeats} + 1;
}

Result<void> timeBatches(const CompareOptions& options, const Runners& runners, const Work& work, CompareResult& result,
                         const std::function<void()>& step) {
    std::array<std::vector<Mat4>, kBatches.size()> poses;
    const std::vector<Mat4> one = cycled(work.poses, work.poses.size());
    std::vector<Point> points;
    for (std::size_t i = 0; i < kBatches.size(); ++i) {
        const std::size_t batches =
            (std::max<std::size_t>(work.poses.size(), kBatches[i]) + kBatches[i] - 1) / kBatches[i];
        poses[i] = cycled(work.poses, batches * kBatches[i]);
        for (const std::unique_ptr<MethodRunner>& runner : runners) {
            const Work cut{work.subject, poses[i], work.view};
            points.push_back(makePoint(Sweep::Batch, *runner, cut, Mode::Pipelined, kBatches[i]));
        }
    }
    for (const std::unique_ptr<MethodRunner>& runner : runners) {
        points.push_back(makePoint(Sweep::Batch, *runner, {work.subject, one, work.view}, Mode::Sync, 1));
    }
    if (Result<void> done = measure(points, options, result, step); !done.ok()) {
        return done;
    }
    for (std::size_t i = points.size() - runners.size(), end = points.size(); i < end; ++i) {
        for (std::size_t batch = 1; batch < kBatches.size(); ++batch) {
            Point copy = points[i];
            copy.series = scaled(points[i].series, kBatches[batch]);
            points.push_back(std::move(copy));
        }
    }
    collect(points, result);
    return {};
}

Result<void> timeTriangles(const Session& session, const CompareOptions& options, const CompareData& data,
                           const Runners& runners, CompareResult& result, const std::function<void()>& step) {
    const std::string& source = options.meshes.sources.front();
    if (!source.starts_with("builtin:")) {
        result.notes.push_back("no sweep of triangles: the mesh is not a builtin one, which can be had in any size");
        return {};
    }
    const auto [poses, numbers] = sweepPoses(data);
    std::vector<std::unique_ptr<Subject>> subjects;
    std::vector<Point> points;
    for (const std::uint32_t triangles : kTriangles) {
        Result<MeshData> mesh = sizedMesh(source, triangles);
        if (!mesh.ok()) {
            result.notes.push_back("no point of " + std::to_string(triangles) + " triangles: " + mesh.error().text);
            continue;
        }
        Result<Subject> subject = makeSubject(session, std::move(*mesh));
        if (!subject.ok()) {
            return subject.error();
        }
        subjects.push_back(std::make_unique<Subject>(std::move(*subject)));
        const Work work{subjects.back().get(), poses, data.view};
        const std::string where = std::to_string(triangles) + " triangles";
        if (Result<void> verified = verifyPoint(runners, work, numbers, where, Sweep::Triangles, result);
            !verified.ok()) {
            return verified;
        }
        addPoints(Sweep::Triangles, runners, work, points);
    }
    return measureVerified(points, options, result, step);
}

Result<void> timeFragments(const Session& session, const CompareOptions& options, const CompareData& data,
                           const Subject& subject, const Runners& runners, CompareResult& result,
                           const std::function<void()>& step) {
    const VkExtent2D most = session.context.maxViewport();
    const auto [poses, numbers] = sweepPoses(data);
    std::vector<Point> points;
    for (const std::uint32_t side : kSides) {
        // The same camera on more pixels; a viewport that is not square keeps its shape.
        View view = data.view;
        view.width = side;
        view.height = std::max(1U, static_cast<std::uint32_t>(
                                       std::lround(static_cast<double>(side) * data.view.height / data.view.width)));
        if (view.width > most.width || view.height > most.height || view.height > cpu::kMaxViewport) {
            continue;
        }
        const Work work{&subject, poses, view};
        const std::string where = "--size " + std::to_string(view.width) + "x" + std::to_string(view.height);
        if (Result<void> verified = verifyPoint(runners, work, numbers, where, Sweep::Fragments, result);
            !verified.ok()) {
            return verified;
        }
        addPoints(Sweep::Fragments, runners, work, points);
    }
    return measureVerified(points, options, result, step);
}

} // namespace voxtact::app
