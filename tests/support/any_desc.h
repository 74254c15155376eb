// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

namespace voxtact::test {

/// A DetectorDesc for tests that go through projections and methods: Projection::Certified is a CertifiedDesc.
struct AnyDesc {
    CountingMethod method = CountingMethod::Query; ///< of a certified detector: not examined, like filter and boundary
    Projection projection = Projection::View;
    Filter filter = Filter::Hardware;
    Boundary boundary = Boundary::Auto;
    Outputs outputs{};
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
    double resolution = kDefaultResolution;
    bool stopAtFirst = false;
    bool counters = false;
    bool overestimate = false;
    bool devicePoses = false;

    operator DetectorDesc() const {
        if (projection == Projection::Certified) {
            return CertifiedDesc{.resolution = resolution,
                                 .outputs = outputs,
                                 .stopAtFirst = stopAtFirst,
                                 .counters = counters,
                                 .devicePoses = devicePoses};
        }
        return RasterDesc{.method = method,
                          .projection = projection,
                          .filter = filter,
                          .boundary = boundary,
                          .outputs = outputs,
                          .samplesPerVoxel = samplesPerVoxel,
                          .overestimate = overestimate,
                          .devicePoses = devicePoses};
    }
};

} // namespace voxtact::test
