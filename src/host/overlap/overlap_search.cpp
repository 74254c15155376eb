// SPDX-License-Identifier: MIT
#include "host/overlap/overlap_search.h"
#include "host/area/area_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace voxtact::cpu {

namespace {

/// Maximum number of boxes divided to decide the containment, once the bounds are within the tolerance.
constexpr std::uint64_t kMoreSteps = 2048;

/// Division of the sheets of a cell: maximum upper - lower of a part at level 0, of a voxel; its factor from one level
/// to the next; and the number of levels, after which the cell is halved.
constexpr double kSheetNear = 0x1p-5;
constexpr double kSheetNearer = 0x1p-4;
constexpr unsigned kSheetLevels = 4;

/// A box that may be measured better.
struct OpenBox {
    /// Kinds of division: by the next level of a cell inside the solid, by the sheets of a crossed cell, or by halves.
    enum class By : std::uint8_t { Level, Sheets, Halves };

    CellPartBox box;
    SheetList sheets;
    Jump base = 0;
    BoxVolume volume;
    By by = By::Halves;
    double cost = 1;          ///< of that, an estimate
    double near = kInfinity;  ///< BoxMeasure::measure()
    unsigned level = 0;       ///< for By::Level and By::Sheets
    std::uint32_t number = 0; ///< of the crossed cell, for By::Sheets
    std::uint32_t run = 0;    ///< and the first one of its run
};

/// The boxes of one sum: the box with the largest gain is divided first; of equal ones, the earliest.
class OverlapSum {
  public:
    void add(const BoxVolume& volume) {
        lo_.add(volume.lo);
        hi_.add(volume.hi);
        mayOverlap_ += volume.mayOverlap ? 1 : 0;
        mayLeave_ += volume.mayLeave ? 1 : 0;
        outside_ += volume.outside;
    }
    void takeBack(const BoxVolume& volume) {
        lo_.add(-volume.lo);
        hi_.add(-volume.hi);
        mayOverlap_ -= volume.mayOverlap ? 1 : 0;
        mayLeave_ -= volume.mayLeave ? 1 : 0;
        outside_ -= volume.outside;
    }
    void open(OpenBox box) {
        order_.push_back({box.volume.gain / box.cost, boxes_.size()});
        boxes_.push_back(std::move(box));
        if (isHeap_) {
            std::ranges::push_heap(order_, isWorse);
        }
    }
    bool isCrossed = false; ///< there were sheets where something may be opaque
    [[nodiscard]] bool isOpen() const noexcept { return !order_.empty(); }
    /// Expects that there is one.
    [[nodiscard]] OpenBox takeBest() {
        if (!isHeap_) {
            std::ranges::make_heap(order_, isWorse);
            isHeap_ = true;
        }
        std::ranges::pop_heap(order_, isWorse);
        OpenBox best = std::move(boxes_[order_.back().number]);
        order_.pop_back();
        return best;
    }
    [[nodiscard]] Bounds bounds() const noexcept {
        return {std::max(lo_.value() - lo_.error(), 0.0), std::max(hi_.value() + hi_.error(), 0.0)};
    }
    [[nodiscard]] bool within(double tolerance) const noexcept {
        const Bounds now = bounds();
        return now.upper - now.lower <= tolerance;
    }
    /// Returns true if containment is decided: none, all or some.
    [[nodiscard]] bool tells(double error, bool isSomeOutside) const noexcept {
        const bool isInside = mayOverlap_ == 0 || bounds().lower > error;
        const bool isOutside = isSomeOutside || mayLeave_ == 0 || outside_ > error;
        return mayOverlap_ == 0 || (isInside && isOutside);
    }
    [[nodiscard]] OverlapFound found(double tolerance) const {
        OverlapFound out;
        out.bounds = mayOverlap_ > 0 ? bounds() : Bounds{};
        out.end = within(tolerance) ? StopReason::Closed : (isOpen() ? StopReason::Budget : StopReason::Rounding);
        out.mayOverlap = mayOverlap_ > 0;
        out.isCrossed = isCrossed;
        out.mayLeave = mayLeave_ > 0;
        out.outside = outside_;
        return out;
    }

  private:
    struct Ordered {
        double gain = 0;
        std::size_t number = 0;
    };
    static bool isWorse(const Ordered& a, const Ordered& b) noexcept {
        return a.gain != b.gain ? a.gain < b.gain : a.number > b.number;
    }

