// SPDX-License-Identifier: MIT
#include "lab/compare/compare_timing.h"

#include "core/try.h"
#include "lab/compare/compare_points.h"

#include <algorithm>
#include <array>
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

/// The volume of so many voxels a side, ready; null, and a note, where it cannot be had.
Result<std::shared_ptr<VolumePart>> sizedVolume(const Session& session, const CompareSettings& settings,
                                                const VolumePart& like, std::uint32_t side, CompareResult& result) {
    const auto sized = std::make_shared<VolumePart>();
    sized->name = resized(like.name, side);
    sized->points = like.points;
    sized->domain = like.domain;
    sized->tableSize = like.tableSize;
    sized->threshold = like.threshold;
    Result<VolumeData> data = settings.load.volume(sized->name);
    if (!data.ok()) {
        result.notes.push_back("no point of " + sized->name + ": " + data.error().text);
        return std::shared_ptr<VolumePart>();
    }
    sized->data = std::move(*data);
    if (Result<void> ready = makeReady(session, {}, *sized); !ready.ok()) {
        const Error& why = ready.error();
        if (why.code != ErrorCode::LimitExceeded && why.code != ErrorCode::OutOfMemory) {
            return why;
        }
        result.notes.push_back("no point of " + sized->name + ": " + why.text);
        return std::shared_ptr<VolumePart>();
    }
    // In both engines by now, and as many bytes as either.
    sized->data.voxels = {};
    return sized;
}

/// Of the sweeps of triangles, fragments and voxels: what they time once it was verified.
class SweptPoints {
  public:
    SweptPoints(Sweep sweep, const Engines& engines, const Scene& scene, CompareResult& result)
        : sweep_(sweep), engines_(engines), some_(scene.withPoses(kSweepPairs)), result_(result) {}

    /// Of the poses that are swept; what it is given must outlive it.
    Result<void> add(const VolumePart& volume, const MeshPart& mesh, const View& view, const std::string& where) {
        const Work work{volume, mesh, some_.poses, view};
        VOXTACT_TRY(verifyPoint(engines_, work, some_.poseNumbers, where, sweep_, result_));
        addPoints(sweep_, engines_, work, points_);
        return {};
    }
    Result<void> measure(const CompareSettings& settings, const std::function<void()>& step) {
        return measureVerified(points_, settings, result_, step);
    }

  private:
    Sweep sweep_;
    const Engines& engines_;
    Scene some_;
    CompareResult& result_;
    std::vector<Point> points_;
};

} // namespace

std::uint64_t stepsOf(Sweep sweep, std::uint32_t repeats) noexcept {
    // A volume takes longer to make than to be measured on.
    return std::uint64_t{repeats} + 1 + (sweep == Sweep::Voxels ? kQuarters.size() : 0);
}

Result<void> timeBatches(const CompareSettings& settings, const Engines& engines, const Work& work,
                         CompareResult& result, const std::function<void()>& step) {
    std::array<std::vector<Mat4>, kBatches.size()> poses;
    const std::vector<Mat4> one = cycled(work.poses, work.poses.size());
    std::vector<Point> points;
    for (std::size_t i = 0; i < kBatches.size(); ++i) {
        const std::size_t batches =
            (std::max<std::size_t>(work.poses.size(), kBatches[i]) + kBatches[i] - 1) / kBatches[i];
        poses[i] = cycled(work.poses, batches * kBatches[i]);
        for (const std::unique_ptr<Engine>& engine : engines) {
            points.push_back(makePoint(Sweep::Batch, *engine, work.at(poses[i]), Mode::Pipelined, kBatches[i]));
        }
    }
    for (const std::unique_ptr<Engine>& engine : engines) {
        points.push_back(makePoint(Sweep::Batch, *engine, work.at(one), Mode::Sync, 1));
    }
    VOXTACT_TRY(measure(points, settings, result, step));
    for (std::size_t i = points.size() - engines.size(), end = points.size(); i < end; ++i) {
        for (std::size_t batch = 1; batch < kBatches.size(); ++batch) {
            Point copy = points[i];
            copy.series = scaled(points[i].series, kBatches[batch]);
            points.push_back(std::move(copy));
        }
    }
    collect(points, result);
    return {};
}

Result<void> timeTriangles(const Session& session, const CompareSettings& settings, const Scene& scene,
                           const Engines& engines, CompareResult& result, const std::function<void()>& step) {
    if (!scene.mesh->name.starts_with("builtin:")) {
        result.notes.push_back("no sweep of triangles: the mesh is not a builtin one, which can be had in any size");
        return {};
    }
    std::vector<std::unique_ptr<MeshPart>> meshes;
    SweptPoints points(Sweep::Triangles, engines, scene, result);
    for (const std::uint32_t triangles : kTriangles) {
        Result<MeshData> data = settings.load.mesh(resized(scene.mesh->name, triangles));
        if (!data.ok()) {
            result.notes.push_back("no point of " + std::to_string(triangles) + " triangles: " + data.error().text);
            continue;
        }
        MeshPart& mesh = *meshes.emplace_back(std::make_unique<MeshPart>());
        mesh.data = std::move(*data);
        VOXTACT_TRY(makeReady(&session, mesh));
        const std::string where = std::to_string(triangles) + " triangles";
        VOXTACT_TRY(points.add(*scene.volume, mesh, scene.view, where));
    }
    return points.measure(settings, step);
}

Result<void> timeFragments(const Session& session, const CompareSettings& settings, const Scene& scene,
                           const Engines& engines, CompareResult& result, const std::function<void()>& step) {
    const VkExtent2D most = session.context.maxViewport();
    SweptPoints points(Sweep::Fragments, engines, scene, result);
    for (const std::uint32_t side : kSides) {
        View view = scene.view;
        view.width = side;
        view.height = static_cast<std::uint32_t>(
            std::max(1L, std::lround(static_cast<double>(side) * scene.view.height / scene.view.width)));
        if (view.width > most.width || view.height > most.height || view.height > cpu::kMaxViewport) {
            continue;
        }
        const std::string where = "--size " + std::to_string(view.width) + "x" + std::to_string(view.height);
        VOXTACT_TRY(points.add(*scene.volume, *scene.mesh, view, where));
    }
    return points.measure(settings, step);
}

Result<void> timeVoxels(const Session& session, const CompareSettings& settings, const Scene& scene,
                        const Engines& engines, CompareResult& result, const std::function<void()>& step) {
    if (!scene.volume->name.starts_with("builtin:")) {
        result.notes.push_back("no sweep of voxels: the volume is not a builtin one, which can be had in any size");
        return {};
    }
    std::vector<std::shared_ptr<VolumePart>> volumes;
    SweptPoints points(Sweep::Voxels, engines, scene, result);
    for (const std::uint32_t quarters : kQuarters) {
        const std::uint32_t side = scene.volume->data.grid.size[0] * quarters / 4;
        Result<std::shared_ptr<VolumePart>> sized = sizedVolume(session, settings, *scene.volume, side, result);
        VOXTACT_TRY(sized);
        step();
        if (*sized == nullptr) {
            continue;
        }
        const VolumePart& volume = *volumes.emplace_back(std::move(*sized));
        const std::string where = sizeText(volume.data.grid.size) + " voxels";
        VOXTACT_TRY(points.add(volume, *scene.mesh, scene.view, where));
    }
    return points.measure(settings, step);
}

} // namespace voxtact::lab
