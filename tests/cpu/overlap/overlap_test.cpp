// SPDX-License-Identifier: MIT
// Overlaps that are known beforehand; what counts as a solid; and containment.
#include "cpu/overlap/known_scenes.h"
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"
#include "cpu/scenes/random_scene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST(Overlap, IsWhatIsKnown) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    std::size_t open = 0;
    for (std::size_t round = 0; round < randomCases(4000, 50); ++round) {
        for (const auto make : {halfSpaceScene, boxScene, saddleScene}) {
            const KnownScene known = make(random);
            SCOPED_TRACE(known.name + " " + std::to_string(round));
            const double whole = std::abs(signedVolume(known.scene.mesh, known.scene.world_from_object));
            const double tolerance = 1e-3 * whole;
            const PairOverlap found = overlap(known.scene, tolerance);
            // A face of the mesh may lie exactly in a face of the image: rounding then decides.
            const bool isClosed = found.end == StopReason::Closed;
            expectVolume(known.wanted, found.bounds, isClosed ? tolerance : whole, known.slack);
            expectVolume(whole, found.solid, tolerance, 1e-9 * whole);
            open += isClosed ? 0 : 1;
            EXPECT_TRUE(found.inside != Containment::None || found.bounds.lower == 0);
            some += found.bounds.lower > 0 && found.bounds.upper < 0.99 * whole ? 1 : 0;
            ASSERT_FALSE(HasFailure());
        }
    }
    EXPECT_GT(some, randomCases(4000, 50));
    EXPECT_LE(open, 2 + randomCases(4000, 50) / 100);
}

TEST(Overlap, OfBallsIsALens) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 8; ++round) {
        const KnownScene known = lensScene(random);
        const PairOverlap found = overlap(known.scene, 1);
        expectVolume(known.wanted, found.bounds, 1, known.slack);
        EXPECT_EQ(found.end, StopReason::Closed);
    }
}

/// Of a half space the bands' limits are planes: each band is what lies between two, and from a limit on they add up to
/// what is opaque there.
TEST(Overlap, OfBandsIsWhatIsKnown) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE(round);
        const KnownScene known = halfSpaceScene(random);
        const double whole = std::abs(signedVolume(known.scene.mesh, known.scene.world_from_object));
        const double at = known.scene.points.front().value;
        const OverlapAnswer found =
            overlaps(known.scene, {.tolerance = 1e-3 * whole, .bandLimits = {at - 9, at, at + 3.5}});
        ASSERT_EQ(found.bands.size(), 4U);
        double above = 0;
        for (std::uint32_t band = 4; band-- > 0;) {
            OracleScene scene = known.scene;
            const double limit = band == 0 ? -32768 : at + (band == 1 ? -9 : (band == 2 ? 0 : 3.5));
            scene.points = opaqueFrom(limit);
            const PairOverlap from = overlap(scene, 1e-3 * whole);
            const BandOverlap& in = found.bands[band];
            EXPECT_EQ(in.band, band);
            EXPECT_EQ(in.end, StopReason::Closed);
            EXPECT_LE(in.bounds.upper - in.bounds.lower, 1e-3 * whole);
            EXPECT_LE(in.bounds.lower, from.bounds.upper - above);
            EXPECT_GE(in.bounds.upper + 4e-3 * whole, from.bounds.lower - above);
            above += in.bounds.lower;
        }
        expectVolume(whole, {above, above + 4e-3 * whole}, whole, 1e-9 * whole);
        expectVolume(known.wanted,
                     {found.bands[2].bounds.lower + found.bands[3].bounds.lower,
                      found.bands[2].bounds.upper + found.bands[3].bounds.upper},
                     whole, known.slack);
    }
}

