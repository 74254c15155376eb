// SPDX-License-Identifier: MIT
#include "host/area/area_search.h"
#include "core/base/infinity.h"
#include "host/area/area_sum.h"
#include "host/area/area_walk.h"
#include "host/area/open_parts.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace voxtact::cpu {

namespace {

/// One sum of the measurement, with its divisible parts.
struct Slot {
    explicit Slot(std::uint64_t maxSteps) : open(maxSteps) {}

    AreaSum sum;
    OpenParts open;
};

/// Per triangle, the sum over all slots, if requested.
class TriangleSums {
  public:
    explicit TriangleSums(bool areAsked) : areAsked_(areAsked) {}

    /// Begins a triangle. The next triangle reuses the index of its frame if no part of it can be divided.
    void begin(std::uint32_t frame, std::uint32_t triangle, double whole) {
        if (areAsked_) {
            sums_.push_back({triangle, whole, {}, 0});
            ofFrame_.resize(std::size_t{frame} + 1);
            ofFrame_[frame] = sums_.size() - 1;
        }
    }
    void add(std::uint32_t frame, const PartArea& area) noexcept {
        if (areAsked_ && area.hi > 0) {
            Sum& sum = sums_[ofFrame_[frame]];
            sum.sum.add(area);
            ++sum.parts;
        }
    }
    void takeBack(std::uint32_t frame, const PartArea& area) noexcept {
        if (areAsked_ && area.hi > 0) {
            Sum& sum = sums_[ofFrame_[frame]];
            sum.sum.takeBack(area);
            --sum.parts;
        }
    }
    /// Drops the last frame: it will not be divided.
    void end() {
        if (areAsked_ && sums_.back().parts == 0) {
            sums_.pop_back();
        }
    }
    /// The triangles that may have an area, by index.
    [[nodiscard]] std::vector<TriangleFound> found() const {
        std::vector<TriangleFound> found;
        for (const Sum& one : sums_) {
            if (one.parts > 0) {
                found.push_back({one.triangle, one.whole, one.sum.bounds()});
            }
        }
        std::ranges::sort(found, {}, &TriangleFound::triangle);
        return found;
    }

  private:
    struct Sum {
        std::uint32_t triangle = 0;
        double whole = 0;
        AreaSum sum;
        std::size_t parts = 0; ///< parts that may have an area; without any, the rounding error of the sum is 0, too
    };

    bool areAsked_;
    std::vector<Sum> sums_;
    std::vector<std::size_t> ofFrame_; ///< numbers of `sums_`
};

class AreaSearch {
  public:
    /// `labels`: null where there is one slot for all.
    AreaSearch(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh, const AreaLabels* labels,
               std::size_t slots, const AreaGoal& goal, bool byTriangle)
        : part_(part), mesh_(mesh), goal_(goal), slack_(part.space, mesh.error()), measure_(volume, part, slack_),
          walk_(volume, part, slack_, measure_, labels != nullptr), slots_(slots, Slot(goal.maxSteps)),
          triangles_(byTriangle) {
        if (labels != nullptr) {
            labels_.emplace(*labels, part.space, slack_);
        }
    }

    std::vector<AreaFound> run() {
        lookAtAll();
        std::vector<AreaFound> found;
        for (Slot& slot : slots_) {
            found.push_back(finish(slot));
        }
        return found;
    }
    /// Results of the parts that were run.
    [[nodiscard]] std::vector<TriangleFound> triangles() const { return triangles_.found(); }

  private:
    [[nodiscard]] bool goesOn() const { return !isCancelled(goal_.cancel); }

    /// Each slot has its own iterations, so its result does not depend on other slots.
    AreaFound finish(Slot& slot) {
        std::uint64_t steps = 0;
        while (!slot.sum.within(goal_.tolerance) && !slot.open.empty() && steps < goal_.maxSteps && goesOn()) {
            divide(slot.open.takeBest());
            ++steps;
        }
        const StopReason apart = slot.open.empty() ? StopReason::Rounding : StopReason::Budget;
        return {slot.sum.bounds(), slot.sum.within(goal_.tolerance) ? StopReason::Closed : apart};
    }

    void lookAtAll() {
        const ClusterTree& tree = mesh_.mesh().tree;
        tree.descend(
            0, static_cast<std::uint32_t>(mesh_.mesh().clusters.size()),
            [this](const RunBox& box) {
                glm::dvec3 lo;
                glm::dvec3 hi;
                mesh_.voxelBounds(box, lo, hi);
                return walk_.mayTouch(lo, hi);
            },
            [this](std::uint32_t run) {
                lookAtRun(run);
                return goesOn();
            });
    }

