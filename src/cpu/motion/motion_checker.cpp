// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "cpu/batch_check.h"
#include "cpu/clearance/workers.h"
#include "cpu/motion/divided_mesh.h"
#include "cpu/motion/pose_tolerance.h"
#include "cpu/motion/segment_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::cpu {

struct MotionCheckerImpl {
    explicit MotionCheckerImpl(const MotionDesc& chosen) : desc(chosen), workers(chosen.threads) {}

    MotionDesc desc;
    Workers workers;
    /// dividedMesh() of the meshes of the last batch with an angle, by MeshImpl::id.
    std::map<std::uint64_t, std::unique_ptr<MeshImpl>> divided;
};

namespace {

Result<void> checkDesc(const MotionDesc& desc) {
    VOXTACT_TRY(checkThreads(desc.threads));
    VOXTACT_TRY(checkMotion({desc.resolution, desc.interpolation}));
    if (desc.mostSteps == 0) {
        return refuse("at most 0 steps are allowed, a motion takes at least one step");
    }
    return checkResolution(desc.touchResolution);
}

/// Of all segments, in order.
Result<std::vector<RigidMotion>> motionsOf(const Batch& batch, Interpolation interpolation,
                                           const Cancellation& cancel) {
    constexpr std::size_t kBetween = 1024; // looks at the cancellation
    std::vector<RigidMotion> motions;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        for (std::size_t pose = 0; pose + 1 < item.world_from_object.size(); ++pose) {
            Result<RigidMotion> motion =
                RigidMotion::between(item.world_from_object, pose, interpolation, item.mesh->facts().bounds, i);
            VOXTACT_TRY(motion);
            motions.push_back(*motion);
            if (motions.size() % kBetween == 0) {
                VOXTACT_TRY(checkNotCancelled(cancel));
            }
        }
    }
    return motions;
}

std::vector<SegmentMotion> numberedSegments(const Batch& batch) {
    std::vector<SegmentMotion> segments;
    for (std::uint32_t item = 0; item < batch.items.size(); ++item) {
        for (std::uint32_t pose = 0; pose + 1 < batch.items[item].world_from_object.size(); ++pose) {
            SegmentMotion segment;
            segment.segment = static_cast<std::uint32_t>(segments.size());
            segment.item = item;
            segment.pose = pose;
            segments.push_back(segment);
        }
    }
    return segments;
}

/// Refuses shapes that are not of a batch.
Result<void> checkShapes(const Batch& batch, std::span<const ShapesOfPoses> shapes) {
    if (shapes.size() != batch.items.size()) {
        return refuse("there are shapes for " + std::to_string(shapes.size()) + " items, the batch has " +
                      std::to_string(batch.items.size()));
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i) + ": ";
        if (shapes[i].size() != item.world_from_object.size()) {
            return refuse(which + "there are " + std::to_string(shapes[i].size()) + " shapes for " +
                          std::to_string(item.world_from_object.size()) + " poses");
        }
        const std::vector<std::uint32_t> indices = item.mesh->impl().indices();
        for (std::size_t pose = 0; pose < shapes[i].size(); ++pose) {
            const std::span<const float> shape = shapes[i][pose];
            const std::string whose = which + "the shape of pose " + std::to_string(pose) + ": ";
            if (shape.size() != std::size_t{3} * item.mesh->facts().vertices) {
                return refuse(whose + std::to_string(shape.size()) + " coordinates, the mesh has " +
                              std::to_string(item.mesh->facts().vertices) + " vertices of three");
            }
            if (const Result<MeshFacts> facts = checkMesh({shape, indices}); !facts.ok()) {
                return refuse(whose + facts.error().text);
            }
        }
    }
    return {};
}

/// Those of a batch's meshes that are not there yet; others go.
void divideMeshes(const Batch& batch, std::map<std::uint64_t, std::unique_ptr<MeshImpl>>& divided) {
    for (const BatchItem& item : batch.items) {
        const MeshImpl& mesh = item.mesh->impl();
        if (!divided.contains(mesh.id)) {
            divided.emplace(mesh.id, dividedMesh(mesh));
        }
    }
    std::erase_if(divided, [&batch](const auto& known) {
        return std::ranges::none_of(batch.items,
                                    [&](const BatchItem& item) { return item.mesh->impl().id == known.first; });
    });
}

