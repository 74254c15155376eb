// SPDX-License-Identifier: MIT
#include "oracle/clearance_oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "oracle/certified_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace voxtact::oracle {

namespace {

using certified::Cell;
using certified::CellVoxels;
using certified::Field;
using certified::Opacity;
using Triangle = std::array<Vec3, 3>;

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double product(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double lengthOf(const Vec3& a) {
    return std::hypot(a[0], a[1], a[2]);
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double toSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = minus(b, a);
    const double square = product(ab, ab);
    const double t = square > 0 ? std::clamp(product(minus(p, a), ab) / square, 0.0, 1.0) : 0.0;
    return lengthOf(minus(p, {a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]}));
}

/// To an edge, or to the plane where the foot of the perpendicular is on the inner side of all three.
double toTriangle(const Vec3& p, const Triangle& t) {
    double least = std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
    const Vec3 normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    const double size = lengthOf(normal);
    bool over = size > 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = minus(t[(i + 1) % 3], t[i]);
        over = over && product(cross(edge, minus(p, t[i])), normal) >= 0;
    }
    return over ? std::min(least, std::abs(product(minus(p, t[0]), normal)) / size) : least;
}

/// A part of a cell, index space.
struct SubBox {
    std::uint32_t cell = 0; ///< number in the list
    Vec3 lo{};
    Vec3 hi{};
    double nearest = 0; ///< mm: no triangle is nearer
};

struct Known {
    Cell cell{};
    CellVoxels voxels{};
};

