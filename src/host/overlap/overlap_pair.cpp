// SPDX-License-Identifier: MIT
#include "host/overlap/overlap_pair.h"
#include "core/base/infinity.h"
#include "host/overlap/containment.h"
#include "host/overlap/inside_point.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace voxtact::cpu {

namespace {

using glm::dmat3;
using glm::dvec3;

/// A determinant, which may be off by so much.
struct Determinant {
    double value = 0;
    double error = 0;
};

Determinant determinantOf(const dmat3& m) {
    const double value = glm::dot(m[0], glm::cross(m[1], m[2]));
    return {value, 0x1p-46 * glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2])};
}

/// The volume of the whole solid.
Bounds solidBounds(const SolidSurface& solid, const MeshImpl& mesh, const Determinant& pose) {
    const double r = mesh.origin.rounding;
    const double error = solid.volumeError + 2 * r * (solid.area + r * std::sqrt(solid.area * 4) + r * r);
    const double volume = std::abs(solid.volume);
    const double scale = std::abs(pose.value);
    constexpr double kDown = 1 - 0x1p-50;
    return {std::max(volume - error, 0.0) * std::max(scale - pose.error, 0.0) * kDown,
            (volume + error) * (scale + pose.error) / kDown};
}

class PairRun {
  public:
    PairRun(const Overlap& question, const OverlapItem& made, const BatchItem& item, const Mat4& world_from_object,
            const OverlapMemory& memory, CancelFlag cancel)
        : question_(question), made_(made), item_(item), world_from_object_(world_from_object), mesh_(memory.mesh),
          surface_(memory.surface), space_(made.part->part.space), volume_(item.volume->impl()), cancel_(cancel) {
        mesh_.begin(item.mesh->impl(), space_, world_from_object);
        voxel_ = determinantOf(space_.local_from_voxel);
        voxel_.value = std::abs(voxel_.value);
        dmat3 linear(1);
        for (int column = 0; column < 3; ++column) {
            const auto at = static_cast<std::size_t>(4 * column);
            linear[column] = {world_from_object[at], world_from_object[at + 1], world_from_object[at + 2]};
        }
        pose_ = determinantOf(linear);
    }

    PairMeasures run() {
        out_.solid = solidBounds(*made_.solid, item_.mesh->impl(), pose_);
        if (!isPlaceKnown()) {
            setUnknown();
            return out_;
        }
        const bool isMirrored =
            (pose_.value < 0) != (glm::dot(space_.local_from_voxel[0],
                                           glm::cross(space_.local_from_voxel[1], space_.local_from_voxel[2])) < 0);
        surface_.begin(*made_.solid, mesh_, volume_, space_, isMirrored, cancel_);
        error_ = surface_.displaced() * (1 + 0x1p-40);
        out_.whole = measure(*made_.part, nullptr).front();
        if (made_.wantsPoint && out_.whole.inside != Containment::None) {
            out_.inside = opaquePointInside(volume_, *made_.part, surface_, mesh_, cancel_);
        }
        if (made_.labels != nullptr) {
            out_.labels = measure(*made_.part, made_.labels);
        }
        if (!made_.limits.empty()) {
            measureBands();
        }
        return out_;
    }

  private:
    /// Positions must be known to a part of a voxel, and the solid side of each triangle.
    [[nodiscard]] bool isPlaceKnown() const {
        constexpr double kMaxReach = 0.25 / 16;
        return reach() < kMaxReach && std::abs(pose_.value) > 2 * pose_.error && voxel_.value > 2 * voxel_.error;
    }
    /// Voxels.
    [[nodiscard]] double reach() const {
        const dvec3 place = 2 * mesh_.error() / space_.spacing;
        const double most = std::max({place.x, place.y, place.z});
        if (std::isfinite(most)) {
            return most;
        }
        return kInfinity;
    }

    void setUnknown() {
        const Measure unknown{{0, out_.solid.upper}, Containment::Undecided, StopReason::Rounding};
        out_.whole = unknown;
        out_.labels.assign(made_.labels != nullptr ? made_.labels->count : 0, unknown);
        out_.bands.assign(made_.limits.size(), unknown);
    }

    /// `part`: of the tolerance.
    [[nodiscard]] OverlapGoal goal(double part) const {
        const double own = std::max(question_.tolerance - 2 * error_, question_.tolerance / 2);
        return {part * own / (voxel_.value + voxel_.error) * (1 - 0x1p-30), question_.maxSteps, cancel_};
    }