/// In an image that is opaque all over it is the volume of the mesh, to the last bit: vertices are whole 128ths, far
/// from their object's origin.
TEST(Overlap, HasItsRoundingsCountedIn) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        const double far = round % 2 == 0 ? 0 : 65536;
        const double side = std::ldexp(1, static_cast<int>(below(random, 6)));
        const MeshData mesh =
            mapped(transformed(round % 3 == 0 ? solidBall(side, 1) : solidPrism(5, side, side), randomRotation(random)),
                   [&](const Vec3& at) {
                       const auto snapped = [&](double x) { return far + std::round(128 * x) / 128; };
                       return Vec3{snapped(at[0]), snapped(at[1]), snapped(at[2])};
                   });
        Mat4 pose = randomRotation(random);
        const Vec3 there = transformPoint(pose, {far, far, far});
        long double truth = signedVolume(mapped(mesh, [&](const Vec3& at) {
            return Vec3{128 * (at[0] - far), 128 * (at[1] - far), 128 * (at[2] - far)};
        }));
        long double determinant = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            pose[12 + i] = 40 - there[i];
            const auto of = [&](std::size_t c, std::size_t r) { return static_cast<long double>(pose[4 * c + r % 3]); };
            determinant += of(0, i) * (of(1, i + 1) * of(2, i + 2) - of(1, i + 2) * of(2, i + 1));
        }
        truth *= determinant / (128 * 128 * 128);
        OracleScene scene = opaqueScene(mesh, 80);
        scene.world_from_object = pose;
        const PairOverlap found = overlap(scene);
        for (const Bounds& bounds : {found.bounds, found.solid}) {
            EXPECT_LE(static_cast<long double>(bounds.lower), truth * (1 + 1e-17L)) << round;
            EXPECT_GE(static_cast<long double>(bounds.upper), truth * (1 - 1e-17L)) << round;
            EXPECT_LE(bounds.upper - bounds.lower, 1e-3) << round;
        }
        const Overlap boxed{.tolerance = 1e-9};
        const OracleScene box = opaqueScene(solidBox({1, 2, 3.25}, {1 + side / 4, 4.125, 3.5 + side / 8}));
        const Bounds exact = overlaps(box, boxed).pairs.at(0).bounds;
        EXPECT_LE(exact.lower, side / 4 * 2.125 * (0.25 + side / 8));
        EXPECT_GE(exact.upper, side / 4 * 2.125 * (0.25 + side / 8));
    }
}

/// A plateau at a limit belongs to the band that begins there.
TEST(Overlap, OfBandsIsHalfOpen) {
    OracleScene scene = opaqueScene(solidBox({2, 3, 4}, {9, 8, 7}));
    const OverlapAnswer found = overlaps(scene, {.tolerance = 1e-6, .bandLimits = {-1, 255, 255.5}});
    ASSERT_EQ(found.bands.size(), 4U);
    for (const std::uint32_t band : {0U, 1U, 3U}) {
        expectVolume(0, found.bands[band].bounds, 1e-6);
    }
    expectVolume(7 * 5 * 3, found.bands[2].bounds, 1e-6);
    // From x = 10 on the value is 100 exactly; below, it rises by 10 a voxel.
    Grid grid;
    grid.size = {20, 20, 20};
    scene.volume = makeBytes(grid, [](auto x, auto...) { return std::min(10.0 * x, 100.0); });
    scene.mesh = solidBox({5, 3, 4}, {30, 8, 7});
    scene.points = opaqueFrom(100);
    const OverlapAnswer plateau = overlaps(scene, {.tolerance = 1e-3, .bandLimits = {80, 100}});
    expectVolume(9.5 * 15, plateau.pairs[0].bounds);
    expectVolume(3 * 15, plateau.bands[0].bounds);
    expectVolume(2 * 15, plateau.bands[1].bounds);
    expectVolume(9.5 * 15, plateau.bands[2].bounds);
}

