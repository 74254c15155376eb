// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/detector_impl.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <cstdint>
#include <vector>

namespace voxtact::test {

/// The answers of a batch, and what the passes count where that is asked for.
struct Answered {
    std::vector<PairAnswer> pairs;
    CertifiedCounters counters{};
};

/// One may say that it is possible.
inline void expectNoContradiction(const PairAnswer& device, const PairAnswer& host) {
    EXPECT_FALSE(device.hit && !host.hit && !host.possible);
    EXPECT_FALSE(!device.hit && !device.possible && host.hit);
}

/// Tests of the projection `certified` by compute. Skipped where the device has it not.
class CertifiedTest : public RawGpuTest {
  protected:
    void SetUp() override {
        RawGpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !context().supports(CountingMethod::Compute, Projection::Certified)) {
            GTEST_SKIP() << "no certified by compute on this device";
        }
    }

    /// With Results of so many `pairs` and `clusters` at once.
    Answered detect(const AnyDesc& desc, const Batch& batch, std::uint32_t pairs, std::uint32_t clusters) {
        return detect(take(Detector::create(context(), desc)), batch, pairs, clusters);
    }
    Answered detect(const Detector& detector, const Batch& batch, std::uint32_t pairs, std::uint32_t clusters) {
        const PassDesc& desc = detector.impl().desc;
        Results results = take(Results::create(detector, {.maxPairs = pairs, .clustersAtOnce = clusters}));
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        Answered out;
        for (const PairResult& pair : take(results.read())) {
            out.pairs.push_back(unpack(pair));
        }
        EXPECT_EQ(results.counted(), desc.counters);
        if (desc.counters) {
            out.counters = take(results.counters());
        }
        return out;
    }
};

} // namespace voxtact::test
