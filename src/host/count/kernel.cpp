// SPDX-License-Identifier: MIT
#include "host/count/kernel.h"
#include "host/count/scratch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/count/kernel.cpp"
#include <hwy/foreach_target.h>

#include "host/count/simd_cull.h"
#include "host/count/simd_large.h"
#include "host/count/simd_small.h"
#include "host/count/simd_vertex.h"

HWY_BEFORE_NAMESPACE();
namespace voxtact::cpu {
namespace HWY_NAMESPACE {
namespace {

/// Lanes of a vector of triangles, by their classification.
struct Sorted {
    IntM small;
    IntM lone; ///< through the scalar set-up: large, or with a corner outside
};

/// Expects unusable corners at 0.
HWY_INLINE Sorted sortTriangles(const ViewFacts& view, const Corners& corners) {
    const Ints ints;
    const PixelBox box = pixelBox(view, corners);
    const IntM live = hn::Not(hn::Or(hn::Lt(box.maxX, box.minX), hn::Lt(box.maxY, box.minY)));
    const IntV limit = hn::Set(ints, kSmallPixels * 256 - 1);
    const IntV width = hn::Sub(most(corners.x), least(corners.x));
    const IntV height = hn::Sub(most(corners.y), least(corners.y));
    const IntM large = hn::Gt(hn::Max(width, height), limit);
    return {hn::AndNot(large, live), hn::And(large, live)};
}

/// Takes out the triangles with corners outside or with an unusable w, and those beyond the image.
HWY_INLINE Sorted sortByState(const VertexLanes& vertices, const IntV (&vertex)[3], const Sorted& sorted) {
    const Ints ints;
    const IntV zero = hn::Zero(ints);
    const IntV a = hn::GatherIndex(ints, vertices.state, vertex[0]);
    const IntV b = hn::GatherIndex(ints, vertices.state, vertex[1]);
    const IntV c = hn::GatherIndex(ints, vertices.state, vertex[2]);
    const IntV any = hn::Or(hn::Or(a, b), c);
    const IntV outside = hn::And(any, hn::Set(ints, kOutsideBits));
    // Clipping goes plane by plane: without clipping, only the first cutting plane can prove that nothing is left.
    const IntV firstPlane = hn::And(outside, hn::Neg(outside));
    const IntV all = hn::And(hn::And(a, b), c);
    const IntM gone = hn::Ne(hn::And(all, hn::Or(firstPlane, hn::Set(ints, kBeyondBits))), zero);
    const IntM clipped = hn::Ne(outside, zero);
    const IntM clean = hn::Eq(hn::And(any, hn::Set(ints, kOutsideBits | kBadW)), zero);
    return {hn::AndNot(gone, hn::And(sorted.small, clean)),
            hn::AndNot(gone, hn::Or(hn::And(sorted.lone, clean), clipped))};
}

/// Rasterises the clusters of one list.
template <class Kept> class Pass {
  public:
    Pass(const PairJob& job, const Sampler<Kept>& sampler, bool certain, Scratch& scratch)
        : job_(job), sampler_(sampler), certain_(certain), scratch_(scratch) {}

    std::uint64_t run(std::span<const std::uint32_t> clusters) {
        scratch_.pending.count = 0;
        for (const std::uint32_t cluster : clusters) {
            if (used_ + kMostClusterVertices > kScratchVertices) {
                flush();
                used_ = 0;
            }
            addCluster(cluster);
            if (done()) {
                return survivors_;
            }
        }
        flush();
        return survivors_;
    }

  private:
    [[nodiscard]] bool done() const { return (job_.stopAtFirst && survivors_ > 0) || isCancelled(job_.cancel); }

    void flush() {
        while (scratch_.pending.count > 0) {
            rasterise();
        }
    }

    void rasterise() {
        survivors_ += rasteriseSmall(job_, sampler_, certain_, scratch_);
        dropPending(scratch_.pending);
    }

    void addCluster(std::uint32_t cluster) {
        const ClusterPlace& place = job_.mesh.clusters[cluster];
        if (job_.dominantAxis != nullptr) {
            for (std::uint32_t i = 0; i < place.triangleCount; ++i) {
                scratch_.lone.push_back({cluster, place.firstTriangle + i});
            }
        } else {
            transformCluster(cluster, place);
        }
        for (const LoneTriangle& lone : scratch_.lone) {
            survivors_ += rasteriseLone(job_, sampler_, certain_, lone);
            if (done()) {
                break;
            }
        }
        scratch_.lone.clear();
    }

    /// Lists the triangles for the scalar set-up, and keeps the others for a full vector.
    void transformCluster(std::uint32_t cluster, const ClusterPlace& place) {
        const std::int32_t states = transformVertices(job_, place, !certain_, used_, scratch_.vertices);
        const bool clean = (states & (kOutsideBits | kBadW | kBeyondBits)) == 0;
        for (std::uint32_t i = 0; i < place.triangleCount; i += static_cast<std::uint32_t>(hn::Lanes(Ints()))) {
            addTriangles(cluster, place.firstTriangle + i, clean);
        }
        used_ += place.vertexCount;
    }

    HWY_INLINE void addTriangles(std::uint32_t cluster, std::size_t first, bool clean) {
        const Ints ints;
        const hn::Rebind<std::uint8_t, Ints> bytes;
        const MeshImpl& mesh = job_.mesh;
        const VertexLanes& vertices = scratch_.vertices;
        const IntV base = hn::Set(ints, static_cast<std::int32_t>(used_));
        const std::uint8_t* corner[3] = {mesh.corner0.data(), mesh.corner1.data(), mesh.corner2.data()};
        IntV vertex[3];
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i) {
            vertex[i] = hn::Add(base, hn::PromoteTo(ints, hn::LoadU(bytes, corner[i] + first)));
            corners.x[i] = hn::GatherIndex(ints, vertices.x, vertex[i]);
            corners.y[i] = hn::GatherIndex(ints, vertices.y, vertex[i]);
        }
        Sorted sorted = sortTriangles(job_.view, corners);
        if (!clean) {
            sorted = sortByState(vertices, vertex, sorted);
        }
        listLone(cluster, first, sorted.lone);
        addPending(corners, vertex, sorted.small);
    }