class Measurer {
  public:
    Measurer(const OraclePair& pair, const ValueRange& range)
        : field_(pair.volume, range), opacity_(pair.transferFunction.points, pair.threshold),
          world_from_index_(worldFromIndex(pair.volume.grid)) {
        for (std::size_t i = 0; i < pair.mesh.indices.size(); i += 3) {
            Triangle triangle;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const double* at = &pair.mesh.positions[std::size_t{3} * pair.mesh.indices[i + corner]];
                triangle[corner] = transformPoint(pair.world_from_object, {at[0], at[1], at[2]});
            }
            triangles_.push_back(triangle);
        }
    }

    /// Of voxel (x, y, z), whether it counts.
    using Counts = std::function<bool(const std::array<std::size_t, 3>&)>;

    /// `counts`: all do where there is none.
    OracleClearance run(double resolution, std::size_t mostBoxes, const Counts& counts = {}) {
        learns_ = !counts; // what does not count says nothing
        std::vector<SubBox> boxes = wholeCells();
        learns_ = true;
        if (counts) {
            std::vector<SubBox> octants;
            for (const SubBox& box : boxes) {
                divideAtVoxels(box, counts, octants);
            }
            boxes = std::move(octants);
        }
        double size = 1;
        while (!boxes.empty() && size > resolution && 8 * boxes.size() <= mostBoxes) {
            std::vector<SubBox> next;
            for (const SubBox& box : boxes) {
                divide(box, next);
            }
            boxes = std::move(next);
            std::erase_if(boxes, [this](const SubBox& box) { return box.nearest > hi_; });
            size /= 2;
        }
        OracleClearance out{hi_, hi_};
        for (const SubBox& box : boxes) {
            out.lo = std::min(out.lo, box.nearest);
        }
        return out;
    }

  private:
    std::vector<SubBox> wholeCells() {
        std::vector<SubBox> out;
        const auto& size = field_.size();
        Cell cell{};
        const auto last = [&](std::size_t axis) { return std::int64_t{size[axis]} - 1; };
        for (cell[2] = -1; cell[2] <= last(2); ++cell[2]) {
            for (cell[1] = -1; cell[1] <= last(1); ++cell[1]) {
                for (cell[0] = -1; cell[0] <= last(0); ++cell[0]) {
                    cells_.push_back({cell, field_.voxelsOf(cell)});
                    SubBox box;
                    box.cell = static_cast<std::uint32_t>(cells_.size() - 1);
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const auto at = static_cast<double>(cell[axis]);
                        box.lo[axis] = std::max(at, -0.5);
                        box.hi[axis] = std::min(at + 1, static_cast<double>(size[axis]) - 0.5);
                    }
                    look(box, out);
                }
            }
        }
        return out;
    }

    /// Into the parts that are in the boxes of different voxels.
    void divideAtVoxels(const SubBox& box, const Counts& counts, std::vector<SubBox>& out) {
        for (std::size_t i = 0; i < 8; ++i) {
            SubBox part = box;
            std::array<std::size_t, 3> voxel{};
            bool some = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const bool upper = (i >> axis & 1U) != 0;
                const auto middle = static_cast<double>(cells_[box.cell].cell[axis]) + 0.5;
                (upper ? part.lo : part.hi)[axis] = middle;
                some = some && part.lo[axis] < part.hi[axis];
                voxel[axis] = static_cast<std::size_t>(cells_[box.cell].cell[axis] + (upper ? 1 : 0));
            }
            if (some && counts(voxel)) {
                look(part, out);
            }
        }
    }

    void divide(const SubBox& box, std::vector<SubBox>& out) {
        for (std::size_t i = 0; i < 8; ++i) {
            SubBox part = box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double middle = (box.lo[axis] + box.hi[axis]) / 2;
                ((i >> axis & 1U) == 0 ? part.hi : part.lo)[axis] = middle;
            }
            look(part, out);
        }
    }

    /// Keeps a box that may have an opaque point, and learns from it.
    void look(SubBox box, std::vector<SubBox>& out) {
        ValueRange values{kInfinity, -kInfinity};
        Vec3 middle{};
        std::array<Vec3, 8> corners{};
        bool opaqueCorner = false;
        for (std::size_t i = 0; i < 8; ++i) {
            Vec3 place{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                place[axis] = (i >> axis & 1U) == 0 ? box.lo[axis] : box.hi[axis];
                middle[axis] += place[axis] / 8;
            }
            const double value = valueAt(cells_[box.cell], place);
            const double doubt = field_.doubt(0);
            opaqueCorner = opaqueCorner || opacity_.allOpaque({value - doubt, value + doubt});
            values = {std::min(values.lo, value), std::max(values.hi, value)};
            corners[i] = transformPoint(world_from_index_, place);
        }
        const double doubt = field_.doubt(0);
        if (!opacity_.mayBeOpaque({values.lo - doubt, values.hi + doubt})) {
            return;
        }
        const Vec3 centre = transformPoint(world_from_index_, middle);
        double radius = 0;
        for (const Vec3& corner : corners) {
            radius = std::max(radius, lengthOf(minus(corner, centre)));
        }
        double distance = kInfinity;
        for (const Triangle& triangle : triangles_) {
            distance = std::min(distance, toTriangle(centre, triangle));
        }
        if (learns_ && (opaqueCorner || opacity_.opaqueBetween(values.lo + doubt, values.hi - doubt))) {
            hi_ = std::min(hi_, distance + radius);
        }
        box.nearest = std::max(0.0, distance - radius);
        if (box.nearest <= hi_) {
            out.push_back(box);
        }
    }

    static double valueAt(const Known& known, const Vec3& place) {
        double value = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            double weight = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double along = place[axis] - static_cast<double>(known.cell[axis]);
                weight *= (i >> axis & 1U) == 0 ? 1 - along : along;
            }
            value += weight * known.voxels[i];
        }
        return value;
    }

    Field field_;
    Opacity opacity_;
    Mat4 world_from_index_;
    std::vector<Triangle> triangles_;
    std::vector<Known> cells_;
    double hi_ = kInfinity;
    bool learns_ = true; ///< hi_, from what is examined
};

} // namespace

namespace {

Result<OracleClearance> measure(const OraclePair& pair, double resolution, std::size_t mostBoxes,
                                const Measurer::Counts& counts) {
    return guard([&]() -> Result<OracleClearance> {
        VOXTACT_TRY(checkMesh(pair.mesh));
        const Result<ValueRange> range = checkVolume(pair.volume);
        VOXTACT_TRY(range);
        VOXTACT_TRY(sampleTable(pair.transferFunction));
        VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), pair.threshold));
        return Measurer(pair, *range).run(resolution, mostBoxes, counts);
    });
}

} // namespace

Result<OracleClearance> clearanceOracle(const OraclePair& pair, double resolution, std::size_t mostBoxes) {
    return measure(pair, resolution, mostBoxes, {});
}

Result<OracleClearance> labelClearanceOracle(const OraclePair& pair, const LabelData& labels, std::int32_t label,
                                             double resolution, std::size_t mostBoxes) {
    const auto& size = labels.grid.size;
    return measure(pair, resolution, mostBoxes, [&](const std::array<std::size_t, 3>& voxel) {
        return labels.values[labels.indices[(voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0]]] == label;
    });
}

} // namespace voxtact::oracle
