// SPDX-License-Identifier: MIT
// The outputs in addition to the counts, on the host: against the counts, against the oracle, and against solids whose
// normals and depths are known.
#include "core/geometry/vec3.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/oracle.h"
#include "support/contact_scenes.h"
#include "support/host_meters.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true};

/// A RandomScene on the engine, with a label map.
struct HostScene {
    cpu::Volume volume;
    cpu::TransferFunction function;
    cpu::Mesh mesh;
    LabelData labels;

    HostScene(const RandomScene& scene, std::mt19937_64& random)
        : volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create(scene.transferFunction()))),
          mesh(take(cpu::Mesh::create(scene.mesh.view()))),
          labels(take(makeLabels(makeLabelImage(random, scene.volume.grid).view()))) {}

    [[nodiscard]] BatchAnswer detect(const RandomScene& scene, const Outputs& outputs,
                                     std::uint32_t threads = 1) const {
        cpu::Detector detector =
            take(cpu::Detector::create({.threads = threads,
                                        .boundary = scene.rangeTest ? Boundary::Range : Boundary::Clamp,
                                        .outputs = outputs,
                                        .mostContacts = std::numeric_limits<std::uint32_t>::max()}));
        const cpu::BatchItem item{&mesh, &volume, &function, scene.poses, &labels};
        return take(detector.detect({std::span(&item, 1), scene.view, scene.threshold}));
    }
};

TEST(CpuOutputs, AgreeWithTheCounts) {
    std::mt19937_64 random(testSeed());
    std::uint64_t contacts = 0;
    for (int round = 0; round < 250; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        RandomScene scene = makeRandomScene(local, 3);
        scene.view.width = std::min(scene.view.width, 200U);
        scene.view.height = std::min(scene.view.height, 200U);
        const HostScene host(scene, local);
        const BatchAnswer answer = host.detect(scene, kAll);
        const BatchAnswer counts = host.detect(scene, {});
        for (std::size_t i = 0; i < counts.pairs.size(); ++i) {
            ASSERT_EQ(answer.pairs[i].count, counts.pairs[i].count) << "scene " << seed;
        }
        ASSERT_EQ(inconsistencyOf(answer), "") << "scene " << seed;
        ASSERT_EQ(differenceOf(host.detect(scene, kAll, 4), answer), "") << "scene " << seed;
        EXPECT_TRUE(counts.triangles.empty() && counts.contacts.empty() && counts.bounds.empty());
        contacts += answer.contacts.size();
    }
    std::cout << contacts << " contacts\n";
    EXPECT_GT(contacts, 10000U);
}

/// A scene that single precision does not overflow in: the oracle does not either.
RandomScene oracleScene(std::mt19937_64& random, std::uint32_t width, std::uint32_t height) {
    RandomScene scene = makeRandomScene(random, 1);
    while (scene.domain.hi - scene.domain.lo > 1e37) {
        scene = makeRandomScene(random, 1);
    }
    scene.rangeTest = true;
    scene.view.width = width;
    scene.view.height = height;
    return scene;
}

/// Certain and uncertain fragments of a triangle, in the oracle's eyes.
struct Judged {
    std::uint64_t certain = 0;
    std::uint64_t doubtful = 0;
};

/// The engine's weights are exact.
constexpr oracle::Tolerance kEngine{.weight = 0};

/// Whether a triangle goes far beyond the viewport, behind the eye, or from near the eye to a thousand times as far.
/// The engine cuts it at its guard band or at the near plane, and what single precision makes of a cut there is more
/// than the oracle's tolerance of a corner.
bool reachesFar(const RandomScene& scene, std::uint32_t triangle) {
    constexpr double kDeep = 1000;
    const Mat4 clip_from_object = multiply(scene.view.clip_from_world, scene.poses[0]);
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double* at =
            scene.mesh.positions.data() + std::size_t{3} * scene.mesh.indices[std::size_t{3} * triangle + i];
        const auto row = [&](std::size_t r) {
            return clip_from_object[r] * at[0] + clip_from_object[4 + r] * at[1] + clip_from_object[8 + r] * at[2] +
                   clip_from_object[12 + r];
        };
        if (!(std::abs(row(0)) < 4 * row(3) && std::abs(row(1)) < 4 * row(3))) {
            return true;
        }
        nearest = std::min(nearest, row(3));
        farthest = std::max(farthest, row(3));
    }
    return farthest > kDeep * nearest;
}