    HWY_INLINE void listLone(std::uint32_t cluster, std::size_t first, IntM lone) {
        const Ints ints;
        if (HWY_LIKELY(hn::AllFalse(ints, lone))) {
            return;
        }
        HWY_ALIGN std::int32_t lanes[kMaxLanes];
        const std::size_t count = hn::CountTrue(ints, lone);
        hn::Store(hn::Compress(hn::Iota(ints, 0), lone), ints, lanes);
        for (std::size_t i = 0; i < count; ++i) {
            scratch_.lone.push_back(
                {cluster, static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(lanes[i])});
        }
    }

    HWY_INLINE void addPending(const Corners& corners, const IntV (&vertex)[3], IntM small) {
        const Ints ints;
        PendingTriangles& pending = scratch_.pending;
        const std::size_t count = hn::CountTrue(ints, small);
        if (count == 0) {
            return;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            hn::StoreU(hn::Compress(corners.x[i], small), ints, pending.x[i] + pending.count);
            hn::StoreU(hn::Compress(corners.y[i], small), ints, pending.y[i] + pending.count);
            hn::StoreU(hn::Compress(vertex[i], small), ints, pending.vertex[i] + pending.count);
        }
        pending.count += count;
        if (pending.count >= hn::Lanes(ints)) {
            rasterise();
        }
    }

    const PairJob& job_;
    const Sampler<Kept>& sampler_;
    bool certain_;
    Scratch& scratch_;
    std::size_t used_ = 0;
    std::uint64_t survivors_ = 0;
};

template <class Kept> std::uint64_t countWith(const PairJob& job, const Kept* voxels, Scratch& scratch) {
    const Sampler<Kept> sampler(job, voxels);
    std::uint64_t survivors = Pass<Kept>(job, sampler, true, scratch).run(scratch.certainClusters);
    if (job.stopAtFirst && survivors > 0) {
        return survivors;
    }
    return survivors + Pass<Kept>(job, sampler, false, scratch).run(scratch.mixedClusters);
}

std::uint64_t count(const PairJob& job, Scratch& scratch) {
    sortClusters(job, scratch);
    return job.volume.image.visit([&](const auto* voxels) { return countWith(job, voxels, scratch); });
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace voxtact::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxtact::cpu {

HWY_EXPORT(count);

void ScratchDeleter::operator()(Scratch* scratch) const noexcept {
    delete scratch;
}

ScratchPointer makeScratch() {
    return ScratchPointer(new Scratch());
}

std::uint64_t countSurvivors(const PairJob& job, Scratch& scratch) {
    const std::uint64_t survivors = HWY_DYNAMIC_DISPATCH(count)(job, scratch);
    return job.stopAtFirst && survivors > 0 ? 1 : survivors;
}

} // namespace voxtact::cpu
#endif
