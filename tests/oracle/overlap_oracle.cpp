// SPDX-License-Identifier: MIT
#include "oracle/overlap_oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/vec3.h"
#include "oracle/certified_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace voxtact::oracle {

namespace {

using certified::Cell;
using certified::CellVoxels;
using certified::Field;
using certified::Opacity;

/// Of a place in index space, relative to the largest coordinate that it is made of.
constexpr double kVertexError = 0x1p-44;
/// Of a projection onto an axis, relative to the longest vector that is projected.
constexpr double kProjectionError = 0x1p-48;
/// Boxes are divided before the values of more cells than that are asked for.
constexpr std::int64_t kMaxCells = 64;
/// Voxels: smaller boxes are not divided for the opaque region outside the solid.
constexpr double kOutsideSide = 0.5;

/// How much of a box belongs to a set. Of two sets together it is the least.
enum class Fill { None, Some, All };

Fill complement(Fill a) {
    return a == Fill::All ? Fill::None : (a == Fill::None ? Fill::All : Fill::Some);
}
Fill fillOf(bool some, bool all) {
    return all ? Fill::All : (some ? Fill::Some : Fill::None);
}

using Triangle = std::array<Vec3, 3>;

/// A box in index space, and the triangles that may meet it.
struct Region {
    Vec3 lo{};
    Vec3 hi{};
    std::vector<std::uint32_t> triangles{};
    Fill solid = Fill::Some;

    [[nodiscard]] Vec3 centre() const { return {(lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2}; }
    [[nodiscard]] double longestSide() const { return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}); }
};

/// Of the solid angle over 4 pi; corners are relative to the point.
double solidAngle(const Triangle& t) {
    const double a = length(t[0]);
    const double b = length(t[1]);
    const double c = length(t[2]);
    const double volume = dot(t[0], cross(t[1], t[2]));
    const double rest = a * b * c + dot(t[0], t[1]) * c + dot(t[1], t[2]) * a + dot(t[2], t[0]) * b;
    return std::atan2(volume, rest) / (2 * std::numbers::pi);
}

/// True: a plane lies between the box and every place within `error` of the triangle.
bool areApart(const Vec3& axis, const Region& box, const Triangle& triangle, double error) {
    const Vec3 centre = box.centre();
    double least = kInfinity;
    double greatest = -kInfinity;
    double farthest = 0;
    for (const Vec3& corner : triangle) {
        const Vec3 to = minus(corner, centre);
        least = std::min(least, dot(axis, to));
        greatest = std::max(greatest, dot(axis, to));
        farthest = std::max({farthest, std::abs(to[0]), std::abs(to[1]), std::abs(to[2])});
    }
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        reach += std::abs(axis[i]) * ((box.hi[i] - box.lo[i]) / 2 + error + kProjectionError * farthest);
    }
    return least > reach || greatest < -reach;
}

