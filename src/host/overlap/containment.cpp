// SPDX-License-Identifier: MIT
#include "host/overlap/containment.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Opaque regions off the surface.
struct Elsewhere {
    bool isCertain = false;  ///< something outside certainly is
    bool isPossible = false; ///< something may be
};

class OutsideScan {
  public:
    OutsideScan(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                const OverlapLabels* labels, std::vector<bool> wanted)
        : volume_(volume), part_(part), surface_(surface), labels_(labels), wanted_(std::move(wanted)),
          found_(wanted_.size()), measure_(volume, part.part, 0), left_(std::ranges::count(wanted_, true)) {}

    /// For the requested sums. Tests bricks near the surface first, which usually decide.
    std::vector<Elsewhere> run() {
        const BrickBox around = surface_.bricks();
        for (const bool isOutside : {true, false}) {
            const auto& count = volume_.bricks.count;
            for (std::int32_t z = 0; z < count[2] && left_ > 0; ++z) {
                for (std::int32_t y = 0; y < count[1] && left_ > 0; ++y) {
                    for (std::int32_t x = 0; x < count[0] && left_ > 0; ++x) {
                        const NodePlace brick{x, y, z};
                        bool isOutsideBox = false;
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            isOutsideBox =
                                isOutsideBox || brick[axis] < around.lo[axis] || brick[axis] > around.hi[axis];
                        }
                        if (isOutsideBox == isOutside) {
                            scan(brick, isOutside);
                        }
                    }
                }
            }
        }
        return found_;
    }

  private:
    void scan(const NodePlace& brick, bool isOutsideBox) {
        const std::size_t number = part_.part.occupancy.brickNumber(brick);
        if (part_.kind(number) == OverlapPart::Kind::Clear) {
            return;
        }
        if (isOutsideBox && labels_ == nullptr) {
            add(0, false, true); // OverlapPart::isCertainOutside() excluded a certain one
            return;
        }
        NodePlace first{};
        NodePlace last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = brick[axis] << kBrickShift;
            last[axis] = std::min(first[axis] + kBrickSide - 1, volume_.image.size[axis]);
        }
        for (std::int32_t z = first[2]; z <= last[2]; ++z) {
            for (std::int32_t y = first[1]; y <= last[1]; ++y) {
                for (std::int32_t x = first[0]; x <= last[0] && left_ > 0; ++x) {
                    scanCell({x, y, z}, isOutsideBox);
                }
            }
        }
    }

    void scanCell(const NodePlace& cell, bool isOutsideBox) {
        SlotOctants octants{};
        if (labels_ != nullptr) {
            octants = labels_->octantsOf(cell);
            if (std::ranges::none_of(octants, [&](std::uint16_t slot) { return isWanted(slot); })) {
                return;
            }
        }
        if (!isOutsideBox && surface_.at(cell) != PairSurface::Place::Outside) {
            return; // what is crossed was measured
        }
        const OverlapPart::Kind kind = part_.kind(volume_, cell);
        if (kind == OverlapPart::Kind::Clear) {
            return;
        }
        const CellPartBox box = wholeCell(volume_, cell);
        for (std::size_t i = 0; i < octants.size(); ++i) {
            const bool isAllOne = std::ranges::count(octants, octants[0]) == 8;
            if (isAllOne) {
                const bool isMixed = kind == OverlapPart::Kind::Mixed;
                add(octants[0], !isMixed || part_.cell(volume_, cell, 0).lo > 0, true);
                return;
            }
            CellPartBox octant = box;
            for (int axis = 0; axis < 3; ++axis) {
                const double middle = cell[static_cast<std::size_t>(axis)] + 0.5;
                (((i >> static_cast<unsigned>(axis)) & 1U) != 0 ? octant.lo : octant.hi)[axis] = middle;
            }
            const glm::dvec3 side = octant.hi - octant.lo;
            if (isWanted(octants[i]) && side.x > 0 && side.y > 0 && side.z > 0) {
                const BoxVolume volume = measure_.opaque(octant);
                add(octants[i], volume.lo > 0, volume.hi > 0);
            }
        }
    }

    [[nodiscard]] bool isWanted(std::uint16_t slot) const {
        return slot != OverlapLabels::kNoSlot && wanted_[slot] && !found_[slot].isCertain;
    }
    void add(std::uint16_t slot, bool isCertain, bool isPossible) {
        if (isWanted(slot)) {
            found_[slot].isPossible = found_[slot].isPossible || isPossible;
            found_[slot].isCertain = isCertain;
            left_ -= isCertain ? 1 : 0;
        }
    }

    const VolumeImpl& volume_;
    const OverlapPart& part_;
    const PairSurface& surface_;
    const OverlapLabels* labels_;
    std::vector<bool> wanted_;
    std::vector<Elsewhere> found_;
    BoxMeasure measure_;
    std::ptrdiff_t left_;
};

/// By sum: true if cells within the error of the surface may be opaque.
std::vector<bool> nearOpaque(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                             const OverlapLabels* labels, std::size_t count, double reach) {
    std::vector<bool> near(count, surface.grazes());
    surface.forEachNear(reach, [&](const NodePlace& cell) {
        if (part.kind(volume, cell) == OverlapPart::Kind::Clear || surface.at(cell) == PairSurface::Place::Crossed) {
            return;
        }
        const SlotOctants octants = labels != nullptr ? labels->octantsOf(cell) : SlotOctants{};
        for (const std::uint16_t slot : octants) {
            if (slot != OverlapLabels::kNoSlot) {
                near[slot] = true;
            }
        }
    });
    return near;
}

} // namespace

std::vector<Containment> containmentsOf(const VolumeImpl& volume, const OverlapPart& part, const PairSurface& surface,
                                        const OverlapLabels* labels, std::span<const OverlapFound> found,
                                        const ContainmentFacts& facts) {
    std::vector<Containment> out(found.size(), Containment::Undecided);
    std::vector<bool> near;
    if (std::ranges::any_of(found, [](const OverlapFound& one) { return !one.mayOverlap || !one.mayLeave; })) {
        near = nearOpaque(volume, part, surface, labels, found.size(), facts.reach);
    }
    std::vector<bool> wanted(found.size(), false);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const OverlapFound& one = found[i];
        const bool isClear = !facts.mayTouch || (!one.isCrossed && !near.empty() && !near[i]);
        const bool isInside = one.bounds.lower > facts.error;
        if (!one.mayOverlap && isClear) {
            out[i] = Containment::None;
        } else if (isInside && (facts.isSomeOutside || one.outside > facts.error)) {
            out[i] = Containment::Some;
        } else {
            wanted[i] = isInside;
        }
    }
    if (std::ranges::count(wanted, true) == 0) {
        return out;
    }
    const std::vector<Elsewhere> elsewhere = OutsideScan(volume, part, surface, labels, wanted).run();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const bool isClear = !facts.mayTouch || (!found[i].isCrossed && !near.empty() && !near[i]);
        if (wanted[i] && elsewhere[i].isCertain) {
            out[i] = Containment::Some;
        } else if (wanted[i] && !elsewhere[i].isPossible && !found[i].mayLeave && isClear) {
            out[i] = Containment::All;
        }
    }
    return out;
}

} // namespace voxtact::cpu
