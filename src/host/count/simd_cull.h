// SPDX-License-Identifier: MIT
// Which clusters of a pair may have a survivor. Everything here errs to the side of keeping a cluster, and of not
// calling it certain.
#if defined(VOXTACT_CPU_SIMD_CULL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXTACT_CPU_SIMD_CULL_H
#undef VOXTACT_CPU_SIMD_CULL_H
#else
#define VOXTACT_CPU_SIMD_CULL_H
#endif

#include "host/count/simd_base.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {

/// Boxes of as many clusters as there are lanes.
struct ClusterBoxes {
    FloatV x, y, z;
    FloatV halfX, halfY, halfZ;
};

/// Minimum and maximum of a form over the boxes, without its margin.
struct FormRange {
    FloatV lo, hi;
};

HWY_INLINE FormRange rangeOf(const Form& form, const ClusterBoxes& boxes) {
    const Floats d;
    const FloatV x = hn::Set(d, form.x);
    const FloatV y = hn::Set(d, form.y);
    const FloatV z = hn::Set(d, form.z);
    const FloatV centre = hn::Add(hn::Add(hn::Mul(x, boxes.x), hn::Mul(y, boxes.y)),
                                  hn::Add(hn::Mul(z, boxes.z), hn::Set(d, form.constant)));
    const FloatV half = hn::Add(hn::Add(hn::Mul(hn::Abs(x), boxes.halfX), hn::Mul(hn::Abs(y), boxes.halfY)),
                                hn::Mul(hn::Abs(z), boxes.halfZ));
    return {hn::Sub(centre, half), hn::Add(centre, half)};
}

/// Perspective makes the error of interpolated coordinates grow with the ratio of the w of a triangle's corners.
constexpr float kMostRatio = 4096;

struct Depth {
    FloatV ratio; ///< ratio of the largest w to the smallest
    hn::Mask<Floats> usable;
};

HWY_INLINE Depth depthOf(const PairJob& job, const ClusterBoxes& boxes) {
    const Floats d;
    const FloatV one = hn::Set(d, 1.0F);
    if (job.orthographic) {
        return {one, hn::Eq(one, one)};
    }
    const FloatV margin = hn::Set(d, job.cull.w.margin);
    const FormRange w = rangeOf(job.cull.w, boxes);
    const FloatV smallest = hn::Sub(w.lo, margin);
    const FloatV largest = hn::Add(w.hi, margin);
    const auto usable =
        hn::And(hn::Gt(smallest, hn::Set(d, 1e-20F)), hn::Lt(largest, hn::Mul(smallest, hn::Set(d, kMostRatio))));
    return {hn::IfThenElse(usable, hn::Div(largest, smallest), one), usable};
}

/// The brick of a coordinate, `slack` voxels to one side.
HWY_INLINE IntV brickOf(FloatV coordinate, float slack, std::int32_t size) {
    const Floats d;
    const Ints ints;
    const FloatV clamped = hn::Min(hn::Max(coordinate, hn::Zero(d)), hn::Set(d, 1.0F));
    const FloatV shifted = hn::Add(hn::Mul(clamped, hn::Set(d, static_cast<float>(size))), hn::Set(d, slack - 0.5F));
    const IntV cell = hn::Add(hn::ConvertTo(ints, hn::Floor(shifted)), hn::Set(ints, 1));
    return hn::ShiftRight<kBrickShift>(hn::Min(hn::Max(cell, hn::Zero(ints)), hn::Set(ints, size)));
}