/// False: they are certainly apart (Akenine-Moller's thirteen axes). Any axis proves it, however it was rounded.
bool mayMeet(const Region& box, const Triangle& t, double error) {
    const std::array<Vec3, 3> units{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const std::array<Vec3, 3> edges{minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
    for (const Vec3& unit : units) {
        if (areApart(unit, box, t, error)) {
            return false;
        }
    }
    if (areApart(cross(edges[0], edges[1]), box, t, error)) {
        return false;
    }
    for (const Vec3& edge : edges) {
        for (const Vec3& unit : units) {
            if (areApart(cross(edge, unit), box, t, error)) {
                return false;
            }
        }
    }
    return true;
}

/// A mesh in index space.
class Solid {
  public:
    Solid(const OraclePair& pair, const Mat4& texture_from_world) {
        const auto& size = pair.volume.grid.size;
        for (std::size_t i = 0; i < pair.mesh.indices.size(); ++i) {
            const double* at = &pair.mesh.positions[std::size_t{3} * pair.mesh.indices[i]];
            const Vec3 object{at[0], at[1], at[2]};
            const Vec3 world = transformPoint(pair.world_from_object, object);
            const Vec3 texture = transformPoint(texture_from_world, world);
            Vec3 index{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                index[axis] = texture[axis] * size[axis] - 0.5;
                double terms = std::abs(texture_from_world[12 + axis]);
                for (std::size_t row = 0; row < 3; ++row) {
                    double along = std::abs(pair.world_from_object[12 + row]);
                    for (std::size_t column = 0; column < 3; ++column) {
                        along += std::abs(pair.world_from_object[4 * column + row] * object[column]);
                    }
                    terms += std::abs(texture_from_world[4 * row + axis]) * along;
                }
                error_ = std::max(error_, kVertexError * (terms + 1) * size[axis]);
            }
            if (i % 3 == 0) {
                triangles_.emplace_back();
            }
            triangles_.back()[i % 3] = index;
        }
    }

    /// Of all triangles, and some room around it.
    [[nodiscard]] Region box() const {
        Region out{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
        for (const Triangle& triangle : triangles_) {
            for (const Vec3& corner : triangle) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    out.lo[axis] = std::min(out.lo[axis], corner[axis] - 2 * error_ - 1e-3);
                    out.hi[axis] = std::max(out.hi[axis], corner[axis] + 2 * error_ + 1e-3);
                }
            }
        }
        return out;
    }

    [[nodiscard]] std::vector<std::uint32_t> all() const {
        std::vector<std::uint32_t> out(triangles_.size());
        std::iota(out.begin(), out.end(), 0U);
        return out;
    }

    /// Fills in what a box has of these triangles, which are all that may meet it, and of the solid.
    void place(Region& box, const std::vector<std::uint32_t>& some) const {
        std::copy_if(some.begin(), some.end(), std::back_inserter(box.triangles),
                     [&](std::uint32_t i) { return mayMeet(box, triangles_[i], error_); });
        box.solid = box.triangles.empty() ? around(box) : Fill::Some;
    }

  private:
    /// Of a box that no triangle meets.
    [[nodiscard]] Fill around(const Region& box) const {
        const Vec3 centre = box.centre();
        double winding = 0;
        for (const Triangle& t : triangles_) {
            winding += solidAngle({minus(t[0], centre), minus(t[1], centre), minus(t[2], centre)});
        }
        if (std::abs(winding - std::round(winding)) > 1e-3) {
            throw std::runtime_error("the mesh is not closed: its winding number around a place is " +
                                     std::to_string(winding));
        }
        return std::round(winding) == 0 ? Fill::None : Fill::All;
    }

    std::vector<Triangle> triangles_;
    double error_ = 0; ///< voxels, of every corner along each axis
};

/// The values and labels of an image.
class Image {
  public:
    Image(const OraclePair& pair, const ValueRange& range, const Overlap& question, const LabelData* labels)
        : field_(pair.volume, range), opacity_(pair.transferFunction.points, pair.threshold), question_(question),
          labels_(labels), limits_{-kInfinity} {
        limits_.insert(limits_.end(), question.bandLimits.begin(), question.bandLimits.end());
        limits_.push_back(kInfinity);
    }

    /// Of the opaque region, of each band, and of each label.
    [[nodiscard]] std::vector<Fill> fills(const Region& box) const {
        const std::size_t bands = question_.bandLimits.empty() ? 0 : question_.bandLimits.size() + 1;
        std::vector<bool> some(1 + bands, false);
        std::vector<bool> all(1 + bands, true);
        Cell first{};
        Cell last{};
        std::int64_t cells = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = static_cast<std::int64_t>(std::floor(box.lo[axis]));
            last[axis] = static_cast<std::int64_t>(std::ceil(box.hi[axis])) - 1;
            cells *= last[axis] - first[axis] + 1;
        }
        if (cells > kMaxCells) {
            return std::vector<Fill>(1 + bands + question_.labels.size(), Fill::Some);
        }
        for (Cell cell = first; cell[2] <= last[2]; ++cell[2]) {
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
                for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                    const ValueRange values = valuesIn(box, cell);
                    some[0] = some[0] || opacity_.mayBeOpaque(values);
                    all[0] = all[0] && opacity_.allOpaque(values);
                    for (std::size_t band = 0; band < bands; ++band) {
                        const double from = limits_[band];
                        const double below = limits_[band + 1];
                        some[1 + band] = some[1 + band] || (values.hi >= from && values.lo < below);
                        all[1 + band] = all[1 + band] && values.lo >= from && values.hi < below;
                    }
                }
            }
        }
        std::vector<Fill> out;
        for (std::size_t i = 0; i < some.size(); ++i) {
            out.push_back(fillOf(some[i], all[i]));
        }
        for (const std::int32_t label : question_.labels) {
            out.push_back(labelled(box, label));
        }
        return out;
    }

  private:
    /// Of the part of a box that is in a cell: an interpolant has its extremes at corners, and none beyond its voxels.
    [[nodiscard]] ValueRange valuesIn(const Region& box, const Cell& cell) const {
        const CellVoxels voxels = field_.voxelsOf(cell);
        const auto [least, greatest] = std::minmax_element(voxels.begin(), voxels.end());
        ValueRange values{kInfinity, -kInfinity};
        for (std::size_t corner = 0; corner < 8; ++corner) {
            double value = 0;
            for (std::size_t i = 0; i < 8; ++i) {
                double weight = 1;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double end = (corner >> axis & 1U) == 0 ? box.lo[axis] : box.hi[axis];
                    const double along = std::clamp(end - static_cast<double>(cell[axis]), 0.0, 1.0);
                    weight *= (i >> axis & 1U) == 0 ? 1 - along : along;
                }
                value += weight * voxels[i];
            }
            values = {std::min(values.lo, value), std::max(values.hi, value)};
        }
        return {std::clamp(values.lo - field_.doubt(0), *least, *greatest),
                std::clamp(values.hi + field_.doubt(0), *least, *greatest)};
    }

    [[nodiscard]] Fill labelled(const Region& box, std::int32_t label) const {
        const auto& size = labels_->grid.size;
        std::array<std::int64_t, 3> first{};
        std::array<std::int64_t, 3> last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = static_cast<std::int64_t>(std::floor(box.lo[axis] + 0.5));
            last[axis] = static_cast<std::int64_t>(std::ceil(box.hi[axis] + 0.5)) - 1;
        }
        bool some = false;
        bool all = true;
        for (std::int64_t z = first[2]; z <= last[2]; ++z) {
            for (std::int64_t y = first[1]; y <= last[1]; ++y) {
                for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                    const auto at = static_cast<std::size_t>((z * size[1] + y) * size[0] + x);
                    const bool has = labels_->values[labels_->indices[at]] == label;
                    some = some || has;
                    all = all && has;
                }
            }
        }
        return fillOf(some, all);
    }

    Field field_;
    Opacity opacity_;
    const Overlap& question_;
    const LabelData* labels_;
    std::vector<double> limits_; ///< and infinity at either end
};

