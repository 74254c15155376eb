// SPDX-License-Identifier: MIT
// Clearance and motion against what people use today, in one run and on one thread: FCL's distance and continuous
// collision of a mesh and an octree of the opaque voxels, and ITK's Euclidean distance transform of these voxels,
// looked up at the mesh's vertices. Says how far each is off, by the bounds of a cpu::ClearanceMeter, which are checked
// first.
//
//   voxtact_clearance_bench [MESH]
//
// MESH is a built-in one (scalpel). VOXTACT_BENCH_POSES are the poses that are drawn; see bench_input.h for others.
#include "bench/bench_input.h"
#include "bench/distance_map.h"
#include "bench/engines/engine.h"
#include "bench/engines/opaque_cells.h"
#include "bench/measure/machine.h"
#include "bench/measure/numbers.h"
#include "bench/measure/stopwatch.h"
#include "cli/make/poses.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace voxtact::bench {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kFarthest = 50;  // mm
constexpr int kRounds = 3;        // of each measurement: the median, the least and the most
constexpr std::size_t kSlow = 60; // poses for what takes long
constexpr double kWay = 10;       // mm
constexpr double kTurn = 5;       // degrees

struct Scene {
    lab::VolumePart volume;
    lab::OpaqueCells cells;
    Mat4 cells_from_world{};
    MeshData data;
    std::vector<Mat4> poses; // that do not touch, at most kFarthest away
    std::vector<PairDistance> truth;
    std::optional<cpu::Mesh> mesh;

    [[nodiscard]] std::vector<cpu::BatchItem> items(const cpu::TransferFunction& function,
                                                    std::span<const Mat4> at) const {
        return {{.mesh = &*mesh, .volume = &*volume.host, .transferFunction = &function, .world_from_object = at}};
    }
    [[nodiscard]] std::vector<cpu::BatchItem> items(std::span<const Mat4> at) const {
        return items(*volume.hostFunction, at);
    }
};

cpu::Batch batchOf(const std::vector<cpu::BatchItem>& items) {
    return {.items = items, .view = {}, .threshold = kDefaultThreshold};
}

lab::VolumePart loadPart() {
    lab::VolumePart part;
    part.data = volumeFromEnvironment();
    part.name = part.data.name;
    part.domain = take(checkVolume(part.data.view()));
    const auto ramp = rampFromEnvironment();
    part.points.assign(ramp.begin(), ramp.end());
    part.host = take(cpu::Volume::create(part.data.view()));
    part.hostFunction = take(cpu::TransferFunction::create(part.transferFunction()));
    return part;
}

cpu::ClearanceMeter meterOf(double maximum) {
    return take(cpu::ClearanceMeter::create({.threads = 1, .maximum = maximum}));
}

Scene loadScene(const char* mesh) {
    Scene scene;
    scene.volume = loadPart();
    scene.cells = take(lab::opaqueCells(scene.volume.data.view(), scene.volume.transferFunction(), kDefaultThreshold));
    scene.cells_from_world = take(inverse(scene.cells.world_from_cells));
    scene.data = take(makeBuiltinMesh(mesh));
    scene.mesh = take(cpu::Mesh::create(scene.data.view()));
    const std::vector<Mat4> drawn =
        randomPoses(scene.volume.data.grid, scene.data.view(), numberFrom("VOXTACT_BENCH_POSES", 2000), kSeed);
    cpu::ClearanceMeter meter = meterOf(kFarthest);
    for (const PairDistance& pair : take(meter.measure(batchOf(scene.items(drawn)))).pairs) {
        if (pair.bounds.lower > 0 && pair.end == StopReason::Closed && std::isfinite(pair.bounds.upper)) {
            scene.poses.push_back(drawn[pair.pose]);
            scene.truth.push_back(pair);
        }
    }
    return scene;
}

double distanceOf(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Vec3> verticesAt(const Scene& scene, const Mat4& pose) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < scene.data.positions.size(); i += 3) {
        const double* at = scene.data.positions.data() + i;
        out.push_back(transformPoint(pose, {at[0], at[1], at[2]}));
    }
    return out;
}

