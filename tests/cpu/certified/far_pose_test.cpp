// SPDX-License-Identifier: MIT
// A mesh far outside is a certain miss, whatever memory held before: nothing that decides it may be read before it is
// written. Such a pair is *possible* only where its transform, or a vertex, is not what it was made to be. The tier
// runs with MALLOC_PERTURB_, too, which fills what malloc gives out.
#include "cpu/scenes/certified_scenes.h"

#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace voxtact::test {
namespace {

/// Fills freed memory, of the heap and of the stack below, with NaNs of whatever type.
void scribble() {
    std::vector<std::vector<unsigned char>> blocks;
    for (std::size_t bytes = 16; bytes <= std::size_t{1} << 20U; bytes *= 2) {
        for (int i = 0; i < 16; ++i) {
            blocks.emplace_back(bytes, static_cast<unsigned char>(0xff));
        }
    }
    volatile unsigned char stack[200000];
    for (volatile unsigned char& byte : stack) {
        byte = 0xff;
    }
}

/// Poses whose mesh, no larger than 200 mm, is clear of a volume of 1 m at the origin: near by, and up to 10^6 mm away.
std::vector<Mat4> farPoses(std::size_t count, std::mt19937_64& random) {
    std::vector<Mat4> poses;
    for (std::size_t i = 0; i < count; ++i) {
        Mat4 pose = randomRotation(random);
        Vec3 way{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        way[i % 3] = i % 2 == 0 ? 1 : -1;
        const double away = 1300 * std::pow(10, uniform(random, 0, 3));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose[12 + axis] = away * way[axis];
        }
        poses.push_back(pose);
    }
    return poses;
}

TEST(FarPose, IsACertainMissWhateverMemoryHeld) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    VolumeData image = take(makeBuiltinVolume("head:32"));
    const MeshData triangles = take(makeBuiltinMesh("scalpel:500"));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const std::vector<Mat4> far = farPoses(64, random);
    Mat4 nowhere = identity(); // beyond floats: no vertex is anywhere
    nowhere[0] = 1e300;
    Mat4 deep = identity();
    std::vector<Mat4> mixed;
    for (const Mat4& pose : far) {
        mixed.insert(mixed.end(), {nowhere, pose, deep});
    }
    for (const std::uint32_t threads : {1U, 4U}) {
        for (const bool stopAtFirst : {false, true}) {
            for (const bool outputs : {false, true}) {
                if (stopAtFirst && outputs) {
                    continue;
                }
                scribble();
                cpu::Detector detector =
                    take(cpu::Detector::create({.threads = threads,
                                                .stopAtFirst = stopAtFirst,
                                                .projection = Projection::Certified,
                                                .outputs = {.triangles = outputs, .contacts = outputs}}));
                const cpu::Mesh mesh = take(cpu::Mesh::create(triangles.view()));
                const cpu::Volume volume = take(cpu::Volume::create(image.view()));
                const cpu::TransferFunction function =
                    take(cpu::TransferFunction::create({points, {0, 255}, kDefaultTableSize}));
                const auto ask = [&](const std::vector<Mat4>& poses) {
                    scribble();
                    const cpu::BatchItem item{&mesh, &volume, &function, poses};
                    return take(detector.detect({{&item, 1}, {}, kDefaultThreshold})).pairs;
                };
                SCOPED_TRACE("seed " + std::to_string(seed) + ", threads " + std::to_string(threads));
                const auto isMiss = [&](const PairAnswer& pair) {
                    return !pair.hit && !pair.possible && pair.count == 0 &&
                           (stopAtFirst || pair.exactness == Exactness::Exact);
                };
                const std::vector<PairAnswer> among = ask(mixed);
                for (std::size_t i = 0; i < far.size(); ++i) {
                    EXPECT_TRUE(among[3 * i].possible) << "the pair beside it is to be one that is undecided";
                    EXPECT_TRUE(isMiss(among[3 * i + 1])) << i;
                    EXPECT_TRUE(among[3 * i + 2].hit);
                }
                const std::vector<PairAnswer> alone = ask(far);
                for (std::size_t i = 0; i < far.size(); ++i) {
                    EXPECT_TRUE(isMiss(alone[i])) << i;
                }
            }
        }
    }
}

} // namespace
} // namespace voxtact::test
