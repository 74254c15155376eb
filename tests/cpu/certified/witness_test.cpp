// SPDX-License-Identifier: MIT
// What a contact of the projection `certified` says of its place: the value and the opacity that were proven.
#include "cpu/scenes/certified_scenes.h"

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/spike_scene.h"
#include "oracle/oracle_sample.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

std::vector<Contact> contactsOf(const OracleScene& scene) {
    const oracle::OraclePair pair = scene.pair();
    const cpu::Mesh mesh = take(cpu::Mesh::create(pair.mesh));
    const cpu::Volume volume = take(cpu::Volume::create(pair.volume));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create(pair.transferFunction));
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.contacts = true}}));
    const cpu::BatchItem item{&mesh, &volume, &function, {&pair.world_from_object, 1}};
    return take(detector.detect({{&item, 1}, {}, pair.threshold})).contacts;
}

/// The greatest opacity of values within `around` of one.
double greatestOpacity(const CertifiedCase& c, double value, double around) {
    double greatest =
        std::max(opacityOfValue(c.scene.points, value - around), opacityOfValue(c.scene.points, value + around));
    for (const ControlPoint& point : c.scene.points) {
        greatest = std::abs(point.value - value) <= around ? std::max(greatest, point.opacity) : greatest;
    }
    return greatest;
}

/// No look at the position finds the entry: it is passed within a 235th of a voxel.
TEST(Witness, OfOneEntrysSpikeSaysItsOpacity) {
    for (int number = 0; number < 12; ++number) {
        const ScalarType type = number < 6 ? ScalarType::Int16 : ScalarType::UInt8;
        const SpikeScene spike = spikeScene(type, number % 2 == 0, number % 3);
        const std::vector<Contact> contacts = contactsOf(spike.scene);
        ASSERT_FALSE(contacts.empty());
        for (const Contact& contact : contacts) {
            EXPECT_GE(contact.opacity, static_cast<double>(static_cast<float>(spike.scene.threshold)));
            // A thousandth of the spike's flank reaches the threshold.
            EXPECT_NEAR(contact.value, spike.value, 1e-5 * std::abs(spike.value));
            EXPECT_NEAR(contact.position[0], spike.place, 1e-5);
        }
    }
}

TEST(Witness, IsAsOpaqueAsTheThresholdInEveryCase) {
    constexpr std::uint64_t kCases = 4000;
    const std::uint64_t seed = testSeed();
    std::size_t contacts = 0;
    for (std::uint64_t number = 0; number < kCases && !testing::Test::HasFailure(); ++number) {
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const VolumeView image = c.scene.volume.view();
        const Mat4 texture_from_world = take(textureFromWorld(image.grid));
        const ValueRange range = take(checkVolume(image));
        const double width = range.hi - range.lo;
        const double terms = std::max(std::abs(range.lo), std::abs(range.hi)) + c.scene.domain.hi - c.scene.domain.lo;
        for (const Contact& contact : contactsOf(c.scene)) {
            SCOPED_TRACE("VOXTACT_TEST_SEED=" + std::to_string(seed) + ", case " + std::to_string(number) + ", " +
                         toString(c.kind));
            EXPECT_GE(contact.opacity, static_cast<double>(static_cast<float>(c.scene.threshold)));
            // Of that value, up to the rounding of the value.
            EXPECT_GE(greatestOpacity(c, contact.value, 1e-5 * terms), contact.opacity - 1e-5);
            EXPECT_GE(contact.value, range.lo - 1e-5 * terms);
            EXPECT_LE(contact.value, range.hi + 1e-5 * terms);
            // Of that place, up to the rounding of the place, which is large for huge triangles.
            if (c.kind != CaseKind::Huge && !c.farOrigin) {
                Vec3 at = transformPoint(texture_from_world, contact.position);
                for (double& coordinate : at) {
                    coordinate = std::clamp(coordinate, 0.0, 1.0);
                }
                EXPECT_NEAR(contact.value, oracle::sampleVolume(image, at), 0.01 * width + 1e-5 * terms);
            }
            ++contacts;
        }
    }
    EXPECT_GT(contacts, kCases / 10);
}

} // namespace
} // namespace voxtact::test
