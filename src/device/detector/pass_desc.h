// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

namespace voxtact {

/// A DetectorDesc as the passes read it. Options that its alternative lacks have these defaults.
struct PassDesc {
    CountingMethod method = CountingMethod::Compute;
    Projection projection = Projection::Certified;
    Filter filter = Filter::Exact;
    Boundary boundary = Boundary::Range;
    Outputs outputs{};
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
    double resolution = kDefaultResolution;
    bool stopAtFirst = false;
    bool counters = false;
    bool overestimate = false;
    bool devicePoses = false;
};

[[nodiscard]] constexpr PassDesc passDesc(const DetectorDesc& desc) {
    if (std::holds_alternative<CertifiedDesc>(desc)) {
        const auto& certified = std::get<CertifiedDesc>(desc);
        return {.outputs = certified.outputs,
                .resolution = certified.resolution,
                .stopAtFirst = certified.stopAtFirst,
                .counters = certified.counters,
                .devicePoses = certified.devicePoses};
    }
    const auto& raster = std::get<RasterDesc>(desc);
    return {.method = raster.method,
            .projection = raster.projection,
            .filter = raster.filter,
            .boundary = raster.boundary,
            .outputs = raster.outputs,
            .samplesPerVoxel = raster.samplesPerVoxel,
            .overestimate = raster.overestimate,
            .devicePoses = raster.devicePoses};
}

} // namespace voxtact
