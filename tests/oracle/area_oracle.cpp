// SPDX-License-Identifier: MIT
#include "oracle/area_oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "oracle/certified_sample.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::oracle {

namespace {

using certified::Cell;
using certified::CellVoxels;
using certified::Field;
using certified::Opacity;

/// Of a place in index space, relative to the largest coordinate that it is made of.
constexpr double kPlaceError = 0x1p-44;

struct IndexBox {
    Vec3 lo{};
    Vec3 hi{};
};

struct Part {
    std::array<Vec3, 3> corners{}; ///< index space
    double area = 0;               ///< mm^2
};

enum class Holds { Nothing, Some, All };

double areaOf(const std::array<Vec3, 3>& t) {
    Vec3 a{};
    Vec3 b{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        a[axis] = t[1][axis] - t[0][axis];
        b[axis] = t[2][axis] - t[0][axis];
    }
    return std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]) / 2;
}

Vec3 middle(const Vec3& a, const Vec3& b) {
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

class Judge {
  public:
    /// `labels`: null where all count.
    Judge(const OraclePair& pair, const ValueRange& range, const Mat4& texture_from_world, const LabelData* labels,
          std::int32_t label)
        : field_(pair.volume, range), opacity_(pair.transferFunction.points, pair.threshold), labels_(labels),
          label_(label) {
        for (std::size_t i = 0; i < pair.mesh.indices.size(); i += 3) {
            addTriangle(pair, texture_from_world, i);
        }
    }

    OracleArea run(std::size_t mostParts) {
        OracleArea out;
        while (!parts_.empty()) {
            std::vector<Part> next;
            const bool last = 4 * parts_.size() > mostParts;
            for (const Part& part : parts_) {
                const Holds holds = look(part);
                out.lo += holds == Holds::All ? part.area : 0;
                out.hi += holds == Holds::All || (last && holds == Holds::Some) ? part.area : 0;
                if (!last && holds == Holds::Some) {
                    quarter(part, next);
                }
            }
            parts_ = std::move(next);
        }
        return out;
    }

  private:
    void addTriangle(const OraclePair& pair, const Mat4& texture_from_world, std::size_t first) {
        Part part;
        std::array<Vec3, 3> world{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* at = &pair.mesh.positions[std::size_t{3} * pair.mesh.indices[first + corner]];
            world[corner] = transformPoint(pair.world_from_object, {at[0], at[1], at[2]});
            const Vec3 texture = transformPoint(texture_from_world, world[corner]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                part.corners[corner][axis] = texture[axis] * field_.size()[axis] - 0.5;
                double terms = std::abs(texture_from_world[12 + axis]);
                for (std::size_t column = 0; column < 3; ++column) {
                    const double along =
                        std::abs(world[corner][column]) + std::abs(pair.world_from_object[12 + column]);
                    terms += std::abs(texture_from_world[4 * column + axis]) * along;
                }
                error_ = std::max(error_, kPlaceError * (terms + 1) * field_.size()[axis]);
            }
        }
        part.area = areaOf(world);
        parts_.push_back(part);
    }

    static void quarter(const Part& part, std::vector<Part>& out) {
        const auto& [a, b, c] = part.corners;
        const Vec3 ab = middle(a, b);
        const Vec3 bc = middle(b, c);
        const Vec3 ca = middle(c, a);
        const double area = part.area / 4;
        out.push_back({{a, ab, ca}, area});
        out.push_back({{ab, b, bc}, area});
        out.push_back({{ca, bc, c}, area});
        out.push_back({{ab, bc, ca}, area});
    }

    [[nodiscard]] Holds look(const Part& part) const {
        constexpr std::int64_t kMostCells = 64;
        IndexBox box;
        Cell first{};
        Cell last{};
        bool inside = true;
        std::int64_t cells = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto along = [&](std::size_t corner) { return part.corners[corner][axis]; };
            box.lo[axis] = std::min({along(0), along(1), along(2)}) - error_;
            box.hi[axis] = std::max({along(0), along(1), along(2)}) + error_;
            const double end = field_.size()[axis] - 0.5;
            if (box.hi[axis] < -0.5 || box.lo[axis] > end) {
                return Holds::Nothing;
            }
            inside = inside && box.lo[axis] >= -0.5 && box.hi[axis] <= end;
            box.lo[axis] = std::clamp(box.lo[axis], -0.5, end);
            box.hi[axis] = std::clamp(box.hi[axis], -0.5, end);
            first[axis] = static_cast<std::int64_t>(std::floor(box.lo[axis]));
            last[axis] = static_cast<std::int64_t>(std::floor(box.hi[axis]));
            cells *= last[axis] - first[axis] + 1;
        }
        if (cells > kMostCells) {
            return Holds::Some;
        }
        const Holds labelled = labels_ == nullptr ? Holds::All : lookAtLabels(box);
        const Holds opaque = labelled == Holds::Nothing ? Holds::Nothing : lookAtCells(box, first, last);
        if (opaque == Holds::Nothing) {
            return opaque;
        }
        return inside && labelled == Holds::All && opaque == Holds::All ? Holds::All : Holds::Some;
    }

    [[nodiscard]] Holds lookAtCells(const IndexBox& box, const Cell& first, const Cell& last) const {
        bool all = true;
        bool some = false;
        Cell cell{};
        for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
                for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                    const ValueRange values = valuesIn(box, cell);
                    all = all && opacity_.allOpaque(values);
                    some = some || opacity_.mayBeOpaque(values);
                }
            }
        }
        return all ? Holds::All : (some ? Holds::Some : Holds::Nothing);
    }

    /// Of the part of a box that is in a cell: an interpolant has its extremes at corners.
    [[nodiscard]] ValueRange valuesIn(const IndexBox& box, const Cell& cell) const {
        const CellVoxels voxels = field_.voxelsOf(cell);
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
        return {values.lo - field_.doubt(0), values.hi + field_.doubt(0)};
    }

    [[nodiscard]] Holds lookAtLabels(const IndexBox& box) const {
        std::array<std::size_t, 3> first{};
        std::array<std::size_t, 3> last{};
        const auto& size = labels_->grid.size;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double most = size[axis] - 1.0;
            first[axis] = static_cast<std::size_t>(std::clamp(std::floor(box.lo[axis] + 0.5), 0.0, most));
            last[axis] = static_cast<std::size_t>(std::clamp(std::floor(box.hi[axis] + 0.5), 0.0, most));
        }
        bool all = true;
        bool some = false;
        for (std::size_t z = first[2]; z <= last[2]; ++z) {
            for (std::size_t y = first[1]; y <= last[1]; ++y) {
                for (std::size_t x = first[0]; x <= last[0]; ++x) {
                    const bool has = labels_->values[labels_->indices[(z * size[1] + y) * size[0] + x]] == label_;
                    all = all && has;
                    some = some || has;
                }
            }
        }
        return all ? Holds::All : (some ? Holds::Some : Holds::Nothing);
    }

    Field field_;
    Opacity opacity_;
    const LabelData* labels_;
    std::int32_t label_;
    std::vector<Part> parts_;
    double error_ = 0; ///< voxels, of corners and of what they are halved to
};

Result<OracleArea> judge(const OraclePair& pair, const LabelData* labels, std::int32_t label, std::size_t mostParts) {
    return guard([&]() -> Result<OracleArea> {
        VOXTACT_TRY(checkMesh(pair.mesh));
        const Result<ValueRange> range = checkVolume(pair.volume);
        VOXTACT_TRY(range);
        VOXTACT_TRY(sampleTable(pair.transferFunction));
        VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), pair.threshold));
        VOXTACT_TRY(checkAffine(pair.world_from_object, "the pose"));
        const Result<Mat4> texture_from_world = textureFromWorld(pair.volume.grid);
        VOXTACT_TRY(texture_from_world);
        return Judge(pair, *range, *texture_from_world, labels, label).run(mostParts);
    });
}

} // namespace

Result<OracleArea> areaOracle(const OraclePair& pair, std::size_t mostParts) {
    return judge(pair, nullptr, 0, mostParts);
}

Result<OracleArea> labelAreaOracle(const OraclePair& pair, const LabelData& labels, std::int32_t label,
                                   std::size_t mostParts) {
    return judge(pair, &labels, label, mostParts);
}

} // namespace voxtact::oracle
