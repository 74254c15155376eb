// SPDX-License-Identifier: MIT
// Scenes whose counts are known, for the engine and the reference alike.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/count/reference.h"
#include "support/host_meters.h"

#include <gmock/gmock.h>

#include <cmath>

namespace voxtact::test {
namespace {

constexpr ValueRange kBytes{0, 255};

VolumeData solid(double value = 255) {
    return makeBytes(unitGrid(16), [value](auto...) { return value; });
}

/// The engine's count, after the reference has given the same.
std::uint64_t countOf(const MeshData& mesh, const VolumeData& volume, const View& view, double threshold = 0.5,
                      bool rangeTest = true) {
    const TransferFunctionDesc function{byteRamp(), kBytes};
    const std::uint64_t engine = engineCount(mesh.view(), volume.view(), function, view, threshold,
                                             {.boundary = rangeTest ? Boundary::Range : Boundary::Clamp});
    const std::uint64_t reference =
        cpu::referenceCounts({mesh.view(), volume.view(), function, view, identity(), threshold, rangeTest}).survivors;
    EXPECT_EQ(engine, reference);
    return engine;
}

TEST(Analytic, RectanglesCoverTheirPixels) {
    const View view = flatView(0, 1, 100, 100);
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 0.5), solid(), view), 10000U);
    EXPECT_EQ(countOf(makeFlat(0.25, 0.5, 0.1, 0.2, 0.5), solid(), view), 250U);
    EXPECT_EQ(countOf(makeFlat(-5, 5, -5, 5, 0.5), solid(), view), 10000U) << "beyond the viewport";
    EXPECT_EQ(countOf(makeFlat(0.251, 0.254, 0.251, 0.254, 0.5), solid(), view), 0U) << "between pixel centres";
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 1.01), solid(), view), 0U) << "outside of the volume";
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 1.01), solid(), view, 0.5, false), 10000U) << "clamped into it";
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 11), solid(), view), 0U) << "beyond the far plane";
}

TEST(Analytic, HalfOfAVolume) {
    const VolumeData half = makeBytes(unitGrid(64), [](std::uint32_t x, auto, auto) { return x < 32 ? 0.0 : 255.0; });
    // Linear between voxels 31 and 32: one half is reached at x = 0.5.
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 0.5), half, flatView(0, 1, 128, 128)), 64U * 128U);
    EXPECT_EQ(countOf(makeFlat(0, 1, 0, 1, 0.5), half, flatView(0, 1, 512, 512)), 256U * 512U);
}

TEST(Analytic, ThresholdsZeroAndOne) {
    const MeshData mesh = makeFlat(0, 1, 0, 1, 0.5);
    const View view = flatView(0, 1, 50, 50);
    EXPECT_EQ(countOf(mesh, solid(0), view, 0), 2500U) << "everything in the volume";
    EXPECT_EQ(countOf(mesh, solid(254), view, 1), 0U);
    EXPECT_EQ(countOf(mesh, solid(0), view, 1), 0U);
}

/// A rectangle of random triangles that share all their edges and cover nothing twice.
MeshData tessellated(std::size_t columns, std::size_t rows, double lo, double hi, double jitter, double z,
                     std::mt19937_64& random) {
    MeshData mesh;
    const auto place = [&](std::size_t at, std::size_t count) {
        const double moved =
            at == 0 || at == count ? 0.0 : uniform(random, -jitter, jitter) / static_cast<double>(count);
        return static_cast<float>(lo + (hi - lo) * (static_cast<double>(at) / static_cast<double>(count) + moved));
    };
    for (std::size_t row = 0; row <= rows; ++row) {
        for (std::size_t column = 0; column <= columns; ++column) {
            mesh.positions.insert(mesh.positions.end(),
                                  {place(column, columns), place(row, rows), static_cast<float>(z)});
        }
    }
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const auto a = static_cast<std::uint32_t>(row * (columns + 1) + column);
            const std::uint32_t b = a + 1;
            const auto c = static_cast<std::uint32_t>(a + columns + 1);
            const std::uint32_t d = c + 1;
            const bool slanted = chance(random, 0.5);
            for (const std::uint32_t corner : slanted ? std::array{a, b, d, d, c, a} : std::array{a, b, c, d, c, b}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    return mesh;
}

TEST(Analytic, SharedEdgesCountOnce) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        const std::size_t columns = 1 + below(random, 40);
        const std::size_t rows = 1 + below(random, 40);
        const auto width = static_cast<std::uint32_t>(1 + below(random, 300));
        const auto height = static_cast<std::uint32_t>(1 + below(random, 300));
        // Corners on pixel centres and pixel edges when there is no jitter: the hardest for the rule of edges.
        const double jitter = round % 3 == 0 ? 0 : 0.2;
        const bool huge = round % 5 == 0;
        const MeshData mesh = tessellated(columns, rows, huge ? -1e5 : -0.5, huge ? 1e5 : 1.5, jitter, 0.5, random);
        ASSERT_EQ(countOf(mesh, solid(), flatView(0, 1, width, height)), std::uint64_t{width} * height)
            << "round " << round << ": " << columns << "x" << rows << " on " << width << "x" << height;
    }
}