TEST(Overlap, TakesWhateverSurfaceIsClosed) {
    const MeshData box = solidBox({2, 2, 2}, {8, 7, 6});
    const double volume = 6 * 5 * 4;
    MeshData flaps = box; // a triangle of no area, one of a single point, and one that its mirror image cancels
    flaps.indices.insert(flaps.indices.end(), {0, 1, 1, 2, 2, 2, 0, 3, 5, 0, 5, 3});
    MeshData zeros = unshared(solidBox({0, 0, 0}, {6, 5, 4}));
    for (std::size_t i = 0; i < zeros.positions.size(); i += 5) {
        zeros.positions[i] = zeros.positions[i] == 0 ? -0.0 : zeros.positions[i];
    }
    const MeshData ball = transformed(solidBall(5, 3), translation({9, 9, 9}));
    const MeshData inner = transformed(solidBall(3, 2), translation({9.1, 9, 9}));
    const MeshData block = solidBox({2, 2, 2}, {18, 18, 6});
    const MeshData prism =
        transformed(solidPrism(40, 2, 4), translation({13, 8, 6})); // cuts a piece of 40 corners out of a triangle
    struct Case {
        const char* name;
        MeshData mesh;
        double wanted;
        bool isInward;
    };
    const std::vector<Case> cases{
        {"box", box, volume, false},
        {"inwards", reversed(box), volume, true},
        {"unshared", unshared(box), volume, false},
        {"flaps", flaps, volume, false},
        {"zeros of either sign", zeros, volume, false},
        {"overlapping", joined(box, solidBox({5, 4, 3}, {12, 9, 10})), volume + 7 * 5 * 7 - 3 * 3 * 3, false},
        {"overlapping, one inwards", joined(box, reversed(solidBox({5, 3, 1}, {12, 9, 10}))),
         volume + 7 * 6 * 9 - 2 * 3 * 4 * 4, true},
        {"on a face of each other", joined(box, solidBox({8, 2, 2}, {9, 7, 6})), volume + 20, false},
        {"on an edge of each other", joined(box, solidBox({8, 2, 6}, {9, 7, 7})), volume + 5, false},
        {"twice", joined(box, box), volume, false},
        {"with its mirror image", joined(box, reversed(box)), 0, false},
        {"hollow", joined(ball, reversed(inner)), signedVolume(ball) - signedVolume(inner), false},
        {"in itself", joined(ball, inner), signedVolume(ball), false},
        {"through a face", joined(block, prism), signedVolume(block) + signedVolume(prism) / 2, false},
    };
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        const SolidFacts facts = take(checkSolid(one.mesh.view()));
        EXPECT_EQ(facts.holes, 0U);
        EXPECT_EQ(facts.openEdges, 0U);
        EXPECT_EQ(facts.inward, one.isInward);
        EXPECT_NEAR(facts.signedVolume, signedVolume(one.mesh), 1e-6);
        EXPECT_EQ(holesText(facts), "");
        // Vertices of balls are rounded to floats, which is known of them.
        const PairOverlap found = overlap(opaqueScene(one.mesh), 1e-2);
        expectVolume(one.wanted, found.bounds, 1e-2);
        expectVolume(one.wanted, found.solid, 1e-2);
        EXPECT_EQ(found.inside, one.wanted > 0 ? Containment::Some : found.inside);
        EXPECT_EQ(found.end, StopReason::Closed);
    }
    EXPECT_GT(take(checkSolid(joined(box, solidBox({8, 2, 6}, {9, 7, 7})).view())).nonManifold, 0U);
    EXPECT_EQ(take(checkSolid(box.view())).nonManifold, 0U);
}

/// Boxes of whole millimetres that share faces, edges and corners, some of them inwards: windings are counted by cubes.
TEST(Overlap, OfManyBoxesIsCountedByCubes) {
    std::mt19937_64 random(testSeed());
    constexpr std::size_t kSide = 5;
    for (std::size_t round = 0; round < randomCases(5000, 50); ++round) {
        SCOPED_TRACE(round);
        std::array<int, kSide * kSide * kSide> windings{};
        MeshData mesh;
        for (std::size_t boxes = 2 + below(random, 4); boxes > 0; --boxes) {
            std::array<std::size_t, 3> lo{};
            std::array<std::size_t, 3> hi{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lo[axis] = below(random, kSide);
                hi[axis] = lo[axis] + 1 + below(random, kSide - lo[axis]);
            }
            const auto corner = [](const std::array<std::size_t, 3>& at) {
                return Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
            };
            const bool isInward = chance(random, 0.3);
            const MeshData box = solidBox(corner(lo), corner(hi));
            mesh = joined(std::move(mesh), isInward ? reversed(box) : box);
            for (std::size_t i = 0; i < windings.size(); ++i) {
                const std::array<std::size_t, 3> at{i % kSide, i / kSide % kSide, i / kSide / kSide};
                bool isIn = true;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    isIn = isIn && at[axis] >= lo[axis] && at[axis] < hi[axis];
                }
                windings[i] += isIn ? (isInward ? -1 : 1) : 0;
            }
        }
        const double wanted =
            static_cast<double>(windings.size()) - static_cast<double>(std::count(windings.begin(), windings.end(), 0));
        OracleScene scene = opaqueScene(mesh);
        scene.world_from_object =
            multiply(translation({9, 9, 9}), chance(random, 0.5) ? identity() : randomRotation(random));
        const PairOverlap found = overlap(scene, 1e-2);
        expectVolume(wanted, found.bounds, 1e-2);
        expectVolume(wanted, found.solid, 1e-2);
        EXPECT_EQ(found.end, StopReason::Closed);
        ASSERT_FALSE(HasFailure());
    }
}

