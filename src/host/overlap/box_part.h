// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/overlap/sheet.h"
#include "host/search/opaque_part.h"

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace voxtact::cpu {

/// A box of one cell, padded voxel coordinates.
struct CellPartBox {
    NodePlace cell{};
    glm::dvec3 lo{};
    glm::dvec3 hi{};

    [[nodiscard]] double volume() const noexcept {
        const glm::dvec3 side = hi - lo;
        return side.x * side.y * side.z;
    }
};

/// The cell's part of the image's domain.
[[nodiscard]] CellPartBox wholeCell(const VolumeImpl& volume, const NodePlace& cell) noexcept;

/// A volume between bounds, in voxels.
struct BoxVolume {
    double lo = 0;
    double hi = 0;
    double gain = 0;        ///< so much nearer dividing the box may bring them; 0: not at all
    int axis = 0;           ///< across that one it is best divided
    double outside = 0;     ///< so much of the box is certainly opaque and not in the solid
    bool mayOverlap = true; ///< false: no opaque point of the box is in the solid
    bool mayLeave = true;   ///< false: all opaque points of the box are in the solid
};

/// Computes the opaque volume of a box behind sheets. For one thread.
class BoxMeasure {
  public:
    /// All must outlive it. `rounding`: no corner of a sheet is off by more, voxels.
    BoxMeasure(const VolumeImpl& volume, const OpaquePart& part, double rounding)
        : volume_(volume), part_(part), rounding_(rounding) {}

    /// Returns the opaque volume of a box, without the solid.
    [[nodiscard]] BoxVolume opaque(const CellPartBox& box);
    /// `sheets` are in the box. `base`: the solid's winding in front of them, 0 or 1, or kUnknownJump.
    [[nodiscard]] BoxVolume measure(const CellPartBox& box, const SheetList& sheets, Jump base);

  private:
    struct Values;
    struct Share;
    [[nodiscard]] Values valuesOn(const CellPartBox& box) const;
    [[nodiscard]] double behind(const Values& values, double from) const;
    [[nodiscard]] bool mayBeOpaqueBehind(const Values& values) const;
    [[nodiscard]] std::optional<BoxVolume> behindGraph(const CellPartBox& box, const Values& values) const;
    template <class Behind>
    [[nodiscard]] BoxVolume between(const CellPartBox& box, const Values& values, const Share& all,
                                    const Behind& behind) const;
    void placeSheets(const CellPartBox& box, const Values* values, const SheetList& sheets, Jump base, Share& all);

    const VolumeImpl& volume_;
    const OpaquePart& part_;
    double rounding_;

    /// A corner of a sheet: its position, the depth of the box behind it, and the linear values at both ends.
    struct Corner {
        double y = 0;
        double z = 0;
        double way = 0;
        double near = 0;
        double far = 0;
    };
    struct Placed {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        double jump = 0;
        double volume = 0;            ///< behind it
        double least = kInfinity;     ///< of the linear values there
        double greatest = -kInfinity; ///< see `least`
    };
    static double volumeBehind(const Corner* corners, std::uint32_t count) noexcept;
    static double volumeFrom(const Corner* corners, std::uint32_t count, double slope, double from) noexcept;

    std::vector<Corner> corners_; ///< of `placed_`
    std::vector<Placed> placed_;
};

} // namespace voxtact::cpu
