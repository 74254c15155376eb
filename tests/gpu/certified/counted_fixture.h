// SPDX-License-Identifier: MIT
#pragma once

#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <cstdint>
#include <vector>

namespace voxtact::test {

/// The answers of a batch, and what the passes count and how near pairs are where that is asked for.
struct Answered {
    std::vector<PairAnswer> pairs;
    std::vector<PairClearance> clearances;
    std::vector<LabelClearance> labels;
    std::vector<SegmentMotion> motions;
    CertifiedCounters counters{};
};

/// One may say that it is possible.
inline void expectNoContradiction(const PairAnswer& device, const PairAnswer& host) {
    EXPECT_FALSE(device.hit && !host.hit && !host.possible);
    EXPECT_FALSE(!device.hit && !device.possible && host.hit);
}

/// Tests of the projection `conservative` by compute. Skipped where the device has it not.
class CertifiedTest : public RawGpuTest {
  protected:
    void SetUp() override {
        RawGpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() &&
            !context().supports(CountingMethod::Compute, Projection::Conservative)) {
            GTEST_SKIP() << "no conservative by compute on this device";
        }
    }

    /// With Results of so many `pairs` and `clusters` at once.
    Answered detect(const DetectorDesc& desc, const Batch& batch, std::uint32_t pairs, std::uint32_t clusters) {
        return detect(take(Detector::create(context(), desc)), batch, pairs, clusters);
    }
    Answered detect(const Detector& detector, const Batch& batch, std::uint32_t pairs, std::uint32_t clusters) {
        const DetectorDesc& desc = detector.desc();
        Results results = take(Results::create(context(), {.maxPairs = pairs,
                                                           .clustersAtOnce = clusters,
                                                           .clearances = desc.clearance.has_value(),
                                                           .closest = desc.closest,
                                                           .labelClearances = labelRoom(desc, batch),
                                                           .motions = desc.motion.has_value()}));
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        Answered out;
        for (const PairResult& pair : take(results.read())) {
            out.pairs.push_back(unpack(pair));
        }
        if (desc.clearance) {
            out.clearances = take(results.readClearances());
        }
        EXPECT_EQ(results.measuredLabels(), desc.labelClearances);
        if (desc.labelClearances) {
            out.labels = take(results.readLabelClearances());
        }
        EXPECT_EQ(results.moved(), desc.motion.has_value());
        if (desc.motion) {
            out.motions = take(results.readMotions());
        }
        EXPECT_EQ(results.counted(), desc.counters);
        if (desc.counters) {
            out.counters = take(results.counters());
        }
        return out;
    }

  private:
    static std::uint32_t labelRoom(const DetectorDesc& desc, const Batch& batch) {
        return desc.labelClearances ? static_cast<std::uint32_t>(batch.labels.size()) : 0;
    }
};

} // namespace voxtact::test