/// Fills the scratch's cull lanes for the clusters from `first` on.
HWY_INLINE void boxClusters(const PairJob& job, std::size_t first, CullLanes& out) {
    const Floats d;
    const Ints ints;
    const MeshImpl& mesh = job.mesh;
    const ClusterBoxes boxes{hn::LoadU(d, mesh.centreX.data() + first), hn::LoadU(d, mesh.centreY.data() + first),
                             hn::LoadU(d, mesh.centreZ.data() + first), hn::LoadU(d, mesh.halfX.data() + first),
                             hn::LoadU(d, mesh.halfY.data() + first),   hn::LoadU(d, mesh.halfZ.data() + first)};
    const FloatV zero = hn::Zero(d);
    const FloatV one = hn::Set(d, 1.0F);
    auto skip = hn::Lt(one, zero);
    for (const Form& form : job.cull.outside) {
        skip = hn::Or(skip, hn::Lt(rangeOf(form, boxes).hi, hn::Set(d, -form.margin)));
    }
    const Depth depth = depthOf(job, boxes);
    auto leaves = hn::Lt(one, zero);
    auto inside = depth.usable;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Form& form = job.cull.texture[axis];
        const FormRange range = rangeOf(form, boxes);
        const FloatV margin = hn::Mul(depth.ratio, hn::Set(d, form.margin));
        const FloatV lo = hn::Sub(range.lo, margin);
        const FloatV hi = hn::Add(range.hi, margin);
        leaves = hn::Or(leaves, hn::Or(hn::Lt(hi, zero), hn::Gt(lo, one)));
        inside = hn::And(inside, hn::And(hn::Ge(lo, zero), hn::Le(hi, one)));
        const std::int32_t size = job.volume.image.size[axis];
        const float slack = 0x1p-14F + static_cast<float>(size) * 0x1p-22F;
        hn::StoreU(brickOf(lo, -slack, size), ints, out.lo[axis]);
        hn::StoreU(brickOf(hi, slack, size), ints, out.hi[axis]);
    }
    if (job.view.rangeTest) {
        skip = hn::Or(skip, hn::And(depth.usable, leaves));
    }
    const auto flag = [&](auto mask, CullVerdict verdict) {
        return hn::IfThenElseZero(hn::RebindMask(ints, mask), hn::Set(ints, static_cast<std::int32_t>(verdict)));
    };
    const IntV unsure = hn::IfThenElse(hn::RebindMask(ints, depth.usable), hn::Zero(ints),
                                       hn::Set(ints, static_cast<std::int32_t>(kCullUnsure)));
    hn::StoreU(hn::Or(hn::Or(flag(skip, kCullSkip), flag(inside, kCullInside)), unsure), ints, out.verdict);
}

HWY_INLINE void sortCluster(const PairJob& job, std::uint32_t cluster, std::size_t lane, Scratch& scratch) {
    const CullLanes& lanes = scratch.cull;
    const std::int32_t verdict = lanes.verdict[lane];
    if ((verdict & kCullSkip) != 0) {
        return;
    }
    BrickClass found = kMixedBrick;
    if ((verdict & kCullUnsure) == 0) {
        BrickBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = lanes.lo[axis][lane];
            box.hi[axis] = lanes.hi[axis][lane];
        }
        found = job.occupancy.within(box);
    }
    if (found == kOpaqueBrick && ((verdict & kCullInside) != 0 || !job.view.rangeTest)) {
        scratch.certainClusters.push_back(cluster);
    } else if (found != kClearBrick) {
        scratch.mixedClusters.push_back(cluster);
    }
}

/// Fills the scratch's two lists of clusters.
HWY_INLINE void sortClusters(const PairJob& job, Scratch& scratch) {
    scratch.certainClusters.clear();
    scratch.mixedClusters.clear();
    if (!job.cull.usable) {
        for (std::uint32_t cluster = job.clusterBegin; cluster < job.clusterEnd; ++cluster) {
            scratch.mixedClusters.push_back(cluster);
        }
        return;
    }
    const std::size_t lanes = hn::Lanes(Floats());
    // Begins at a multiple of the lanes, so the padding covers the last load.
    for (std::size_t first = job.clusterBegin / lanes * lanes; first < job.clusterEnd; first += lanes) {
        boxClusters(job, first, scratch.cull);
        const std::size_t begin = std::max<std::size_t>(first, job.clusterBegin);
        const std::size_t end = std::min<std::size_t>(first + lanes, job.clusterEnd);
        for (std::size_t cluster = begin; cluster < end; ++cluster) {
            sortCluster(job, static_cast<std::uint32_t>(cluster), cluster - first, scratch);
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#endif
