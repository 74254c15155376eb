// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/rigid_motion.h"
#include "voxtact/device_results.h"
#include "voxtact/results.h"

/// What a device has found, as answers have it.
namespace voxtact {

/// `maximum`: ClearanceSearch::maximum.
[[nodiscard]] PairClearance unpackPair(const PairResult& pair, const ClearanceResult& found, double maximum);
[[nodiscard]] LabelClearance unpackLabel(const PairResult& pair, const ClearanceResult& found, double maximum,
                                         std::int32_t label);
/// Of a pair that has some.
[[nodiscard]] ClosestPoints unpack(const ClosestResult& found);
/// All but the number of the segment.
[[nodiscard]] SegmentMotion unpack(const PairResult& pair, const MotionResult& found, const RigidMotion& motion);

} // namespace voxtact