/// All pixels of a triangle that has another count than the oracle's.
Judged judge(const oracle::OraclePair& pair, std::uint32_t triangle) {
    std::vector<oracle::OracleFragment> fragments;
    for (std::uint32_t y = 0; y < pair.view.height; ++y) {
        for (std::uint32_t x = 0; x < pair.view.width; ++x) {
            fragments.push_back({triangle, x, y});
        }
    }
    Judged judged;
    for (const oracle::Evidence& evidence : take(oracle::oracleEvidence(pair, fragments, kEngine))) {
        judged.certain += evidence.doubt == oracle::Doubt::None && evidence.survives ? 1U : 0U;
        judged.doubtful += evidence.doubt != oracle::Doubt::None ? 1U : 0U;
    }
    return judged;
}

TEST(CpuOutputs, TrianglesAreTheOracles) {
    std::mt19937_64 random(testSeed());
    std::uint64_t same = 0;
    std::uint64_t differing = 0;
    for (int round = 0; round < 150; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        const RandomScene scene = oracleScene(local, 48, 40);
        const oracle::OraclePair pair{scene.mesh.view(), scene.volume.view(), scene.transferFunction(),
                                      scene.view,        scene.poses[0],      scene.threshold};
        std::map<std::uint32_t, std::uint64_t> counts;
        for (const oracle::OracleFragment& fragment : take(oracle::oracleSurvivors(pair))) {
            --counts[fragment.triangle];
        }
        std::map<std::uint32_t, std::uint64_t> mine;
        for (const TouchedTriangle& triangle : HostScene(scene, local).detect(scene, {.triangles = true}).triangles) {
            counts[triangle.triangle] += triangle.count;
            mine[triangle.triangle] = triangle.count;
        }
        for (const auto& [triangle, difference] : counts) {
            if (reachesFar(scene, triangle)) {
                continue;
            }
            same += difference == 0 ? 1U : 0U;
            if (difference != 0 && ++differing < 300) {
                // A clipped triangle may cover a pixel twice where its pieces meet: that pixel is doubtful.
                const Judged judged = judge(pair, triangle);
                EXPECT_GE(mine[triangle], judged.certain) << "scene " << seed << ", triangle " << triangle;
                EXPECT_LE(mine[triangle], judged.certain + 2 * judged.doubtful)
                    << "scene " << seed << ", triangle " << triangle;
            }
        }
    }
    std::cout << same << " triangles with the oracle's count, " << differing << " with another\n";
    EXPECT_GT(same, 200U);
}

TEST(CpuOutputs, LabelsAreThoseOfTheOraclesFragments) {
    std::mt19937_64 random(testSeed());
    std::uint64_t all = 0;
    std::uint64_t differing = 0;
    for (int round = 0; round < 400 && (round < 60 || all < 20000); ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        const RandomScene scene = oracleScene(local, 64, 64);
        const HostScene host(scene, local);
        const BatchAnswer answer = host.detect(scene, kAll);
        for (const Contact& contact : answer.contacts) {
            if (!labelIsDoubtful(host.labels, contact.position)) {
                ASSERT_EQ(contact.label, host.labels.values[labelAt(host.labels, contact.position)])
                    << "scene " << seed;
            }
        }
        const oracle::OraclePair pair{scene.mesh.view(), scene.volume.view(), scene.transferFunction(),
                                      scene.view,        scene.poses[0],      scene.threshold};
        // All that is in the volume: what the oracle finds transparent, and the engine may find opaque, is in doubt
        // too.
        oracle::OraclePair whole = pair;
        whole.threshold = 0;
        const std::vector<oracle::OracleFragment> fragments = take(oracle::oracleSurvivors(whole));
        std::map<std::int32_t, std::int64_t> more;
        std::uint64_t survivors = 0;
        std::uint64_t doubtful = 0;
        for (const oracle::Evidence& each : take(oracle::oracleEvidence(pair, fragments, kEngine))) {
            const Vec3 world = transformPoint(worldFromTexture(scene.volume.grid), each.coordinate);
            if (each.survives) {
                --more[host.labels.values[labelAt(host.labels, world)]];
                ++survivors;
            }
            doubtful += each.doubt == oracle::Doubt::None ? 0U : 1U;
        }
        if (doubtful > survivors / 100) {
            continue; // the threshold is where much of the volume is
        }
        for (const LabelCount& label : answer.labels) {
            more[label.label] += static_cast<std::int64_t>(label.count);
        }
        for (const auto& [label, difference] : more) {
            differing += static_cast<std::uint64_t>(std::abs(difference));
        }
        all += survivors;
    }
    // Where a fragment is on a steep triangle depends on the last bits of its corners.
    std::cout << all << " survivors, the histograms differ by " << differing << "\n";
    EXPECT_GE(all, 5000U);
    EXPECT_LT(differing, all / 100);
}

