// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "voxtact/motion.h"

#include <cstdint>
#include <optional>
#include <vector>

/// The oracle of motions: dense sampling. Its poses come by another road than the engine's: half of a motion is the
/// square root of its matrix, found by iteration, and so on.
namespace voxtact::oracle {

/// 2^halvings + 1 poses at equal steps, ends included. Expects a rigid motion of less than half a turn.
[[nodiscard]] Result<std::vector<Mat4>> oraclePoses(const Mat4& from, const Mat4& to, Interpolation interpolation,
                                                    const Vec3& centre, std::uint32_t halvings);

struct OracleMotion {
    /// The first of the sampled parameters at which the certified oracle says *certain*.
    std::optional<double> touches;
    /// Beyond doubt nothing touches up to here: at the samples the clearance is more than what the mesh moves to the
    /// next one.
    double freeUntil = 0;
    double clearance = 0; ///< mm: the least that is proven on all of the way; 0 where none is
};

/// The pair's own pose is the first. Refuses what clearanceOracle() refuses.
[[nodiscard]] Result<OracleMotion> motionOracle(const OraclePair& pair, const Mat4& to, Interpolation interpolation,
                                                const Vec3& centre, std::uint32_t halvings, double resolution);

} // namespace voxtact::oracle