    KeptSum lo_;
    KeptSum hi_;
    std::int64_t mayOverlap_ = 0;
    std::int64_t mayLeave_ = 0;
    double outside_ = 0;
    std::vector<Ordered> order_;
    std::vector<OpenBox> boxes_;
    bool isHeap_ = false;
};

/// Data on both sides of a plane, for boxes there.
struct Halves {
    SheetList below;
    SheetList above;
};

Halves halvesOf(const SheetList& sheets, int axis, double at) {
    Halves halves;
    Sheet sheet;
    Sheet below;
    Sheet above;
    for (std::size_t i = 0; i < sheets.count(); ++i) {
        sheets.get(i, sheet);
        cut(sheet, axis, at, below, above);
        if (!below.empty()) {
            halves.below.add(below);
        }
        if (axis == 0 && !below.empty()) {
            below.flatten(at);
            halves.above.add(below);
        }
        if (!above.empty()) {
            halves.above.add(above);
        }
    }
    return halves;
}

class OverlapSearch {
  public:
    OverlapSearch(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                  const OverlapLabels* labels, const OverlapGoal& goal)
        : volume_(volume), part_(part), surface_(surface), labels_(labels), goal_(goal),
          measure_(volume, part.part, surface.rounding(), !goal.isSomeOutside),
          sums_(labels != nullptr ? labels->count : 1) {}

    std::vector<OverlapFound> run() {
        surface_.walk([this](const CrossedRow& row, std::uint32_t cell, std::uint32_t runBegin,
                             Jump base) { addCrossed(row, cell, runBegin, base); },
                      [this](const CrossedRow& row, std::int32_t first, std::int32_t last, Jump base) {
                          for (std::int32_t x = first; x <= last && goesOn(); ++x) {
                              addUncrossed({x, row.y, row.z}, base);
                          }
                      });
        std::vector<OverlapFound> found;
        for (OverlapSum& sum : sums_) {
            found.push_back(finish(sum));
        }
        return found;
    }

  private:
    [[nodiscard]] bool goesOn() const { return !isCancelled(goal_.cancel); }

    OverlapFound finish(OverlapSum& sum) {
        std::uint64_t steps = 0;
        while (!sum.within(goal_.tolerance) && sum.isOpen() && steps < goal_.maxSteps && goesOn()) {
            steps += refine(sum, sum.takeBest());
        }
        const std::uint64_t last = std::min(goal_.maxSteps, steps + kMoreSteps);
        while (!sum.tells(goal_.error, goal_.isSomeOutside) && sum.isOpen() && steps < last && goesOn()) {
            steps += refine(sum, sum.takeBest());
        }
        return sum.found(goal_.tolerance);
    }

    /// Returns how many steps it was.
    std::uint64_t refine(OverlapSum& sum, OpenBox open) {
        sum.takeBack(open.volume);
        if (open.by != OpenBox::By::Level) {
            const std::uint64_t before = measure_.parts();
            if (open.by == OpenBox::By::Halves) {
                divide(sum, open);
            } else {
                addSheets(sum, std::move(open));
            }
            return std::max<std::uint64_t>((measure_.parts() - before) / 16, 1);
        }
        ++open.level;
        open.volume = part_.cell(volume_, open.box.cell, open.level);
        sum.add(open.volume);
        const std::uint64_t boxes = OverlapPart::boxesOf(open.level);
        open.cost = OverlapPart::isKept(open.level + 1) ? 1 : 16 * static_cast<double>(boxes);
        if (open.volume.gain > 0) {
            sum.open(std::move(open));
        }
        return std::max<std::uint64_t>(boxes / 16, 1);
    }

    void divide(OverlapSum& sum, const OpenBox& open) {
        const int axis = open.volume.axis;
        const double at = 0.5 * (open.box.lo[axis] + open.box.hi[axis]);
        CellPartBox below = open.box;
        CellPartBox above = open.box;
        below.hi[axis] = at;
        above.lo[axis] = at;
        Halves halves = halvesOf(open.sheets, axis, at);
        const double near = open.near / 2;
        addBox(sum, below, std::move(halves.below), open.base, near);
        if (const std::optional<Jump> base = axis == 0 ? baseAt(open, at) : std::nullopt) {
            addBox(sum, above, behindPlane(open.sheets, at), *base, near);
        } else {
            addBox(sum, above, std::move(halves.above), open.base, near);
        }
    }