BatchAnswer detect(const ContactScene& scene, std::uint32_t mostContacts = 1U << 20U) {
    const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({scene.points, scene.domain}));
    const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
    cpu::Detector detector = take(cpu::Detector::create(
        {.outputs = {.contacts = true, .maxDepth = scene.maxDepth}, .mostContacts = mostContacts}));
    const cpu::BatchItem item{&mesh, &volume, &function, std::span(&scene.world_from_object, 1)};
    return take(detector.detect({std::span(&item, 1), scene.view, scene.threshold}));
}

TEST(CpuOutputs, NormalsAndDepthsOfKnownSolids) {
    std::mt19937_64 random(testSeed());
    for (const ContactScene& scene : makeContactScenes(random)) {
        const ContactErrors errors = contactErrors(scene, detect(scene).contacts);
        std::cout << scene.name << ": " << errors.compared << " contacts, normals off by " << errors.degrees
                  << " degrees, depths by " << errors.mm << " mm, values by " << errors.value << ", from the triangle "
                  << errors.fromTriangle << " mm\n";
        EXPECT_GT(errors.compared, 100U) << scene.name;
        EXPECT_LT(errors.degrees, scene.degrees) << scene.name;
        EXPECT_LT(errors.mm, scene.mm) << scene.name;
        EXPECT_LT(errors.value, 1e-5) << scene.name;
        EXPECT_LT(errors.fromTriangle, 2e-4) << scene.name;
    }
}

/// A flat mesh at z in a unit cube of 32 voxels per side, whose voxels hold 255 * value(texture coordinate).
ContactScene inUnitCube(double z, const std::function<double(double, double, double)>& value) {
    ContactScene scene;
    scene.volume = makeVolume<float>(unitGrid(32), ScalarType::Float32, [&](auto x, auto y, auto w) {
        return 255 * value((x + 0.5) / 32, (y + 0.5) / 32, (w + 0.5) / 32);
    });
    scene.points.assign(byteRamp().begin(), byteRamp().end());
    scene.domain = {0, 255};
    scene.mesh = makeFlat(0.1, 0.9, 0.1, 0.9, z);
    scene.view = flatView(0, 1, 40, 40);
    scene.maxDepth = 2;
    return scene;
}

TEST(CpuOutputs, DeepInsideAPlateauTheStepIsDoubled) {
    // Opaque to z = 0.75, with a ramp of a voxel; the mesh is eight voxels below.
    const ContactScene scene = inUnitCube(0.5, [](auto, auto, double z) { return z < 0.75 ? 1.0 : 0.0; });
    const std::vector<Contact> contacts = detect(scene).contacts;
    EXPECT_EQ(contacts.size(), 32U * 32U);
    for (const Contact& contact : contacts) {
        EXPECT_NEAR(contact.normal[2], 1, 1e-6);
        EXPECT_NEAR(contact.depth, 0.25, 1e-4);
        EXPECT_EQ(contact.value, 255);
        EXPECT_NEAR(contact.opacity, 255.5 / 256, 1e-6); // the last entry of the table
    }
}

TEST(CpuOutputs, NoNormalWhereTheOpacityIsTheSame) {
    const std::vector<Contact> contacts = detect(inUnitCube(0.5, [](auto...) { return 1.0; })).contacts;
    EXPECT_EQ(contacts.size(), 32U * 32U);
    for (const Contact& contact : contacts) {
        EXPECT_EQ(contact.normal, (Vec3{0, 0, 0}));
        EXPECT_EQ(contact.depth, 2);
    }
}

TEST(CpuOutputs, NoNormalBeyondTheMaximalDepth) {
    // The surface is 0.25 away; differences over 0.125 do not see it.
    ContactScene scene = inUnitCube(0.5, [](auto, auto, double z) { return z < 0.75 ? 1.0 : 0.0; });
    scene.maxDepth = 0.125;
    for (const Contact& contact : detect(scene).contacts) {
        EXPECT_EQ(contact.normal, (Vec3{0, 0, 0}));
        EXPECT_EQ(contact.depth, 0.125);
    }
    scene.maxDepth = 0.249;
    for (const Contact& contact : detect(scene).contacts) {
        EXPECT_NEAR(contact.normal[2], 1, 1e-6);
        EXPECT_EQ(contact.depth, static_cast<double>(0.249F));
    }
}

