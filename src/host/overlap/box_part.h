// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/overlap/sheet.h"
#include "host/search/opaque_part.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>

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
    /// All must outlive it. `rounding`: no corner of a sheet is off by more, voxels. `wantsOutside`: sets
    /// BoxVolume::outside where sheets are.
    BoxMeasure(const VolumeImpl& volume, const OpaquePart& part, double rounding, bool wantsOutside = true)
        : volume_(volume), part_(part), rounding_(rounding), wantsOutside_(wantsOutside) {}

    /// Returns the opaque volume of a box, without the solid.
    [[nodiscard]] BoxVolume opaque(const CellPartBox& box) const;
    /// `sheets` are in the box. `base`: the solid's winding in front of them, 0 or 1, or kUnknownJump. `near`: divides
    /// sheets until the bounds of each part differ by at most this. `whole`: opaque(box), or narrower bounds.
    [[nodiscard]] BoxVolume measure(const CellPartBox& box, const SheetList& sheets, Jump base, double near = kInfinity,
                                    const BoxVolume* whole = nullptr);
    /// Number of parts of sheets, in all calls.
    [[nodiscard]] std::uint64_t parts() const noexcept { return parts_; }

  private:
    struct Values;
    /// The opaque part of the space from sheets to a plane behind them.
    struct Behind {
        double lo = 0;
        double hi = 0;
        glm::dvec3 bent{};      ///< how much nearer dividing across an axis may bring these
        bool isRounding = true; ///< not at all
        bool isClear = true;    ///< nothing is opaque

        void add(const Behind& other);
    };
    /// The space behind sheets.
    struct Share {
        double volume = 0;  ///< voxels
        double unknown = 0; ///< of sheets whose jump is unknown
        double slack = 0;   ///< rounding of either
    };
    [[nodiscard]] Values valuesOn(const CellPartBox& box) const;
    [[nodiscard]] std::optional<BoxVolume> behindGraph(const CellPartBox& box, const Values& values) const;
    [[nodiscard]] BoxVolume linearly(const CellPartBox& box, Values values) const;
    [[nodiscard]] Share shareOf(const CellPartBox& box, const SheetList& sheets, Jump base) const;
    [[nodiscard]] Behind behind(Values& values, const Sheet& sheet, double end) const;
    void addBehind(Values& values, const Sheet& sheet, double end, double near, Behind& sum);
    [[nodiscard]] BoxVolume behindSheets(const CellPartBox& box, Values& values, const SheetList& sheets, Jump base,
                                         double near, const BoxVolume* whole);

    const VolumeImpl& volume_;
    const OpaquePart& part_;
    double rounding_;
    bool wantsOutside_;
    std::uint64_t parts_ = 0;
    std::uint64_t lastPart_ = 0; ///< no division of sheets after this part
};

} // namespace voxtact::cpu
