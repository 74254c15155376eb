// SPDX-License-Identifier: MIT
#include "lab/compare_timing.h"

#include "lab/compare_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace voxtact::app {

namespace {

constexpr std::array<std::uint32_t, 4> kBatches{1, 16, 256, 1024};
/// Pairs of a point in the sweeps of triangles, fragments and voxels.
constexpr std::uint32_t kSweepPairs = 8;
constexpr double kGoldenRatio = 0.6180339887498949;
constexpr std::array<std::uint32_t, 6> kTriangles{256, 1024, 4096, 16384, 65536, 200000};
constexpr std::array<std::uint32_t, 6> kSides{64, 128, 256, 512, 1024, 2048};
/// Voxels a side of the volume, in quarters of the given one's.
constexpr std::array<std::uint32_t, 5> kQuarters{2, 3, 4, 6, 8};

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

/// A builtin of another size: "builtin:head:128" as "builtin:head:64".
std::string resized(const std::string& source, std::uint32_t size) {
    return source.substr(0, source.find(':', std::string_view("builtin:").size())) + ":" + std::to_string(size);
}

/// One volume of the sweep of voxels. The runners end before what they count in.
struct SizedVolume {
    Surroundings surroundings;
    Runners runners;
};

/// The volume of so many voxels a side with the methods of `like`; nothing, and a note, where it cannot be had.
Result<std::unique_ptr<SizedVolume>> sizedVolume(const Session& session, const CompareSettings& settings,
                                                 const CompareData& data, const Runners& like, std::uint32_t side,
                                                 CompareResult& result) {
    const std::string source = resized(data.volumeName, side);
    const Result<VolumeData> volume = settings.load.volume(source);
    if (!volume.ok()) {
        result.notes.push_back("no point of " + source + ": " + volume.error().text);
        return std::unique_ptr<SizedVolume>();
    }
    Result<Surroundings> surroundings = makeSurroundings(session, volume->view(), data.transferFunction());
    if (!surroundings.ok()) {
        const Error& why = surroundings.error();
        if (why.code != ErrorCode::LimitExceeded && why.code != ErrorCode::OutOfMemory) {
            return why;
        }
        result.notes.push_back("no point of " + source + ": " + why.text);
        return std::unique_ptr<SizedVolume>();
    }
    auto sized = std::make_unique<SizedVolume>(SizedVolume{std::move(*surroundings), {}});
    for (const std::unique_ptr<MethodRunner>& runner : like) {
        Result<std::unique_ptr<MethodRunner>> made =
            makeRunner(session, sized->surroundings, runner->method(), data.threshold);
        if (!made.ok()) {
            return made.error();
        }
        sized->runners.push_back(std::move(*made));
    }
    return sized;
}

/// The poses of the sweeps of triangles, fragments and voxels, and their numbers.
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

} // namespace

std::uint64_t stepsOf(Sweep sweep, std::uint32_t repeats) noexcept {
    // A volume takes longer to make than to be measured on.
    return std::uint64_t{repeats} + 1 + (sweep == Sweep::Voxels ? kQuarters.size() : 0);
}

Result<void> timeBatches(const CompareSettings& settings, const Runners& runners, const Work& work,
                         CompareResult& result, const std::function<void()>& step) {
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
    if (Result<void> done = measure(points, settings, result, step); !done.ok()) {
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

Result<void> timeTriangles(const Session& session, const CompareSettings& settings, const CompareData& data,
                           const Runners& runners, CompareResult& result, const std::function<void()>& step) {
    const std::string& source = data.meshName;
    if (!source.starts_with("builtin:")) {
        result.notes.push_back("no sweep of triangles: the mesh is not a builtin one, which can be had in any size");
        return {};
    }
    const auto [poses, numbers] = sweepPoses(data);
    std::vector<std::unique_ptr<Subject>> subjects;
    std::vector<Point> points;
    for (const std::uint32_t triangles : kTriangles) {
        Result<MeshData> mesh = settings.load.mesh(resized(source, triangles));
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
    return measureVerified(points, settings, result, step);
}

Result<void> timeFragments(const Session& session, const CompareSettings& settings, const CompareData& data,
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
    return measureVerified(points, settings, result, step);
}

Result<void> timeVoxels(const Session& session, const CompareSettings& settings, const CompareData& data,
                        const Subject& subject, const Runners& runners, CompareResult& result,
                        const std::function<void()>& step) {
    if (!data.volumeName.starts_with("builtin:")) {
        result.notes.push_back("no sweep of voxels: the volume is not a builtin one, which can be had in any size");
        return {};
    }
    const auto [poses, numbers] = sweepPoses(data);
    const Work work{&subject, poses, data.view};
    std::vector<std::unique_ptr<SizedVolume>> volumes;
    std::vector<Point> points;
    for (const std::uint32_t quarters : kQuarters) {
        const std::uint32_t side = data.volume.grid.size[0] * quarters / 4;
        Result<std::unique_ptr<SizedVolume>> sized = sizedVolume(session, settings, data, runners, side, result);
        if (!sized.ok()) {
            return sized.error();
        }
        step();
        if (*sized == nullptr) {
            continue;
        }
        const Runners& here = volumes.emplace_back(std::move(*sized))->runners;
        const std::string where = sizeText(here.front()->voxels()) + " voxels";
        if (Result<void> verified = verifyPoint(here, work, numbers, where, Sweep::Voxels, result); !verified.ok()) {
            return verified;
        }
        addPoints(Sweep::Voxels, here, work, points);
    }
    return measureVerified(points, settings, result, step);
}

} // namespace voxtact::app