/// Looks at all segments of a batch. `shapes` may be empty: nothing bends.
Result<MotionAnswer> checkSegments(MotionCheckerImpl& impl, const Batch& batch, std::span<const ShapesOfPoses> shapes) {
    const StopWatch watch;
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    const Result<std::vector<RigidMotion>> motions = motionsOf(batch, impl.desc.interpolation, cancel);
    VOXTACT_TRY(motions);
    const Parts parts = impl.workers.partsOf(batch, impl.desc.touchResolution);
    MotionAnswer answer;
    answer.segments = numberedSegments(batch);
    VOXTACT_TRY(impl.workers.forEach(answer.segments, cancel, [&](SegmentMotion& segment, ThreadMemory& memory) {
        const BatchItem& item = batch.items[segment.item];
        std::optional<Bending> bending;
        if (!shapes.empty()) {
            const ShapesOfPoses of = shapes[segment.item];
            bending.emplace(item.mesh->impl(), of[segment.pose], of[segment.pose + 1]);
        }
        SegmentSearch(item, *parts[segment.item], (*motions)[segment.segment], impl.desc, memory, segment.pose, &cancel,
                      bending ? &*bending : nullptr)
            .run(segment);
    }));
    answer.wallMilliseconds = watch.milliseconds();
    return answer;
}

} // namespace

MotionChecker::MotionChecker(std::unique_ptr<MotionCheckerImpl> impl) noexcept : impl_(std::move(impl)) {}
MotionChecker::MotionChecker(MotionChecker&&) noexcept = default;
MotionChecker& MotionChecker::operator=(MotionChecker&&) noexcept = default;
MotionChecker::~MotionChecker() = default;

Result<MotionChecker> MotionChecker::create(const MotionDesc& desc) {
    return guard([&]() -> Result<MotionChecker> {
        VOXTACT_TRY(checkDesc(desc));
        return MotionChecker(std::make_unique<MotionCheckerImpl>(desc));
    });
}

Result<MotionAnswer> MotionChecker::check(const Batch& batch) {
    return guard([&]() -> Result<MotionAnswer> {
        VOXTACT_TRY(checkCertifiedBatch(batch));
        return checkSegments(*impl_, batch, {});
    });
}

Result<MotionAnswer> MotionChecker::checkBending(const Batch& batch, std::span<const ShapesOfPoses> shapes) {
    return guard([&]() -> Result<MotionAnswer> {
        VOXTACT_TRY(checkCertifiedBatch(batch));
        VOXTACT_TRY(checkShapes(batch, shapes));
        return checkSegments(*impl_, batch, shapes);
    });
}

Result<BatchAnswer> MotionChecker::around(const Batch& batch, const PoseTolerance& tolerance) {
    return guard([&]() -> Result<BatchAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkCertifiedBatch(batch));
        VOXTACT_TRY(checkTolerance(tolerance));
        const Cancellation cancel(batch.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        if (tolerance.angle > 0) {
            divideMeshes(batch, impl_->divided);
        }
        BatchAnswer answer;
        answer.pairs = numberedPairs<PairAnswer>(batch);
        Workers& workers = impl_->workers;
        VOXTACT_TRY(workers.forEachPair(
            batch, cancel, workers.partsOf(batch, impl_->desc.touchResolution), answer.pairs,
            [&](const PairAt& at, PairAnswer& pair, ThreadMemory& memory) {
                const MeshImpl* divided = tolerance.angle > 0 ? impl_->divided.at(at.mesh().id).get() : nullptr;
                PoseToleranceSearch(at, divided, tolerance, impl_->desc.mostSteps, memory).run(pair);
            }));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

std::uint32_t MotionChecker::threads() const noexcept {
    return impl_->workers.threads();
}

} // namespace voxtact::cpu