    void lookAtRun(std::uint32_t run) {
        const std::uint32_t cluster = run / ClusterTree::kRunsOfCluster;
        const std::uint32_t first = run % ClusterTree::kRunsOfCluster * kRunTriangles;
        const PlacedCluster& placed = mesh_.cluster(cluster);
        for (std::uint32_t i = 0; i < mesh_.count(run); ++i) {
            const PlacedTriangle triangle = placed.triangle(first + i);
            if (!walk_.mayTouch(triangle.lo, triangle.hi)) {
                continue;
            }
            const auto number = static_cast<std::uint32_t>(frames_.size());
            const AreaFrame frame(part_.space, triangle.corners, mesh_.error());
            triangles_.begin(number, mesh_.mesh().numbers[mesh_.first(run) + i],
                             0.5 * parallelogramOf(triangle.corners));
            bool isOpen = false;
            walk_.triangle(
                frame, number, [this] { return goesOn(); },
                [&](const CellPart& part) { isOpen = addByLabel(frame, part) || isOpen; },
                [&](const UvPolygon& polygon) { sum(0, number, PartMeasure::whole(frame, polygon)); });
            if (isOpen) {
                frames_.push_back(frame);
            } else {
                triangles_.end();
            }
        }
    }

    /// True if some part can be divided.
    bool addByLabel(const AreaFrame& frame, const CellPart& part) {
        if (!labels_) {
            return add(frame, part);
        }
        bool isOpen = false;
        labels_->cut(frame, part, [&](const CellPart& labelled) { isOpen = add(frame, labelled) || isOpen; });
        return isOpen;
    }

    /// True if the part can be divided.
    bool add(const AreaFrame& frame, const CellPart& part) {
        const PartArea area = measure_.area(frame, part);
        sum(part.slot, part.frame, area);
        if (area.gain > 0) {
            slots_[part.slot].open.add(part, area);
        }
        return area.gain > 0;
    }

    void sum(std::size_t slot, std::uint32_t frame, const PartArea& area) {
        slots_[slot].sum.add(area);
        triangles_.add(frame, area);
    }

    void divide(const OpenParts::Open& open) {
        const AreaFrame& frame = frames_[open.part.frame];
        const int axis = open.area.axis;
        const AreaBox box(frame, open.part.polygon);
        const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
        CellPart below = open.part;
        CellPart above = open.part;
        const Heights heights = heightsAlong(frame, open.part.polygon, axis, middle);
        if (!split(open.part.polygon, heights, slack_.cut(axis), below.polygon, above.polygon) ||
            below.polygon.empty() || above.polygon.empty()) {
            return; // as it is
        }
        slots_[open.part.slot].sum.takeBack(open.area);
        triangles_.takeBack(open.part.frame, open.area);
        add(frame, below);
        add(frame, above);
    }

    const OpaquePart& part_;
    MeshPlace& mesh_;
    AreaGoal goal_;
    AreaSlack slack_;
    PartMeasure measure_;
    AreaWalk walk_;
    std::vector<AreaFrame> frames_; ///< of the triangles that have parts that may be divided
    std::vector<Slot> slots_;
    TriangleSums triangles_;
    std::optional<LabelCut> labels_;
};

/// True if positions are precise enough to distinguish neighbouring cells.
bool areKnown(const VolumeSpace& space, double error) {
    constexpr double kMostReach = 0.25; // voxels
    return error < kInfinity && AreaSlack(space, error).reach() < kMostReach;
}

constexpr AreaFound kUnknown{{0, kInfinity}, StopReason::Rounding};

/// Upper bound for a mesh whose positions are too imprecise: its whole area.
std::vector<TriangleFound> unknownTriangles(const MeshImpl& mesh) {
    std::vector<TriangleFound> found(mesh.facts.triangles);
    for (std::uint32_t i = 0; i < mesh.facts.triangles; ++i) {
        found[i] = {i, kInfinity, kUnknown.bounds};
    }
    return found;
}

} // namespace

AreaFound measureArea(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh, const AreaGoal& goal,
                      std::vector<TriangleFound>* triangles) {
    const bool byTriangle = triangles != nullptr;
    if (!areKnown(part.space, mesh.error())) {
        if (byTriangle) {
            *triangles = unknownTriangles(mesh.mesh());
        }
        return kUnknown;
    }
    AreaSearch search(volume, part, mesh, nullptr, 1, goal, byTriangle);
    const AreaFound found = search.run().front();
    if (byTriangle) {
        *triangles = search.triangles();
    }
    return found;
}

std::vector<AreaFound> measureAreas(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh,
                                    const AreaLabels& labels, std::size_t slots, const AreaGoal& goal) {
    if (!areKnown(part.space, mesh.error())) {
        return std::vector<AreaFound>(slots, kUnknown);
    }
    return AreaSearch(volume, part, mesh, &labels, slots, goal, false).run();
}

} // namespace voxtact::cpu