    /// The solid's winding all over a plane across x, where no sheet is at it.
    [[nodiscard]] std::optional<Jump> baseAt(const OpenBox& open, double at) const {
        if (open.base == kUnknownJump) {
            return {};
        }
        const glm::dvec3 side = open.box.hi - open.box.lo;
        double winding = open.base;
        Sheet sheet;
        for (std::size_t i = 0; i < open.sheets.count(); ++i) {
            open.sheets.get(i, sheet);
            double lo = 0;
            double hi = 0;
            sheet.range(0, lo, hi);
            if (sheet.jump == kUnknownJump || (lo <= at + surface_.reach() && hi >= at - surface_.reach())) {
                return {};
            }
            winding += hi < at ? sheet.jump * sheet.area() / (side.y * side.z) : 0;
        }
        const double nearest = std::round(winding);
        const double error =
            16 * surface_.rounding() * static_cast<double>(open.sheets.count()) * (1 / side.y + 1 / side.z);
        const bool isSure =
            error < 0x1p-6 && std::abs(winding - nearest) <= error + 0x1p-20 && (nearest == 0 || nearest == 1);
        return isSure ? std::optional(static_cast<Jump>(nearest)) : std::nullopt;
    }
    /// Sheets beyond a plane that none of them is at.
    static SheetList behindPlane(const SheetList& sheets, double at) {
        SheetList behind;
        Sheet sheet;
        for (std::size_t i = 0; i < sheets.count(); ++i) {
            sheets.get(i, sheet);
            if (sheet.corners[0].x > at) {
                behind.add(sheet);
            }
        }
        return behind;
    }

    /// Measures a crossed cell at its level.
    void addSheets(OverlapSum& sum, OpenBox open) {
        const std::uint64_t before = measure_.parts();
        SheetList sheets = sheetsOf(open.box, open.number, open.run);
        const BoxVolume whole = open.base == 1 ? part_.cell(volume_, open.box.cell, 1) : BoxVolume{};
        open.near = kSheetNear * std::pow(kSheetNearer, open.level);
        open.volume = measure_.measure(open.box, sheets, open.base, open.near, &whole);
        sum.add(open.volume);
        if (open.volume.gain > 0) {
            open.cost =
                4 * static_cast<double>(measure_.parts() - before + 1); // an estimate of the parts at the next level
            if (++open.level == kSheetLevels) {
                open.by = OpenBox::By::Halves;
                open.sheets = std::move(sheets);
            }
            sum.open(std::move(open));
        }
    }

    void addBox(OverlapSum& sum, const CellPartBox& box, SheetList sheets, Jump base, double near = kInfinity) {
        const BoxVolume volume = measure_.measure(box, sheets, base, near);
        sum.add(volume);
        if (volume.gain > 0) {
            const auto cost = static_cast<double>(sheets.count() + 1);
            sum.open({box, std::move(sheets), base, volume, OpenBox::By::Halves, cost, near});
        }
    }

    /// A cell without sheets.
    void addUncrossed(const NodePlace& cell, Jump base) {
        const OverlapPart::Kind kind = part_.kind(volume_, cell);
        if (kind == OverlapPart::Kind::Clear) {
            return;
        }
        const CellPartBox box = wholeCell(volume_, cell);
        if (labels_ != nullptr || base == kUnknownJump) {
            addOctants(box, {}, base);
            return;
        }
        if (kind == OverlapPart::Kind::Opaque) {
            BoxVolume volume;
            volume.lo = volume.hi = box.volume();
            volume.mayLeave = false;
            sums_[0].add(volume);
            return;
        }
        OpenBox open{box, {}, base, part_.cell(volume_, cell, 0), OpenBox::By::Level};
        sums_[0].add(open.volume);
        if (open.volume.gain > 0) {
            sums_[0].open(std::move(open));
        }
    }

    void addCrossed(const CrossedRow& row, std::uint32_t number, std::uint32_t runBegin, Jump base) {
        if (!goesOn()) {
            return;
        }
        const Behind behind = behindOf(row, number, runBegin, base);
        const NodePlace cell{surface_.cells()[number].x, row.y, row.z};
        const OverlapPart::Kind kind = part_.kind(volume_, cell);
        if (kind == OverlapPart::Kind::Clear) {
            return;
        }
        const CellPartBox box = wholeCell(volume_, cell);
        if (labels_ != nullptr || !behind.isKnown) {
            addOctants(box, sheetsOf(box, number, runBegin), base);
            return;
        }
        sums_[0].isCrossed = true;
        BoxVolume volume;
        volume.hi = std::clamp(behind.volume + behind.slack, 0.0, box.volume());
        if (kind == OverlapPart::Kind::Opaque) {
            volume.lo = std::clamp(behind.volume - behind.slack, 0.0, volume.hi);
            volume.outside = box.volume() - volume.hi;
            sums_[0].add(volume);
            return;
        }
        const BoxVolume opaque = part_.cell(volume_, cell, 0);
        volume.lo = std::clamp(behind.volume - behind.slack + opaque.lo - box.volume(), 0.0, volume.hi);
        volume.hi = std::min(volume.hi, opaque.hi);
        volume.lo = std::min(volume.lo, volume.hi);
        volume.outside = std::max(opaque.lo - volume.hi, 0.0);
        volume.gain = volume.hi - volume.lo;
        sums_[0].add(volume);
        if (volume.gain > 0) {
            const double sheets = surface_.cells()[number].end - surface_.cells()[runBegin].first;
            sums_[0].open({box, {}, base, volume, OpenBox::By::Sheets, 2 * (sheets + 1), 0, 0, number, runBegin});
        }
    }

