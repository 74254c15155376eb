// SPDX-License-Identifier: MIT
// How often the certified answer is `possible`, and what it costs: the built-in instruments, and the meshes that are
// named as arguments, in a real volume around the onset of contact; plates in faces and in planes of voxels' centres;
// triangles of a hundred thousand voxels and more. Prints one line a scene.
//
//   voxtact_possible_bench [MESH...]
//
// VOXTACT_BENCH_POSES are the poses a scene, VOXTACT_BENCH_THREADS the threads; see bench_input.h for others.
#include "bench/bench_input.h"
#include "cli/make/poses.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

namespace voxtact::test {
namespace {

constexpr std::uint64_t kSeed = 1;

using bench::numberFrom;
using bench::take;

struct Subject {
    VolumeData data;
    ValueRange domain;
    std::array<ControlPoint, 2> ramp;
    cpu::Volume volume;
    cpu::TransferFunction function;
};

Subject loadSubject() {
    VolumeData data = bench::volumeFromEnvironment();
    const ValueRange domain = take(checkVolume(data.view()));
    const std::array ramp = bench::rampFromEnvironment();
    cpu::Volume volume = take(cpu::Volume::create(data.view()));
    cpu::TransferFunction function = take(cpu::TransferFunction::create({.points = ramp, .domain = domain}));
    return {std::move(data), domain, ramp, std::move(volume), std::move(function)};
}

std::vector<PairAnswer> ask(cpu::Detector& detector, const Subject& subject, const cpu::Mesh& mesh,
                            std::span<const Mat4> poses) {
    const cpu::BatchItem item{&mesh, &subject.volume, &subject.function, poses};
    return take(detector.detect({.items = {&item, 1}, .view = {}, .threshold = kDefaultThreshold})).pairs;
}

cpu::Detector detectorOf(bool stopAtFirst) {
    cpu::DetectorDesc desc;
    desc.projection = Projection::Certified;
    desc.stopAtFirst = stopAtFirst;
    desc.threads = numberFrom("VOXTACT_BENCH_THREADS", 1);
    return take(cpu::Detector::create(desc));
}

void measure(const Subject& subject, const MeshView& view, std::span<const Mat4> poses, const std::string& name) {
    const cpu::Mesh mesh = take(cpu::Mesh::create(view));
    for (const bool stopAtFirst : {true, false}) {
        cpu::Detector detector = detectorOf(stopAtFirst);
        static_cast<void>(ask(detector, subject, mesh, poses.first(std::min<std::size_t>(8, poses.size()))));
        const std::clock_t start = std::clock();
        const std::vector<PairAnswer> pairs = ask(detector, subject, mesh, poses);
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        std::size_t hits = 0;
        std::size_t possible = 0;
        std::size_t open = 0;
        for (const PairAnswer& pair : pairs) {
            hits += pair.hit ? 1U : 0U;
            possible += pair.possible ? 1U : 0U;
            open += pair.exactness != Exactness::Exact ? 1U : 0U;
        }
        const auto all = static_cast<double>(pairs.size());
        std::printf("%-34s %-7s %7zu pairs %6.2f %% hit %7.3f %% possible %7.3f %% not exact %10.1f pairs/CPU s\n",
                    name.c_str(), stopAtFirst ? "yes/no" : "count", pairs.size(), 100 * static_cast<double>(hits) / all,
                    100 * static_cast<double>(possible) / all, 100 * static_cast<double>(open) / all, all / seconds);
        std::fflush(stdout);
    }
}

void measureOnset(const Subject& subject, const MeshView& view, std::uint32_t count, const std::string& name) {
    cpu::Detector detector = detectorOf(true);
    const cpu::Mesh mesh = take(cpu::Mesh::create(view));
    const auto touches = [&](const Mat4& pose) -> Result<bool> {
        return ask(detector, subject, mesh, {&pose, 1})[0].hit;
    };
    measure(subject, view, take(onsetPoses(subject.data.grid, view, count, kSeed, touches)), name + ", onset");
}

/// A rectangle in index space, in the plane `at` of an axis; corners on eighths of a voxel.
MeshData plate(const Grid& grid, std::mt19937_64& random, std::size_t axis, double at, double side) {
    const Mat4 world_from_index = worldFromIndex(grid);
    std::array<Vec3, 4> corners{};
    Vec3 from{};
    for (std::size_t i = 0; i < 3; ++i) {
        from[i] = std::round(8 * uniform(random, 0, grid.size[i] - 1.0 - side)) / 8;
    }
    from[axis] = at;
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (std::size_t i = 0; i < 4; ++i) {
        Vec3 corner = from;
        corner[u] += i == 1 || i == 2 ? side : 0;
        corner[v] += i >= 2 ? side : 0;
        corners[i] = transformPoint(world_from_index, corner);
    }
    return makeRectangle(corners[0], corners[1], corners[2], corners[3]);
}

void measureMany(const Subject& subject, std::uint32_t count, const std::string& name,
                 const std::function<MeshData(std::mt19937_64&)>& make) {
    std::mt19937_64 random(kSeed);
    cpu::Detector detector = detectorOf(true);
    const Mat4 pose = identity();
    std::size_t hits = 0;
    std::size_t possible = 0;
    const std::clock_t start = std::clock();
    for (std::uint32_t i = 0; i < count; ++i) {
        const MeshData data = make(random);
        const cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
        const PairAnswer answer = ask(detector, subject, mesh, {&pose, 1})[0];
        hits += answer.hit ? 1U : 0U;
        possible += answer.possible ? 1U : 0U;
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("%-34s %-7s %7u pairs %6.2f %% hit %7.3f %% possible %35.1f pairs/CPU s\n", name.c_str(), "yes/no",
                count, 100.0 * static_cast<double>(hits) / count, 100.0 * static_cast<double>(possible) / count,
                count / seconds);
    std::fflush(stdout);
}

void measurePlates(const Subject& subject, std::uint32_t count) {
    const Grid& grid = subject.data.grid;
    measureMany(subject, count, "plate in a face of the image", [&](std::mt19937_64& random) {
        const std::size_t axis = random() % 3;
        return plate(grid, random, axis, random() % 2 == 0 ? -0.5 : grid.size[axis] - 0.5, 20);
    });
    measureMany(subject, count, "plate in a plane of voxel centres", [&](std::mt19937_64& random) {
        const std::size_t axis = random() % 3;
        return plate(grid, random, axis, static_cast<double>(random() % grid.size[axis]), 4);
    });
    for (const double side : {1e4, 1e5, 1e7}) {
        char name[64];
        std::snprintf(name, sizeof name, "triangle of %.0e voxels", side);
        measureMany(subject, count, name, [&](std::mt19937_64& random) {
            const Mat4 turn = randomRotation(random);
            Vec3 about{};
            for (std::size_t i = 0; i < 3; ++i) {
                about[i] = uniform(random, -0.2, 1.2) * grid.size[i];
            }
            const Mat4 world_from_index = worldFromIndex(grid);
            std::array<Vec3, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                const double angle = 2 * 3.14159265358979 * static_cast<double>(i) / 3 + uniform(random, -0.3, 0.3);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    corners[i][axis] =
                        about[axis] + side * (std::cos(angle) * turn[axis] + std::sin(angle) * turn[4 + axis]);
                }
                corners[i] = transformPoint(world_from_index, corners[i]);
            }
            return makeRectangle(corners[0], corners[1], corners[2], corners[2]);
        });
    }
}

} // namespace
} // namespace voxtact::test

int main(int count, char** arguments) {
    using namespace voxtact;
    const test::Subject subject = test::loadSubject();
    const std::uint32_t poses = test::numberFrom("VOXTACT_BENCH_POSES", 1000);
    std::printf("%s, ramp %g to %g, threshold %g\n", subject.data.name.c_str(), subject.ramp[0].value,
                subject.ramp[1].value, kDefaultThreshold);
    for (const char* name : {"scalpel:3068", "ellipsoid:49998"}) {
        const MeshData mesh = test::take(makeBuiltinMesh(name));
        test::measureOnset(subject, mesh.view(), poses, name);
    }
#ifdef VOXTACT_BENCH_IO
    for (int i = 1; i < count; ++i) {
        const MeshData mesh = test::take(io::readMesh(arguments[i]));
        test::measureOnset(subject, mesh.view(), poses, mesh.name);
    }
#else
    static_cast<void>(count);
    static_cast<void>(arguments);
#endif
    test::measurePlates(subject, poses);
    return 0;
}
