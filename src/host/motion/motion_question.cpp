// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "host/batch_check.h"
#include "host/host_engine.h"
#include "host/motion/divided_mesh.h"
#include "host/motion/pose_tolerance.h"
#include "host/motion/segment_search.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::cpu {

namespace {

Result<void> checkMotion(const Motion& question) {
    VOXTACT_TRY(checkFact(factOf("motion", "resolution"), question.resolution));
    VOXTACT_TRY(checkInterpolation(question.interpolation));
    VOXTACT_TRY(checkSteps(question.maxSteps));
    return checkFact(factOf("count", "resolution"), question.touchResolution);
}

/// Segments of all items, in order.
Result<std::vector<RigidMotion>> motionsOf(const Batch& batch, Interpolation interpolation,
                                           const Cancellation& cancel) {
    constexpr std::size_t kBetween = 1024; // segments between two checks for cancellation
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
            const std::span<const double> shape = shapes[i][pose];
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

/// Caches the meshes of a batch; evicts others.
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

Result<MotionAnswer> checkSegments(HostEngineImpl& impl, const Motion& question, const Batch& batch) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    const Result<std::vector<RigidMotion>> motions = motionsOf(batch, question.interpolation, cancel);
    VOXTACT_TRY(motions);
    const Parts parts = impl.workers.partsOf(batch, question.touchResolution);
    MotionAnswer answer;
    answer.segments = numberedSegments(batch);
    VOXTACT_TRY(impl.workers.forEach(answer.segments, cancel, [&](SegmentMotion& segment, ThreadMemory& memory) {
        const BatchItem& item = batch.items[segment.item];
        std::optional<Bending> bending;
        if (!question.shapes.empty()) {
            const ShapesOfPoses of = question.shapes[segment.item];
            bending.emplace(item.mesh->impl(), of[segment.pose], of[segment.pose + 1]);
        }
        SegmentSearch(item, *parts[segment.item], (*motions)[segment.segment], question, memory, segment.pose, &cancel,
                      bending ? &*bending : nullptr)
            .run(segment);
    }));
    return answer;
}

} // namespace

Result<MotionAnswer> HostEngine::ask(const Motion& question, const Batch& batch) {
    return guard([&]() -> Result<MotionAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkMotion(question));
        VOXTACT_TRY(checkCertifiedBatch(batch));
        if (!question.shapes.empty()) {
            VOXTACT_TRY(checkShapes(batch, question.shapes));
        }
        Result<MotionAnswer> answer = checkSegments(*impl_, question, batch);
        if (answer.ok()) {
            answer->wallMilliseconds = watch.milliseconds();
        }
        return answer;
    });
}

Result<TouchAnswer> touchAround(HostEngineImpl& impl, const Touch& question, const Batch& batch) {
    const Cancellation cancel(batch.cancel);
    VOXTACT_TRY(checkNotCancelled(cancel));
    const PoseTolerance& tolerance = *question.uncertainty;
    if (tolerance.angle > 0) {
        divideMeshes(batch, impl.divided);
    }
    TouchAnswer answer;
    answer.pairs = numberedPairs<PairTouch>(batch);
    VOXTACT_TRY(impl.workers.forEachPair(
        batch, cancel, impl.workers.partsOf(batch, question.resolution), answer.pairs,
        [&](const PairAt& at, PairTouch& pair, ThreadMemory& memory) {
            const MeshImpl* divided = tolerance.angle > 0 ? impl.divided.at(at.mesh().id).get() : nullptr;
            PoseToleranceSearch(at, divided, tolerance, question.maxSteps, memory).run(pair);
        }));
    return answer;
}

} // namespace voxtact::cpu