TEST(Analytic, SharedEdgesCountOnceInPerspective) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        // Some corners have a w of exactly one and their triangles none or one division by it, others have not; some
        // are beyond the far plane. Whatever is left covers every pixel once.
        MeshData mesh = tessellated(1 + below(random, 20), 1 + below(random, 20), -40, 40, 0.2, 1, random);
        for (std::size_t i = 2; i < mesh.positions.size(); i += 3) {
            mesh.positions[i] = chance(random, 0.5) ? 1.0F : static_cast<float>(uniform(random, 0.9, 1.1));
        }
        Mat4 clip_from_world{};
        clip_from_world[0] = uniform(random, 0.5, 2);
        clip_from_world[5] = uniform(random, 0.5, 2);
        clip_from_world[10] = 0.4;
        clip_from_world[14] = 0.1;
        clip_from_world[3] = round % 2 == 0 ? uniform(random, -0.02, 0.02) : 0;
        clip_from_world[11] = 1;
        const View view{clip_from_world, 64, 48};
        VolumeData volume = solid();
        volume.grid.spacing = {100, 100, 100};
        volume.grid.origin = {-750, -750, -750};
        const std::uint64_t count = countOf(mesh, volume, view, 0);
        ASSERT_EQ(count, 64U * 48U) << "round " << round;
    }
}

TEST(Analytic, NumbersBeyondReasonAreRefusedNotUndefined) {
    std::mt19937_64 random(testSeed());
    constexpr float kExtremes[] = {3e38F, -3e38F, 1e30F, -1e30F, 1e-38F, 1e-45F, 0, 1, -1, 1e19F, 0.5F};
    for (int round = 0; round < 500; ++round) {
        MeshData mesh;
        for (int i = 0; i < 90; ++i) {
            mesh.positions.push_back(kExtremes[below(random, std::size(kExtremes))]);
        }
        for (int i = 0; i < 120; ++i) {
            mesh.indices.push_back(static_cast<std::uint32_t>(below(random, 30)));
        }
        View view = flatView(0, 1, 8, 8);
        for (double& element : view.clip_from_world) {
            element = round % 2 == 0 ? element
                                     : static_cast<double>(kExtremes[below(random, std::size(kExtremes))]) +
                                           uniform(random, -1, 1);
        }
        if (inverse(view.clip_from_world).ok()) {
            countOf(mesh, solid(), view, 0, round % 3 != 0);
        }
    }
}

TEST(Analytic, AnswersSayWhatTheyAre) {
    const MeshData flat = makeFlat(0, 1, 0, 1, 0.5);
    const cpu::Mesh mesh = take(cpu::Mesh::create(flat.view()));
    const cpu::Volume volume = take(cpu::Volume::create(solid().view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), kBytes}));
    const Mat4 poses[] = {identity(), translation({0, 0, 5}), translation({0.5, 0, 0})};
    const cpu::BatchItem items[] = {{&mesh, &volume, &function, poses},
                                    {&mesh, &volume, &function, {}},
                                    {&mesh, &volume, &function, std::span(poses).first(1)}};
    for (const bool first : {false, true}) {
        cpu::Detector detector = take(cpu::Detector::create({.threads = 3, .stopAtFirst = first}));
        EXPECT_EQ(detector.threads(), 3U);
        const BatchAnswer answer = take(detector.detect({items, flatView(0, 1, 16, 16), 0.5}));
        ASSERT_EQ(answer.pairs.size(), 4U);
        const std::uint64_t counts[] = {256, 0, 128, 256};
        for (std::uint32_t i = 0; i < 4; ++i) {
            const PairAnswer& pair = answer.pairs[i];
            EXPECT_EQ(pair.pair, i);
            EXPECT_EQ(pair.item, i < 3 ? 0U : 2U);
            EXPECT_EQ(pair.pose, i < 3 ? i : 0U);
            EXPECT_EQ(pair.count, first ? std::min<std::uint64_t>(counts[i], 1) : counts[i]);
            EXPECT_EQ(pair.hit, counts[i] > 0);
            EXPECT_EQ(pair.exactness, first ? Exactness::LowerBound : Exactness::Exact);
            EXPECT_EQ(pair.method, CountingMethod::Cpu);
            EXPECT_EQ(pair.projection, Projection::View);
        }
        EXPECT_EQ(answer.gpuMilliseconds, 0);
        EXPECT_GT(answer.wallMilliseconds, 0);
        EXPECT_TRUE(take(detector.detect({{}, flatView(0, 1, 16, 16), 0.5})).pairs.empty());
    }
}

TEST(Analytic, CachedOccupancyFollowsFunctionVolumeAndThreshold) {
    const MeshData flat = makeFlat(0, 1, 0, 1, 0.5);
    const cpu::Mesh mesh = take(cpu::Mesh::create(flat.view()));
    const View view = flatView(0, 1, 16, 16);
    cpu::Detector detector = take(cpu::Detector::create());
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 100; ++round) {
        const double value = uniform(random, 0, 255);
        const cpu::Volume volume = take(cpu::Volume::create(solid(value).view()));
        for (int i = 0; i < 3; ++i) {
            const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), kBytes}));
            const double threshold = uniform(random, 0.01, 1);
            const Mat4 pose = identity();
            const cpu::BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
            const std::uint64_t count = take(detector.detect({std::span(&item, 1), view, threshold})).pairs[0].count;
            const double opacity = std::floor(value) / 255;
            if (std::abs(opacity - threshold) > 0.01) {
                EXPECT_EQ(count, opacity > threshold ? 256U : 0U);
            }
        }
    }
}

} // namespace
} // namespace voxtact::test
