// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/area_frame.h"
#include "host/search/opaque_part.h"

#include <cstdint>

namespace voxtact::cpu {

/// A part of a triangle in one cell of the volume.
struct CellPart {
    UvPolygon polygon;
    std::uint32_t frame = 0; ///< number of its triangle's
    NodePlace padded{};      ///< its cell
    std::uint16_t slot = 0;  ///< of the sums that it is counted in
    bool atEdge = false;     ///< rounding decides whether it is where it counts
};

/// The area of a part that is opaque, mm^2.
struct PartArea {
    double lo = 0;
    double hi = 0;
    double gain = 0; ///< mm^2: maximum gain of a division; 0: none
    int axis = 0;    ///< across that one it is best divided
};

/// Bounds the opaque share of parts of triangles. Not thread-safe.
class PartMeasure {
  public:
    /// All must outlive it.
    PartMeasure(const VolumeImpl& volume, const OpaquePart& part, const AreaSlack& slack);

    [[nodiscard]] PartArea area(const AreaFrame& frame, const CellPart& part) const;
    /// Returns true if a polygon whose box lies in this brick is certainly opaque everywhere.
    [[nodiscard]] bool allOpaque(const NodePlace& brick) const;
    /// A polygon's own area, opaque or not.
    [[nodiscard]] static PartArea whole(const AreaFrame& frame, const UvPolygon& polygon) noexcept;

  private:
    [[nodiscard]] PartArea areaInside(const AreaFrame& frame, const CellPart& part, const PartCell& cell) const;
    [[nodiscard]] double errorAround(const NodePlace& padded, const PartCell& cell) const;

    const VolumeImpl& volume_;
    const OpaquePart& part_;
    double reach_;     ///< AreaSlack::reach()
    double wide_;      ///< maximum change of a value by it, anywhere in the volume
    double wideError_; ///< and by rounding
};

} // namespace voxtact::cpu