/// At a multiple of half a voxel where there is one, so that boxes end where cells and labels do.
double middleOf(double lo, double hi) {
    const double middle = (lo + hi) / 2;
    const double half = std::round(2 * middle) / 2;
    return half > lo && half < hi ? half : middle;
}

std::vector<Region> divided(const Region& box, const Solid& solid) {
    std::vector<Region> out{{box.lo, box.hi}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.hi[axis] - box.lo[axis] < 0.6 * box.longestSide()) {
            continue;
        }
        const double middle = middleOf(box.lo[axis], box.hi[axis]);
        for (std::size_t i = out.size(); i-- > 0;) {
            out.push_back(out[i]);
            out[i].hi[axis] = middle;
            out.back().lo[axis] = middle;
        }
    }
    for (Region& part : out) {
        if (box.triangles.empty()) {
            part.solid = box.solid;
        } else {
            solid.place(part, box.triangles);
        }
    }
    return out;
}

/// Sums up the volumes of boxes, in voxels. `fills` says how much of a box is in each set. Boxes whose longest side is
/// at most `minSide` are not divided.
template <class Fills>
std::vector<Bounds> sumUp(const Solid& solid, Region root, const Fills& fills, double minSide, std::size_t maxBoxes) {
    solid.place(root, solid.all());
    std::vector<Bounds> sums(fills(root).size());
    for (std::vector<Region> boxes{root}; !boxes.empty();) {
        const bool last = 8 * boxes.size() > maxBoxes;
        std::vector<Region> next;
        for (const Region& box : boxes) {
            const std::vector<Fill> fill = fills(box);
            const bool isOpen = std::find(fill.begin(), fill.end(), Fill::Some) != fill.end();
            if (isOpen && !last && box.longestSide() > minSide) {
                const std::vector<Region> parts = divided(box, solid);
                next.insert(next.end(), parts.begin(), parts.end());
                continue;
            }
            const double volume = (box.hi[0] - box.lo[0]) * (box.hi[1] - box.lo[1]) * (box.hi[2] - box.lo[2]);
            for (std::size_t i = 0; i < fill.size(); ++i) {
                sums[i].lower += fill[i] == Fill::All ? volume : 0;
                sums[i].upper += fill[i] != Fill::None ? volume : 0;
            }
        }
        boxes = std::move(next);
    }
    return sums;
}