/// Ends the program where an opaque voxel's centre is nearer to a vertex than the bounds of a pair say, or the closest
/// points are not as far apart as they say.
void verify(const Scene& scene) {
    std::vector<Vec3> opaque;
    std::size_t cell = 0;
    for (std::uint32_t z = 0; z < scene.cells.size[2]; ++z) {
        for (std::uint32_t y = 0; y < scene.cells.size[1]; ++y) {
            for (std::uint32_t x = 0; x < scene.cells.size[0]; ++x, ++cell) {
                if (scene.cells.opaque[cell] && cell % 7 == 0) {
                    const double side = scene.cells.side;
                    opaque.push_back(transformPoint(scene.cells.world_from_cells,
                                                    {(x + 0.5) * side, (y + 0.5) * side, (z + 0.5) * side}));
                }
            }
        }
    }
    const std::size_t checked = std::min<std::size_t>(scene.poses.size(), 8);
    for (std::size_t i = 0; i < checked; ++i) {
        const PairDistance& pair = scene.truth[i];
        double least = std::numeric_limits<double>::infinity();
        for (const Vec3& vertex : verticesAt(scene, scene.poses[i])) {
            for (const Vec3& voxel : opaque) {
                least = std::min(least, distanceOf(vertex, voxel));
            }
        }
        const double between = distanceOf(pair.closest->mesh, pair.closest->volume);
        // Cells of another size than the voxels have the value of a voxel that is up to a diagonal away.
        const double slack = scene.cells.resampled ? std::sqrt(3.0) * scene.cells.side : 1e-9;
        if (least < pair.bounds.lower - slack || std::abs(between - pair.bounds.upper) > 1e-6) {
            std::fprintf(stderr, "pose %zu: %.9g mm to a voxel, %.9g between the closest points, bounds %.9g, %.9g\n",
                         i, least, between, pair.bounds.lower, pair.bounds.upper);
            std::exit(1);
        }
    }
    std::printf("checked: %zu poses, vertices against every seventh of %zu opaque voxels\n", checked,
                static_cast<std::size_t>(std::ranges::count(scene.cells.opaque, true)));
}

/// Milliseconds that `work` takes, so many times.
lab::Spread timed(const std::function<void()>& work) {
    std::vector<double> samples;
    for (int round = 0; round < kRounds; ++round) {
        const lab::Stopwatch watch;
        work();
        samples.push_back(watch.milliseconds());
    }
    return lab::spreadOf(samples);
}

void printRate(const char* name, std::size_t things, const lab::Spread& milliseconds) {
    const double all = 1000 * static_cast<double>(things);
    std::printf("%-50s %9s per second (%s to %s), %zu\n", name, lab::shortNumber(all / milliseconds.median).c_str(),
                lab::shortNumber(all / milliseconds.max).c_str(), lab::shortNumber(all / milliseconds.min).c_str(),
                things);
    std::fflush(stdout);
}

/// By how much an estimate is outside of the bounds; positive where it is too large.
struct Errors {
    std::vector<double> sizes;
    std::size_t above = 0;
    std::size_t farAbove = 0; // by more than half a side of a voxel
    double most = 0;
    double least = 0;

    void take(double estimate, const Bounds& bounds, double side) {
        const double error = estimate > bounds.upper   ? estimate - bounds.upper
                             : estimate < bounds.lower ? estimate - bounds.lower
                                                       : 0;
        sizes.push_back(std::abs(error));
        above += error > 0 ? 1U : 0U;
        farAbove += error > side / 2 ? 1U : 0U;
        most = std::max(most, error);
        least = std::min(least, error);
    }
};

void printErrors(const char* name, const Errors& errors) {
    if (errors.sizes.empty()) {
        return;
    }
    const auto all = static_cast<double>(errors.sizes.size());
    std::printf("%-50s off by %.3g mm in the median, %+.3g to %+.3g; too large for %.3g %%, by more than half a voxel "
                "for %.3g %%; %zu poses\n",
                name, lab::medianOf(errors.sizes), errors.least, errors.most,
                100 * static_cast<double>(errors.above) / all, 100 * static_cast<double>(errors.farAbove) / all,
                errors.sizes.size());
}

void measureClearance(const Scene& scene) {
    const auto run = [&](const char* name, double maximum) {
        cpu::ClearanceMeter meter = meterOf(maximum);
        printRate(name, scene.poses.size(),
                  timed([&] { static_cast<void>(take(meter.measure(batchOf(scene.items(scene.poses))))); }));
    };
    run("clearance to 0.01 mm", std::numeric_limits<double>::infinity());
    run("clearance of at most 5 mm", 5);
    cpu::ClearanceMeter meter = meterOf(std::numeric_limits<double>::infinity());
    printRate("margin of 2 mm", scene.poses.size(),
              timed([&] { static_cast<void>(take(meter.within(batchOf(scene.items(scene.poses)), 2))); }));
}