TEST(Overlap, KnowsPosesThatMirrorOrFlatten) {
    OracleScene scene = opaqueScene(solidBox({1, 2, 3}, {4, 6, 8}));
    scene.world_from_object[0] = -2;
    scene.world_from_object[12] = 14;
    expectVolume(120, overlap(scene).bounds);
    scene.world_from_object[0] = 0;
    EXPECT_LE(overlap(scene).bounds.upper, 1e-6);
    EXPECT_EQ(overlap(scene).bounds.lower, 0);
}

TEST(Overlap, RefusesHolesUntilTheyAreFilled) {
    MeshData mesh = joined(solidBox({2, 2, 2}, {8, 7, 6}), solidBox({10, 2, 2}, {12, 7, 6}));
    const auto whole = mesh.indices;
    mesh.indices.erase(mesh.indices.begin() + 3); // a triangle is no more ...
    mesh.indices.erase(mesh.indices.begin() + 3, mesh.indices.begin() + 5);
    mesh.indices.resize(mesh.indices.size() - 6); // ... nor is a face of the other box
    for (const MeshData& open : {mesh, unshared(mesh), reversed(mesh)}) {
        const SolidFacts facts = take(checkSolid(open.view()));
        EXPECT_EQ(facts.holes, 2U);
        EXPECT_EQ(facts.openEdges, 7U);
        EXPECT_NEAR(facts.longestHole, 11 + std::sqrt(61), 1e-9);
        EXPECT_THAT(holesText(facts), HasSubstr("2 holes"));
        const HeldScene held(opaqueScene(open));
        cpu::OverlapMeter meter = take(cpu::OverlapMeter::create({.threads = 1}));
        const Result<OverlapAnswer> refused = meter.measure({}, held.batch);
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(refused.error().text, HasSubstr("2 holes"));
        EXPECT_EQ(refused.error().text.find('\n'), std::string::npos);
        const FilledMesh filled = take(fillHoles(open.view()));
        EXPECT_EQ(filled.holes, 2U);
        EXPECT_NEAR(filled.area, 30.0 / 2 + 20, 1e-9);
        ASSERT_GT(filled.mesh.indices.size(), open.indices.size());
        EXPECT_TRUE(std::equal(open.indices.begin(), open.indices.end(), filled.mesh.indices.begin()));
        EXPECT_EQ(take(checkSolid(filled.mesh.view())).holes, 0U);
        expectVolume(120 + 40, overlap(opaqueScene(filled.mesh)).bounds, 1e-3, 1e-6);
    }
    mesh.indices = whole;
    const FilledMesh same = take(fillHoles(mesh.view()));
    EXPECT_EQ(same.holes, 0U);
    EXPECT_EQ(same.area, 0);
    EXPECT_EQ(same.mesh.indices, whole);
}

TEST(Overlap, FillsWhateverIsMissing) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 300; ++round) {
        const MeshData whole = randomSolid(random, 10);
        EXPECT_EQ(take(checkSolid(whole.view())).holes, 0U);
        MeshData open{whole.positions, {}, {}, {}};
        for (std::size_t i = 0; i < whole.indices.size(); i += 3) {
            if (i == 0 || chance(random, 0.9)) {
                open.indices.insert(open.indices.end(), {whole.indices[i], whole.indices[i + 1], whole.indices[i + 2]});
            }
        }
        const SolidFacts facts = take(checkSolid(open.view()));
        EXPECT_EQ(facts.holes == 0, open.indices.size() == whole.indices.size()) << round;
        const FilledMesh filled = take(fillHoles(open.view()));
        EXPECT_EQ(filled.holes, facts.holes) << round;
        EXPECT_EQ(filled.area > 0, facts.holes > 0) << round;
        EXPECT_EQ(take(checkSolid(filled.mesh.view())).holes, 0U) << round;
    }
}