double voxelVolume(const Grid& grid) {
    const auto& d = grid.direction;
    const double volume = dot({d[0], d[1], d[2]}, cross({d[3], d[4], d[5]}, {d[6], d[7], d[8]}));
    return std::abs(volume * grid.spacing[0] * grid.spacing[1] * grid.spacing[2]);
}

Bounds times(const Bounds& bounds, double factor) {
    return {bounds.lower * factor, bounds.upper * factor};
}

OracleOverlap overlapOf(const Solid& solid, const Image& image, const Grid& grid, const Overlap& question,
                        std::size_t maxBoxes) {
    const std::size_t bands = question.bandLimits.empty() ? 0 : question.bandLimits.size() + 1;
    Region all{{-0.5, -0.5, -0.5}};
    Region around = solid.box();
    bool meets = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        all.hi[axis] = grid.size[axis] - 0.5;
        around.lo[axis] = std::max(around.lo[axis], all.lo[axis]);
        around.hi[axis] = std::min(around.hi[axis], all.hi[axis]);
        meets = meets && around.lo[axis] < around.hi[axis];
    }
    // The opaque region, its parts in labels, bands, and the solid.
    const auto insides = [&](const Region& box) {
        std::vector<Fill> out = image.fills(box);
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = std::min({out[i], box.solid, i > bands ? out[0] : Fill::All});
        }
        out.push_back(box.solid);
        return out;
    };
    const auto outsides = [&](const Region& box) {
        const std::vector<Fill> of = image.fills(box);
        std::vector<Fill> out{std::min(of[0], complement(box.solid))};
        for (std::size_t i = 1 + bands; i < of.size(); ++i) {
            out.push_back(std::min(of[i], out[0]));
        }
        return out;
    };
    std::vector<Bounds> inside(2 + bands + question.labels.size());
    if (meets) {
        inside = sumUp(solid, around, insides, 0, maxBoxes);
    }
    const std::vector<Bounds> outside = sumUp(solid, all, outsides, kOutsideSide, 8 * maxBoxes);
    const double unit = voxelVolume(grid);
    OracleOverlap out{times(inside[0], unit), times(outside[0], unit), times(inside.back(), unit)};
    for (std::size_t i = 0; i < bands; ++i) {
        out.bands.push_back(times(inside[1 + i], unit));
    }
    for (std::size_t i = 0; i < question.labels.size(); ++i) {
        out.labels.push_back({times(inside[1 + bands + i], unit), times(outside[1 + i], unit)});
    }
    return out;
}

template <class Answer> auto checked(const OraclePair& pair, const Answer& answer) -> decltype(answer({}, {})) {
    return guard([&]() -> decltype(answer({}, {})) {
        VOXTACT_TRY(checkMesh(pair.mesh));
        const Result<ValueRange> range = checkVolume(pair.volume);
        VOXTACT_TRY(range);
        VOXTACT_TRY(sampleTable(pair.transferFunction));
        VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), pair.threshold));
        VOXTACT_TRY(checkAffine(pair.world_from_object, "the pose"));
        const Result<Mat4> texture_from_world = textureFromWorld(pair.volume.grid);
        VOXTACT_TRY(texture_from_world);
        return answer(*range, *texture_from_world);
    });
}

} // namespace

Result<OracleOverlap> overlapOracle(const OraclePair& pair, const Overlap& question, const LabelData* labels,
                                    std::size_t maxBoxes) {
    return checked(pair, [&](const ValueRange& range, const Mat4& texture_from_world) -> Result<OracleOverlap> {
        return overlapOf(Solid(pair, texture_from_world), Image(pair, range, question, labels), pair.volume.grid,
                         question, maxBoxes);
    });
}

Result<Bounds> solidOracle(const OraclePair& pair, std::size_t maxBoxes) {
    return checked(pair, [&](const ValueRange&, const Mat4& texture_from_world) -> Result<Bounds> {
        const Solid solid(pair, texture_from_world);
        const auto fills = [](const Region& box) { return std::vector<Fill>{box.solid}; };
        return times(sumUp(solid, solid.box(), fills, 0, maxBoxes).front(), voxelVolume(pair.volume.grid));
    });
}

} // namespace voxtact::oracle