void measureFclDistance(const Scene& scene) {
    const lab::FclDistance fcl = scene.volume.fcl->distance({scene.data.positions, scene.data.indices});
    const std::size_t poses = std::min(kSlow, scene.poses.size());
    Errors errors;
    std::size_t touching = 0;
    const lab::Stopwatch watch; // once: it takes long
    std::vector<double> found;
    for (std::size_t i = 0; i < poses; ++i) {
        found.push_back(fcl(scene.poses[i]));
    }
    const double milliseconds = watch.milliseconds();
    printRate("FCL distance(), octree", poses, {milliseconds, milliseconds, milliseconds, milliseconds, milliseconds});
    // What cubes for voxels explain: a cube reaches half a diagonal beyond its centre, which is opaque; what is opaque
    // reaches a diagonal beyond the last such centre.
    const double explained = std::sqrt(3.0) * scene.cells.side;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < poses; ++i) {
        touching += found[i] < 0 ? 1U : 0U;
        const Bounds& bounds = scene.truth[i].bounds;
        if (found[i] >= 0) {
            errors.take(found[i], bounds, scene.cells.side);
        }
        const double least = std::max(0.0, bounds.lower - explained);
        wrong += std::max(0.0, found[i]) < least || found[i] > bounds.upper + explained ? 1U : 0U;
    }
    printErrors("FCL distance(), octree", errors);
    std::printf("%-50s touching where nothing does: %zu of %zu; off by more than a voxel's diagonal: %zu\n", "",
                touching, poses, wrong);
}

/// What is known of an image's inside alone.
bool isInside(const Scene& scene, const Vec3& cells) {
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inside = inside && cells[axis] >= 0 && cells[axis] <= scene.cells.size[axis] * scene.cells.side;
    }
    return inside;
}

/// The least distance of the vertices that are in the image.
double lookUp(const Scene& scene, const DistanceMap& map, const Mat4& pose) {
    const double side = scene.cells.side;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& at : verticesAt(scene, multiply(scene.cells_from_world, pose))) {
        least = isInside(scene, at) ? std::min(least, map.at({at[0] / side, at[1] / side, at[2] / side})) : least;
    }
    return least;
}

/// Milliseconds until the first clearance under a new transfer function is known.
lab::Spread changedFunction(const Scene& scene) {
    std::vector<double> samples;
    for (int round = 0; round < 3 * kRounds; ++round) {
        std::vector<ControlPoint> points = scene.volume.points;
        points.front().value += 0.01 * (round + 1);
        cpu::ClearanceMeter meter = meterOf(std::numeric_limits<double>::infinity());
        const Mat4& pose = scene.poses[static_cast<std::size_t>(round) % scene.poses.size()];
        const lab::Stopwatch watch;
        const cpu::TransferFunction changed =
            take(cpu::TransferFunction::create({.points = points, .domain = scene.volume.domain}));
        static_cast<void>(take(meter.measure(batchOf(scene.items(changed, {&pose, 1})))));
        samples.push_back(watch.milliseconds());
    }
    return lab::spreadOf(samples);
}

void measureDistanceMap(const Scene& scene) {
    const char* name = "distance transform, looked up at vertices";
    std::optional<DistanceMap> map;
    const lab::Spread build = timed([&] { map.emplace(scene.cells.size, scene.cells.side, scene.cells.opaque); });
    std::vector<double> found(scene.poses.size());
    printRate(name, found.size(), timed([&] {
                  for (std::size_t i = 0; i < found.size(); ++i) {
                      found[i] = lookUp(scene, *map, scene.poses[i]);
                  }
              }));
    Errors errors;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (isInside(scene, transformPoint(scene.cells_from_world, scene.truth[i].closest->mesh))) {
            errors.take(std::max(0.0, found[i]), scene.truth[i].bounds, scene.cells.side);
        }
    }
    printErrors(name, errors);
    std::printf("%-50s nearest outside of the image, where it knows nothing: %zu of %zu\n", "",
                found.size() - errors.sizes.size(), found.size());
    const lab::Spread next = changedFunction(scene);
    std::printf(
        "%-50s %.4g ms for the distance transform (%.4g to %.4g), %.3g ms for the next clearance (%.3g to %.3g): "
        "%.3g times\n",
        "after a new transfer function", build.median, build.min, build.max, next.median, next.min, next.max,
        build.median / next.median);
}