    /// Converts voxels to mm^3, and adds the error of the surface.
    [[nodiscard]] Bounds boundsOf(const Bounds& voxels, double error) const {
        constexpr double kDown = 1 - 0x1p-50;
        const double lower = std::max(voxels.lower * (voxel_.value - voxel_.error) * kDown - error, 0.0);
        const double upper = std::min(voxels.upper * (voxel_.value + voxel_.error) / kDown + error, out_.solid.upper);
        return {std::min(lower, upper), upper};
    }
    [[nodiscard]] StopReason endOf(const Bounds& bounds, StopReason end) const {
        return bounds.upper - bounds.lower <= question_.tolerance
                   ? StopReason::Closed
                   : (end == StopReason::Closed ? StopReason::Rounding : end);
    }

    std::vector<Measure> measure(const OverlapPart& part, const OverlapLabels* labels) {
        OverlapGoal own = goal(1);
        own.error = 2 * error_ / std::max(voxel_.value - voxel_.error, 0.0) + 0x1p-40;
        own.isSomeOutside = labels == nullptr && part.isCertainOutside(volume_, surface_.bricks());
        const std::vector<OverlapFound> found = measureOverlap(volume_, part, surface_, labels, own);
        std::vector<Measure> out(found.size());
        if (isCancelled(cancel_)) {
            return out;
        }
        ContainmentFacts facts;
        facts.error = own.error;
        facts.isSomeOutside = own.isSomeOutside;
        facts.reach = 2 * reach() + 2 * surface_.rounding();
        const bool isClear = std::ranges::any_of(
            found, [](const OverlapFound& one) { return one.isCrossed && (!one.mayOverlap || !one.mayLeave); });
        if (isClear) {
            std::optional<TouchPoint> point;
            const CertifiedTally touch = PairAt{item_, part.part, world_from_object_, cancel_}.touch(point);
            facts.mayTouch = touch.certain != 0 || touch.undecided;
        }
        const std::vector<Containment> inside = containmentsOf(volume_, part, surface_, labels, found, facts);
        for (std::size_t i = 0; i < found.size(); ++i) {
            out[i].inside = inside[i];
            out[i].bounds = inside[i] == Containment::None ? Bounds{} : boundsOf(found[i].bounds, error_);
            out[i].end = endOf(out[i].bounds, found[i].end);
        }
        return out;
    }

    /// A band is the part at or above its lower limit, minus the part at or above its upper limit.
    void measureBands() {
        std::vector<OverlapFound> from;
        for (const auto& part : made_.limits) {
            from.push_back(measureOverlap(volume_, *part, surface_, nullptr, goal(0.5)).front());
        }
        from.emplace_back(); // nothing
        for (std::size_t band = 0; band + 1 < from.size(); ++band) {
            const OverlapFound& lower = from[band];
            const OverlapFound& upper = from[band + 1];
            constexpr double kDown = 1 - 0x1p-50;
            const Bounds voxels{std::max(lower.bounds.lower * kDown - upper.bounds.upper / kDown, 0.0),
                                std::max(lower.bounds.upper / kDown - upper.bounds.lower * kDown, 0.0)};
            Measure& out = out_.bands.emplace_back();
            out.bounds = boundsOf(voxels, error_);
            const bool isBudget = lower.end == StopReason::Budget || upper.end == StopReason::Budget;
            out.end = endOf(out.bounds, isBudget ? StopReason::Budget : StopReason::Rounding);
        }
    }

    const Overlap& question_;
    const OverlapItem& made_;
    const BatchItem& item_;
    const Mat4& world_from_object_;
    MeshPlace& mesh_;
    PairSurface& surface_;
    const VolumeSpace& space_;
    const VolumeImpl& volume_;
    CancelFlag cancel_;
    Determinant voxel_; ///< mm^3 of a voxel
    Determinant pose_;
    double error_ = 0; ///< mm^3
    PairMeasures out_;
};

} // namespace

PairMeasures measurePair(const Overlap& question, const OverlapItem& made, const BatchItem& item,
                         const Mat4& world_from_object, const OverlapMemory& memory, CancelFlag cancel) {
    return PairRun(question, made, item, world_from_object, memory, cancel).run();
}

} // namespace voxtact::cpu
