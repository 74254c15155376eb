// SPDX-License-Identifier: MIT
#include "cpu/area/area_search.h"
#include "core/base/infinity.h"
#include "cpu/area/area_walk.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace voxtact::cpu {

namespace {

/// Of a sum of parts that are each right to some roundings (area_frame.h, uv_polygon.h).
constexpr double kSumError = 0x1p-40;

/// Neumaier's sum: what is rounded off is kept ("Rundungsfehleranalyse einiger Verfahren zur Summation endlicher
/// Summen", 1974).
class Sum {
  public:
    void add(double term) noexcept {
        const double next = sum_ + term;
        rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
        sum_ = next;
    }
    [[nodiscard]] double value() const noexcept { return sum_ + rest_; }

  private:
    double sum_ = 0;
    double rest_ = 0;
};

/// Parts whose bounds are apart, the farthest first; where several are as far, the one that came first.
class OpenParts {
  public:
    struct Open {
        CellPart part;
        PartArea area;
    };

    /// Keeps no more than so many: what is nearer together than all of these is never divided.
    explicit OpenParts(std::uint64_t most) : most_(std::max<std::uint64_t>(most, 1)) {}

    void add(const CellPart& part, const PartArea& area) {
        const auto place = static_cast<std::uint32_t>(free_.empty() ? parts_.size() : free_.back());
        if (free_.empty()) {
            parts_.push_back({part, area});
        } else {
            free_.pop_back();
            parts_[place] = {part, area};
        }
        order_.push_back({area.gap(), numbered_++, place});
        if (isHeap_) {
            std::ranges::push_heap(order_, isNearer);
        } else if (order_.size() / 2 > most_) {
            keepFarthest();
        }
    }
    [[nodiscard]] bool empty() const noexcept { return order_.empty(); }
    /// Whether some were not kept.
    [[nodiscard]] bool leftSome() const noexcept { return left_; }
    [[nodiscard]] Open takeFarthest() {
        if (!isHeap_) {
            std::ranges::make_heap(order_, isNearer);
            isHeap_ = true;
        }
        std::ranges::pop_heap(order_, isNearer);
        const std::uint32_t place = order_.back().place;
        order_.pop_back();
        free_.push_back(place);
        return parts_[place];
    }

  private:
    struct Ordered {
        double gap = 0;
        std::uint64_t number = 0;
        std::uint32_t place = 0; ///< in `parts_`
    };
    static bool isNearer(const Ordered& a, const Ordered& b) noexcept {
        return a.gap != b.gap ? a.gap < b.gap : a.number > b.number;
    }
    void keepFarthest() {
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(most_);
        std::ranges::nth_element(order_, end, [](const Ordered& a, const Ordered& b) { return isNearer(b, a); });
        std::for_each(end, order_.end(), [this](const Ordered& one) { free_.push_back(one.place); });
        order_.erase(end, order_.end());
        left_ = true;
    }

    std::vector<Ordered> order_;
    std::vector<Open> parts_;
    std::vector<std::uint32_t> free_; ///< places of `parts_`
    std::uint64_t most_;
    std::uint64_t numbered_ = 0;
    bool isHeap_ = false;
    bool left_ = false;
};

/// What the parts of one slot have together.
struct Slot {
    Sum lo;
    Sum hi;

    [[nodiscard]] AreaBounds bounds() const {
        return {std::max(lo.value() * (1 - kSumError), 0.0), std::max(hi.value() * (1 + kSumError), 0.0)};
    }
    [[nodiscard]] bool within(double tolerance) const {
        const AreaBounds now = bounds();
        return now.hi - now.lo <= tolerance;
    }
};

class AreaSearch {
  public:
    /// `labels`: null where there is one slot for all.
    AreaSearch(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh, const AreaLabels* labels,
               std::size_t slots, const AreaGoal& goal)
        : part_(part), mesh_(mesh), goal_(goal), slack_(part.space, mesh.error()), measure_(volume, part, slack_),
          walk_(volume, part, slack_, measure_, labels != nullptr), open_(goal.mostSteps), slots_(slots) {
        if (labels != nullptr) {
            labels_.emplace(*labels, part.space, slack_);
        }
    }