TEST(CpuOutputs, HowFarTheDepthMayGoDoesNotChangeIt) {
    // Opaque to z = 0.9, but for a gap of two voxels that ends the way.
    ContactScene scene = inUnitCube(0.5, [](auto, auto, double z) { return z < 0.6 || (z > 0.66 && z < 0.9) ? 1 : 0; });
    scene.maxDepth = 0.2;
    const std::vector<Contact> near = detect(scene).contacts;
    EXPECT_EQ(near.size(), 32U * 32U);
    for (const double depth : {1.0, 4e3, 1e9, 1e30}) {
        scene.maxDepth = depth;
        const std::vector<Contact> contacts = detect(scene).contacts;
        ASSERT_EQ(contacts.size(), near.size());
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            EXPECT_NEAR(contacts[i].depth, near[i].depth, 1e-5) << "at most " << depth;
            EXPECT_NEAR(contacts[i].depth, 0.1, 0.03);
        }
    }
}

/// Spacings so fine that the largest depth is many times as long as the image.
TEST(CpuOutputs, AFineImageHasFineSteps) {
    ContactScene scene = inUnitCube(0.5, [](auto, auto, double z) { return z < 0.6 || (z > 0.66 && z < 0.9) ? 1 : 0; });
    constexpr double kSmall = 1.0 / 4096;
    for (double& spacing : scene.volume.grid.spacing) {
        spacing *= kSmall;
    }
    for (double& place : scene.volume.grid.origin) {
        place *= kSmall;
    }
    for (double& place : scene.mesh.positions) {
        place = static_cast<float>(place * kSmall);
    }
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            scene.view.clip_from_world[4 * column + row] /= kSmall;
        }
    }
    scene.maxDepth = kDefaultMaxDepth;
    const std::vector<Contact> contacts = detect(scene).contacts;
    EXPECT_EQ(contacts.size(), 32U * 32U);
    for (const Contact& contact : contacts) {
        EXPECT_NEAR(contact.depth, 0.1 * kSmall, 0.03 * kSmall);
    }
}

TEST(CpuOutputs, TheWayOutEndsWithTheImage) {
    // Opaque everywhere, less so towards x = 1.
    const ContactScene scene = inUnitCube(0.5, [](double x, auto, auto) { return 1 - 0.4 * x; });
    const std::vector<Contact> contacts = detect(scene).contacts;
    EXPECT_EQ(contacts.size(), 32U * 32U);
    for (const Contact& contact : contacts) {
        EXPECT_NEAR(contact.normal[0], 1, 1e-5);
        EXPECT_NEAR(contact.depth, 1 - contact.position[0], 1e-4);
    }
}

/// A ball of 12 mm whose voxels are 0 or 255: what a segmentation is. Voxels of a millimetre, a mesh that cuts it.
TEST(CpuOutputs, NormalsAndDepthsOfASegmentation) {
    std::mt19937_64 random(testSeed());
    constexpr double kRadius = 12;
    ContactScene scene;
    Grid grid;
    grid.size = {40, 40, 40};
    const Vec3 centre{19.3, 19.6, 19.1};
    scene.volume = makeBytes(grid, [&](auto x, auto y, auto z) {
        return length(minus({x + 0.0, y + 0.0, z + 0.0}, centre)) < kRadius ? 255.0 : 0.0;
    });
    scene.points.assign(byteRamp().begin(), byteRamp().end());
    scene.domain = {0, 255};
    scene.mesh = makeCube(-7.5, 7.5);
    scene.world_from_object = multiply(translation(centre), randomRotation(random));
    scene.view = {framingCamera(grid, 200, 200), 200, 200};
    std::map<int, ContactErrors> byDepth;
    std::map<int, double> sums;
    for (const Contact& contact : detect(scene).contacts) {
        const Vec3 radial = minus(contact.position, centre);
        const double below = kRadius - length(radial);
        const double cosine = std::clamp(dot(contact.normal, radial) / length(radial), -1.0, 1.0);
        const double degrees = std::acos(cosine) * 180 / std::numbers::pi;
        ContactErrors& errors = byDepth[below < 1 ? 0 : below < 2 ? 1 : 2];
        ++errors.compared;
        sums[below < 1 ? 0 : below < 2 ? 1 : 2] += degrees;
        errors.degrees = std::max(errors.degrees, degrees);
        errors.mm = std::max(errors.mm, std::abs(contact.depth - below));
    }
    for (const auto& [mm, errors] : byDepth) {
        std::cout << "from " << mm << " mm below the surface on: " << errors.compared << " contacts, normals off by "
                  << sums[mm] / static_cast<double>(errors.compared) << " degrees in the mean, " << errors.degrees
                  << " at most, depths by " << errors.mm << " mm\n";
        // The difference along an axis saturates where its step leaves the ball: at worst one axis counts alone where
        // all three should count the same, or the other way round: arccos(1/sqrt(3)), and what the cells add.
        EXPECT_GT(errors.compared, 500U);
        EXPECT_LT(sums[mm] / static_cast<double>(errors.compared), 30);
        EXPECT_LT(errors.degrees, 65);
        EXPECT_LT(errors.mm, 1 + mm);
    }
}

