// SPDX-License-Identifier: MIT
#include "oracle/motion_oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "oracle/certified_oracle.h"
#include "oracle/clearance_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxtact::oracle {

namespace {

Mat4 mean(const Mat4& a, const Mat4& b) {
    Mat4 out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = 0.5 * (a[i] + b[i]);
    }
    return out;
}

/// The motion that makes this one when it is done twice (Denman and Beavers, 1976).
Result<Mat4> squareRoot(const Mat4& motion) {
    Mat4 root = motion;
    Mat4 reverse = identity();
    for (int step = 0; step < 40; ++step) {
        const Result<Mat4> fromRoot = inverse(root);
        VOXTACT_TRY(fromRoot);
        const Result<Mat4> fromReverse = inverse(reverse);
        VOXTACT_TRY(fromReverse);
        root = mean(root, *fromReverse);
        reverse = mean(reverse, *fromRoot);
    }
    return root;
}

/// A turn about a point, which then is at another.
Mat4 about(const Mat4& turn, const Vec3& before, const Vec3& after) {
    return multiply(translation(after), multiply(turn, translation({-before[0], -before[1], -before[2]})));
}

Mat4 turnOf(Mat4 motion) {
    motion[12] = motion[13] = motion[14] = 0;
    return motion;
}

Vec3 between(const Vec3& a, const Vec3& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

double distanceOf(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// No vertex goes farther from one pose to the next: along a helix of up to half a turn no more than pi / 2 times its
/// chord, and with slerp so much about the centre, which goes straight.
double longestWay(const MeshView& mesh, const Mat4& a, const Mat4& b, bool slerp, const Vec3& centre) {
    const Vec3 fromCentre = slerp ? transformPoint(a, centre) : Vec3{};
    const Vec3 toCentre = slerp ? transformPoint(b, centre) : Vec3{};
    const Vec3 moved{toCentre[0] - fromCentre[0], toCentre[1] - fromCentre[1], toCentre[2] - fromCentre[2]};
    double most = 0;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        const Vec3 vertex{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]};
        const Vec3 from = transformPoint(a, vertex);
        const Vec3 to = transformPoint(b, vertex);
        most = std::max(most, distanceOf({to[0] - moved[0], to[1] - moved[1], to[2] - moved[2]}, from));
    }
    return distanceOf(toCentre, fromCentre) + 0.5 * std::numbers::pi * most;
}

} // namespace

Result<std::vector<Mat4>> oraclePoses(const Mat4& from, const Mat4& to, Interpolation interpolation, const Vec3& centre,
                                      std::uint32_t halvings) {
    const Result<Mat4> back = inverse(from);
    VOXTACT_TRY(back);
    const Mat4 whole = multiply(to, *back);
    const bool slerp = interpolation == Interpolation::Slerp;
    Mat4 step = slerp ? turnOf(whole) : whole;
    for (std::uint32_t i = 0; i < halvings; ++i) {
        const Result<Mat4> root = squareRoot(step);
        VOXTACT_TRY(root);
        step = *root;
    }
    const Vec3 first = transformPoint(from, centre);
    const Vec3 last = transformPoint(to, centre);
    std::vector<Mat4> poses;
    Mat4 motion = identity();
    const std::uint32_t steps = 1U << halvings;
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        poses.push_back(multiply(slerp ? about(motion, first, between(first, last, t)) : motion, from));
        motion = multiply(step, motion);
    }
    return poses;
}

Result<OracleMotion> motionOracle(const OraclePair& pair, const Mat4& to, Interpolation interpolation,
                                  const Vec3& centre, std::uint32_t halvings, double resolution) {
    return guard([&]() -> Result<OracleMotion> {
        const Result<std::vector<Mat4>> poses =
            oraclePoses(pair.world_from_object, to, interpolation, centre, halvings);
        VOXTACT_TRY(poses);
        OracleMotion out;
        out.clearance = kInfinity;
        bool free = true;
        for (std::size_t i = 0; i < poses->size() && !out.touches; ++i) {
            OraclePair here = pair;
            here.world_from_object = (*poses)[i];
            const Result<OracleClearance> clearance = clearanceOracle(here, resolution);
            VOXTACT_TRY(clearance);
            double way = 0;
            for (const std::size_t next : {std::max<std::size_t>(i, 1) - 1, std::min(i + 1, poses->size() - 1)}) {
                way = std::max(way, longestWay(pair.mesh, (*poses)[i], (*poses)[next],
                                               interpolation == Interpolation::Slerp, centre));
            }
            out.clearance = std::min(out.clearance, std::max(0.0, clearance->lo - way));
            free = free && clearance->lo > way;
            const double parameter = static_cast<double>(i) / static_cast<double>(poses->size() - 1);
            out.freeUntil = free ? parameter : out.freeUntil;
            if (clearance->lo == 0) {
                const Result<CertifiedOracle> touch = certifiedOracle(here, resolution);
                VOXTACT_TRY(touch);
                if (touch->certainty == Certainty::Certain) {
                    out.touches = parameter;
                }
            }
        }
        return out;
    });
}

} // namespace voxtact::oracle