    /// The solid's part of a crossed cell.
    struct Behind {
        double volume = 0; ///< voxels
        double slack = 0;
        bool isKnown = false;
    };
    Behind behindOf(const CrossedRow& row, std::uint32_t number, std::uint32_t runBegin, Jump base) {
        const CrossedCell& at = surface_.cells()[number];
        if (runBegin != run_ || next_ > number) {
            run_ = runBegin;
            next_ = runBegin;
            area_ = 0;
            unknown_ = 0;
        }
        for (; next_ < number; ++next_) {
            area_ += surface_.cells()[next_].area;
            unknown_ += surface_.cells()[next_].unknown;
        }
        const CellPartBox box = wholeCell(volume_, {at.x, row.y, row.z});
        const double sheets = at.end - surface_.cells()[runBegin].first;
        Behind behind;
        behind.volume = base * box.volume() + area_ * (box.hi.x - box.lo.x) + at.volume;
        behind.slack = 48 * surface_.rounding() * (sheets + 1);
        behind.isKnown = base != kUnknownJump && unknown_ == 0 && at.unknown == 0;
        return behind;
    }

    SheetList sheetsOf(const CellPartBox& box, std::uint32_t number, std::uint32_t runBegin) const {
        const CrossedCell& at = surface_.cells()[number];
        SheetList sheets;
        Sheet sheet;
        for (std::uint32_t i = surface_.cells()[runBegin].first; i < at.end; ++i) {
            surface_.sheet(i, sheet);
            if (i < at.first) {
                sheet.setX(box.lo.x);
            }
            sheets.add(sheet);
        }
        return sheets;
    }

    void addOctants(const CellPartBox& box, SheetList sheets, Jump base) {
        if (labels_ == nullptr) {
            sums_[0].isCrossed |= sheets.count() > 0;
            addBox(sums_[0], box, std::move(sheets), base);
            return;
        }
        const SlotOctants octants = labels_->octantsOf(box.cell);
        if (std::ranges::all_of(octants, [&](std::uint16_t slot) { return slot == octants[0]; })) {
            addToSlot(octants[0], box, std::move(sheets), base);
            return;
        }
        addAlong(box, std::move(sheets), base, 0, 0, octants);
    }

    void addAlong(const CellPartBox& box, SheetList sheets, Jump base, int axis, std::size_t octant,
                  const SlotOctants& octants) {
        if (axis == 3) {
            addToSlot(octants[octant], box, std::move(sheets), base);
            return;
        }
        const double middle = box.cell[static_cast<std::size_t>(axis)] + 0.5;
        const std::size_t upper = octant | std::size_t{1} << static_cast<unsigned>(axis);
        if (box.lo[axis] >= middle || box.hi[axis] <= middle) { // on one side: a cell at a face of the image
            addAlong(box, std::move(sheets), base, axis + 1, box.lo[axis] >= middle ? upper : octant, octants);
            return;
        }
        Halves halves = halvesOf(sheets, axis, middle);
        CellPartBox half = box;
        half.hi[axis] = middle;
        addAlong(half, std::move(halves.below), base, axis + 1, octant, octants);
        half = box;
        half.lo[axis] = middle;
        addAlong(half, std::move(halves.above), base, axis + 1, upper, octants);
    }

    void addToSlot(std::uint16_t slot, const CellPartBox& box, SheetList sheets, Jump base) {
        if (slot != OverlapLabels::kNoSlot) {
            sums_[slot].isCrossed |= sheets.count() > 0;
            addBox(sums_[slot], box, std::move(sheets), base);
        }
    }

    const VolumeImpl& volume_;
    const OverlapPart& part_;
    const PairSurface& surface_;
    const OverlapLabels* labels_;
    OverlapGoal goal_;
    BoxMeasure measure_;
    std::vector<OverlapSum> sums_;
    std::uint32_t run_ = ~std::uint32_t{0}; ///< the crossed cells that `area_` and `unknown_` are of: from here
    std::uint32_t next_ = 0;                ///< to before this one
    double area_ = 0;
    double unknown_ = 0;
};

} // namespace

std::vector<OverlapFound> measureOverlap(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                                         const OverlapLabels* labels, const OverlapGoal& goal) {
    return OverlapSearch(volume, part, surface, labels, goal).run();
}

} // namespace voxtact::cpu