/// A pose kWay away in a random direction, turned by kTurn about a random axis through the mesh's origin.
Mat4 moved(const Mat4& pose, std::mt19937_64& random) {
    const Mat4 way = test::randomRotation(random);
    const Mat4 frame = test::randomRotation(random);
    const double angle = kTurn * 3.14159265358979323846 / 180;
    Mat4 turn = identity();
    turn[0] = turn[5] = std::cos(angle);
    turn[1] = std::sin(angle);
    turn[4] = -turn[1];
    Mat4 out = multiply(pose, multiply(frame, multiply(turn, take(inverse(frame)))));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[12 + axis] += kWay * way[axis];
    }
    return out;
}

using Way = std::array<Mat4, 2>;

/// What FCL says of the ways, compared with what is certain.
void measureFclMotions(const Scene& scene, const std::vector<Way>& ways, const std::vector<SegmentMotion>& truth) {
    const lab::FclMotion fcl = scene.volume.fcl->motion({scene.data.positions, scene.data.indices});
    std::printf("%-50s returns %g\n", "FCL continuousCollide(), conservative advancement",
                fcl(ways[0][0], ways[0][1], lab::FclOnTheWay::Advance, 0));
    for (const unsigned poses : {10U, 100U}) {
        std::vector<double> at(ways.size());
        const std::string name = "FCL continuousCollide(), naive, " + std::to_string(poses) + " poses";
        printRate(name.c_str(), ways.size(), timed([&] {
                      for (std::size_t i = 0; i < ways.size(); ++i) {
                          at[i] = fcl(ways[i][0], ways[i][1], lab::FclOnTheWay::Poses, poses);
                      }
                  }));
        std::size_t missed = 0;
        std::size_t claimed = 0;
        std::vector<double> late;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            missed += truth[i].touch && at[i] >= 1 ? 1U : 0U;
            claimed += truth[i].freeUntil == 1 && at[i] < 1 ? 1U : 0U;
            if (truth[i].touch && at[i] < 1) {
                late.push_back(kWay * (at[i] - truth[i].touch->at));
            }
        }
        const lab::Spread way = late.empty() ? lab::Spread{} : lab::spreadOf(late);
        std::printf(
            "%-50s %zu contacts missed, %zu where it is free; the first contact is %+.3g mm along the way off in "
            "the median (%+.3g to %+.3g)\n",
            "", missed, claimed, way.median, way.min, way.max);
    }
}

void measureMotions(const Scene& scene) {
    std::mt19937_64 random(kSeed);
    std::vector<Way> ways;
    for (const Mat4& pose : scene.poses) {
        ways.push_back({pose, moved(pose, random)});
    }
    std::vector<cpu::BatchItem> items;
    for (const Way& way : ways) {
        items.push_back(scene.items(way).front());
    }
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    MotionAnswer answer;
    printRate("motions of 10 mm and 5 degrees", ways.size(),
              timed([&] { answer = take(checker.check(batchOf(items))); }));
    std::printf("%-50s %zu touch, %zu are free\n", "",
                static_cast<std::size_t>(
                    std::ranges::count_if(answer.segments, [](const auto& one) { return one.touch.has_value(); })),
                static_cast<std::size_t>(
                    std::ranges::count_if(answer.segments, [](const auto& one) { return one.freeUntil == 1; })));
    if (scene.volume.fcl != nullptr) {
        measureFclMotions(scene, ways, answer.segments);
    }
}

} // namespace
} // namespace voxtact::bench

int main(int count, char** arguments) {
    using namespace voxtact::bench;
    Scene scene = loadScene(count > 1 ? arguments[1] : "scalpel");
    const std::string fcl = voxtact::lab::makeOctree(scene.volume);
    std::printf(
        "%s, %s with %zu triangles, seed %llu: %zu poses that do not touch, up to %g mm away\n%s, one thread\n%s\n%s\n",
        scene.volume.name.c_str(), scene.data.name.c_str(), scene.data.indices.size() / 3,
        static_cast<unsigned long long>(kSeed), scene.poses.size(), kFarthest,
        voxtact::lab::describeHost({}).cpu.c_str(), fcl.c_str(), DistanceMap::version().c_str());
    if (scene.poses.empty()) {
        std::fprintf(stderr, "no pose is near without touching: more poses (VOXTACT_BENCH_POSES), or another volume\n");
        return 1;
    }
    verify(scene);
    measureClearance(scene);
    measureDistanceMap(scene);
    measureMotions(scene);
    if (scene.volume.fcl != nullptr) {
        measureFclDistance(scene);
    }
    return 0;
}