TEST(Overlap, SaysHowMuchIsInside) {
    const auto inside = [](const OracleScene& scene) { return overlap(scene).inside; };
    EXPECT_EQ(inside(opaqueScene(solidBox({-5, -5, -5}, {30, 30, 30}))), Containment::All);
    EXPECT_EQ(inside(opaqueScene(solidBox({2, 3, 4}, {5, 6, 7}))), Containment::Some);
    EXPECT_EQ(inside(opaqueScene(solidBox({-5, -5, -5}, {30, 30, 19.25}))), Containment::Some);
    EXPECT_EQ(inside(opaqueScene(solidBox({-5, -5, -5}, {-1, 30, 30}))), Containment::None);
    // A shell around the whole image, a cavity in it.
    EXPECT_EQ(inside(opaqueScene(
                  joined(solidBox({-9, -9, -9}, {30, 30, 30}), reversed(solidBox({-5, -5, -5}, {25, 25, 25}))))),
              Containment::None);
    OracleScene dark = opaqueScene(solidBox({2, 3, 4}, {5, 6, 7}));
    dark.points = opaqueFrom(256);
    EXPECT_EQ(inside(dark), Containment::None);
    EXPECT_EQ(overlap(dark).bounds.upper, 0);
    // In the faces of the image it is a matter of rounding.
    const Containment touching = inside(opaqueScene(solidBox({-0.5, -0.5, -0.5}, {19.5, 19.5, 19.5})));
    EXPECT_TRUE(touching == Containment::All || touching == Containment::Undecided) << toString(touching);
}

TEST(Overlap, SaysWhichBallsAreInside) {
    Grid grid;
    grid.size = {40, 20, 20};
    OracleScene scene;
    scene.volume = makeVolume<float>(grid, ScalarType::Float32, [](auto x, auto y, auto z) {
        const double left = std::hypot(x - 10.0, y - 9.0, z - 9.0);
        const double right = std::hypot(x - 29.0, y - 9.0, z - 9.0);
        return 5 - std::min(left, right);
    });
    scene.points = opaqueFrom(0);
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto x, auto, auto z) { return z > 17 ? 4 : (x < 20 ? 1 : 2); }).view()));
    const auto around = [&](double x, double radius) {
        scene.mesh = transformed(solidBall(radius, 3), translation({x, 9, 9}));
        const OverlapAnswer found = overlaps(scene, {.tolerance = 0.1, .labels = {2, 1, 4, 77}}, &labels);
        std::vector<Containment> out{found.pairs.at(0).inside};
        for (const LabelOverlap& label : found.labels) {
            out.push_back(label.inside);
        }
        // Nothing opaque has one of the last two labels.
        expectVolume((found.pairs[0].bounds.lower + found.pairs[0].bounds.upper) / 2,
                     {found.labels.at(0).bounds.lower + found.labels.at(1).bounds.lower,
                      found.labels[0].bounds.upper + found.labels[1].bounds.upper},
                     0.2, 0.1);
        EXPECT_EQ(found.labels.at(2).bounds.upper, 0);
        EXPECT_EQ(found.labels.at(3).bounds.upper, 0);
        return out;
    };
    using enum Containment;
    EXPECT_EQ(around(10, 7), (std::vector{Some, None, All, None, None}));
    EXPECT_EQ(around(10, 3), (std::vector{Some, None, Some, None, None}));
    EXPECT_EQ(around(29, 7), (std::vector{Some, All, None, None, None}));
    EXPECT_EQ(around(20, 40), (std::vector{All, All, All, None, None}));
    EXPECT_EQ(around(19.5, 2), (std::vector{None, None, None, None, None}));
    EXPECT_EQ(around(20, 12), (std::vector{Some, Some, Some, None, None}));
}

} // namespace
} // namespace voxtact::test