    std::vector<AreaFound> run() {
        lookAtAll();
        std::uint64_t steps = 0;
        std::size_t apart = static_cast<std::size_t>(
            std::ranges::count_if(slots_, [this](const Slot& slot) { return !slot.within(goal_.tolerance); }));
        while (apart > 0 && !open_.empty() && steps < goal_.mostSteps && goesOn()) {
            const OpenParts::Open farthest = open_.takeFarthest();
            const Slot& slot = slots_[farthest.part.slot];
            if (!slot.within(goal_.tolerance)) {
                divide(farthest);
                apart -= slot.within(goal_.tolerance) ? 1 : 0;
                ++steps;
            }
        }
        const bool ended = steps == goal_.mostSteps || open_.leftSome();
        std::vector<AreaFound> found;
        for (const Slot& slot : slots_) {
            const AreaEnd apartFor = ended ? AreaEnd::Budget : AreaEnd::Rounding;
            found.push_back({slot.bounds(), slot.within(goal_.tolerance) ? AreaEnd::Closed : apartFor});
        }
        return found;
    }

  private:
    [[nodiscard]] bool goesOn() const { return !isCancelled(goal_.cancel); }

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
            bool isOpen = false;
            walk_.triangle(
                frame, number, [this] { return goesOn(); },
                [&](const CellPart& part) { isOpen = addByLabel(frame, part) || isOpen; },
                [&](const UvPolygon& polygon) { count(0, PartMeasure::whole(frame, polygon)); });
            if (isOpen) {
                frames_.push_back(frame);
            }
        }
    }

    void count(std::size_t slot, const PartArea& area) {
        slots_[slot].lo.add(area.lo);
        slots_[slot].hi.add(area.hi);
    }

    /// Whether some of it may be divided.
    bool addByLabel(const AreaFrame& frame, const CellPart& part) {
        if (!labels_) {
            return add(frame, part);
        }
        bool isOpen = false;
        labels_->cut(frame, part, [&](const CellPart& labelled) { isOpen = add(frame, labelled) || isOpen; });
        return isOpen;
    }

    /// Whether it may be divided.
    bool add(const AreaFrame& frame, const CellPart& part) {
        const PartArea area = measure_.area(frame, part);
        count(part.slot, area);
        const bool isOpen = !area.final && area.gap() > 0;
        if (isOpen) {
            open_.add(part, area);
        }
        return isOpen;
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
        count(open.part.slot, {-open.area.lo, -open.area.hi});
        add(frame, below);
        add(frame, above);
    }

    const OpaquePart& part_;
    MeshPlace& mesh_;
    AreaGoal goal_;
    AreaSlack slack_;
    PartMeasure measure_;
    AreaWalk walk_;
    OpenParts open_;
    std::vector<AreaFrame> frames_; ///< of the triangles that have parts in `open_`
    std::vector<Slot> slots_;
    std::optional<LabelCut> labels_;
};

/// Whether places are known well enough to tell neighbouring cells.
bool areKnown(const VolumeSpace& space, double error) {
    constexpr double kMostReach = 0.25; // voxels
    return error < kInfinity && AreaSlack(space, error).reach() < kMostReach;
}

std::vector<AreaFound> measure(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh,
                               const AreaLabels* labels, std::size_t slots, const AreaGoal& goal) {
    if (!areKnown(part.space, mesh.error())) {
        return std::vector<AreaFound>(slots, {{0, kInfinity}, AreaEnd::Rounding});
    }
    return AreaSearch(volume, part, mesh, labels, slots, goal).run();
}

} // namespace

AreaFound measureArea(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh, const AreaGoal& goal) {
    return measure(volume, part, mesh, nullptr, 1, goal).front();
}

std::vector<AreaFound> measureAreas(const VolumeImpl& volume, const OpaquePart& part, MeshPlace& mesh,
                                    const AreaLabels& labels, std::size_t slots, const AreaGoal& goal) {
    return measure(volume, part, mesh, &labels, slots, goal);
}

} // namespace voxtact::cpu