TEST(CpuOutputs, AThinSheetIsLeftOnItsNearSide) {
    // A sheet of four voxels from z = 0.5 to 0.625: from a place above its middle the way out is up.
    const auto sheet = [](auto, auto, double z) { return z > 0.5 && z < 0.625 ? 1.0 : 0.0; };
    for (const double z : {0.52, 0.55, 0.575, 0.61}) {
        for (const Contact& contact : detect(inUnitCube(z, sheet)).contacts) {
            const double way = z < 0.5625 ? z - 0.5 : 0.625 - z;
            EXPECT_NEAR(contact.normal[2], z < 0.5625 ? -1 : 1, 1e-6) << z;
            EXPECT_NEAR(contact.depth, way, 1e-4) << z;
        }
    }
}

TEST(CpuOutputs, AListIsCutAndTheTotalIsNot) {
    const ContactScene scene = inUnitCube(0.5, [](auto...) { return 1.0; });
    for (const std::uint32_t most : {0U, 1U, 1000U, 1024U, 5000U}) {
        const BatchAnswer answer = detect(scene, most);
        EXPECT_EQ(answer.contactsFound, 1024U);
        EXPECT_EQ(answer.contacts.size(), std::min(most, 1024U));
    }
}

TEST(CpuOutputs, Refusals) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double depth : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 1e300, 1e-300}) {
        const auto refused = cpu::Detector::create({.outputs = {.contacts = true, .maxDepth = depth}});
        ASSERT_FALSE(refused.ok()) << depth;
        EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(refused.error().text, HasSubstr("the largest depth of contacts is"));
    }
    EXPECT_TRUE(cpu::Detector::create({.outputs = {.triangles = true, .maxDepth = nan}}).ok());
    EXPECT_THAT(cpu::Detector::create({.stopAtFirst = true, .outputs = {.bounds = true}}).error().text,
                HasSubstr("a yes or no ends at the first survivor"));

    const cpu::Volume volume = take(cpu::Volume::create(makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}}));
    const cpu::Mesh mesh = take(cpu::Mesh::create(makeFlat(0, 1, 0, 1, 0.5).view()));
    cpu::Detector detector = take(cpu::Detector::create({.outputs = {.labels = true}}));
    const Mat4 pose = identity();
    const auto text = [&](const LabelData* labels) {
        const cpu::BatchItem item{&mesh, &volume, &function, std::span(&pose, 1), labels};
        const Result<BatchAnswer> answer = detector.detect({std::span(&item, 1), flatView(0, 1, 16, 16), 0.5});
        return answer.ok() ? std::string() : answer.error().text;
    };
    EXPECT_THAT(text(nullptr), HasSubstr("batch item 0 has no label map"));
    LabelData labels{unitGrid(2), std::vector<std::uint16_t>(8), {0, 3}};
    EXPECT_EQ(text(&labels), "");
    labels.indices.assign(8, 9);
    EXPECT_EQ(text(&labels), "") << "an index beyond the values is the label 0";
    labels.indices.pop_back();
    EXPECT_THAT(text(&labels), HasSubstr("7 indices, its grid has 8 voxels"));
    labels = {unitGrid(2), std::vector<std::uint16_t>(8), {1, 3}};
    EXPECT_THAT(text(&labels), HasSubstr("do not hold 0"));
    labels.values = {3, 0};
    EXPECT_THAT(text(&labels), HasSubstr("not ascending"));
    labels.grid.spacing[1] = 0;
    EXPECT_THAT(text(&labels), HasSubstr("spacing along y"));
}

} // namespace
} // namespace voxtact::test
