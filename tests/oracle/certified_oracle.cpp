// SPDX-License-Identifier: MIT
#include "oracle/certified_oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "oracle/certified_cut.h"
#include "oracle/certified_sample.h"

#include <algorithm>
#include <cmath>

namespace voxtact::oracle {

namespace {

using certified::Cell;
using certified::CellVoxels;
using certified::Corners;
using certified::Field;
using certified::kRounding;
using certified::Opacity;
using certified::Polygon;
using certified::Region;

/// A triangle stays undecided when so many pieces have come from dividing.
constexpr std::size_t kMostPieces = std::size_t{1} << 13U;
/// A triangle whose corners are less certain than that, in voxels, is undecided.
constexpr double kMostError = 0x1p-12;
/// Of a chain of products of matrices, and of all the cuts and halvings of a triangle.
constexpr double kTransformRoundings = 64;
constexpr double kCutRoundings = 256;
constexpr int kBisections = 100;

/// A pair that has passed the checks.
struct Scene {
    MeshView mesh;
    Field field;
    Opacity opacity;
    Mat4 texture_from_world{};
    Mat4 world_from_object{};
    double resolution = 0;
};

Result<Scene> prepare(const OraclePair& pair, double resolution) {
    VOXTACT_TRY(checkMesh(pair.mesh));
    const Result<ValueRange> range = checkVolume(pair.volume);
    VOXTACT_TRY(range);
    VOXTACT_TRY(sampleTable(pair.transferFunction));
    VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), pair.threshold));
    VOXTACT_TRY(checkAffine(pair.world_from_object, "the pose"));
    if (!(resolution > 0) || !std::isfinite(resolution)) {
        return refuse("the resolution is " + number(resolution) + ", it must be finite and positive");
    }
    const Result<Mat4> texture_from_world = textureFromWorld(pair.volume.grid);
    VOXTACT_TRY(texture_from_world);
    return Scene{pair.mesh,           Field(pair.volume, *range), Opacity(pair.transferFunction.points, pair.threshold),
                 *texture_from_world, pair.world_from_object,     resolution};
}

Region domainOf(const Scene& scene) {
    Region out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.lo[axis] = -0.5;
        out.hi[axis] = scene.field.size()[axis] - 0.5;
    }
    return out;
}

/// A triangle in index space. Everything that is computed from its corners is within `error` of the true triangle
/// along each axis, and the other way round.
struct Placed {
    Corners corners;
    double error = 0;
};

/// The image of a point, and how large the parts are that it is a sum of.
struct Image {
    Vec3 point{};
    Vec3 magnitude{};
};

Image transform(const Mat4& b_from_a, const Image& a) {
    Image out;
    for (std::size_t row = 0; row < 3; ++row) {
        out.point[row] = b_from_a[12 + row];
        out.magnitude[row] = std::abs(b_from_a[12 + row]);
        for (std::size_t column = 0; column < 3; ++column) {
            out.point[row] += b_from_a[4 * column + row] * a.point[column];
            out.magnitude[row] += std::abs(b_from_a[4 * column + row]) * a.magnitude[column];
        }
    }
    return out;
}

Placed place(const Scene& scene, std::size_t triangle) {
    Placed out;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t at = std::size_t{3} * scene.mesh.indices[3 * triangle + corner];
        Image object;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            object.point[axis] = scene.mesh.positions[at + axis];
            object.magnitude[axis] = std::abs(object.point[axis]);
        }
        const Image texture = transform(scene.texture_from_world, transform(scene.world_from_object, object));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double n = scene.field.size()[axis];
            out.corners[corner][axis] = texture.point[axis] * n - 0.5;
            const double cuts = kCutRoundings * (std::abs(out.corners[corner][axis]) + n);
            const double error = kRounding * (kTransformRoundings * (texture.magnitude[axis] * n + 1) + cuts);
            out.error = std::max(out.error, std::isfinite(error) ? error : kInfinity);
        }
    }
    return out;
}

/// Looks for an opaque point of one triangle in a region, a box in the domain.
class Search {
  public:
    Search(const Scene& scene, const Placed& triangle, const Region& region)
        : scene_(scene), triangle_(triangle), margin_(2 * triangle.error), outer_(certified::shrunk(region, -margin_)),
          inner_(certified::shrunk(region, margin_)) {}

    JudgedTriangle run() {
        if (std::isfinite(triangle_.error) && !certified::meet(certified::boundsOf(triangle_.corners), outer_)) {
            return {};
        }
        if (triangle_.error > kMostError) {
            return {Certainty::Undecided, {}, false};
        }
        Polygon polygon(triangle_.corners.begin(), triangle_.corners.end());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            polygon = certified::slab(polygon, axis, outer_.lo[axis], outer_.hi[axis]);
        }
        Cell cell{};
        cutAtCells(polygon, 2, cell);
        const std::size_t most = pieces_.size() + kMostPieces;
        for (std::size_t i = 0; i < pieces_.size() && found_.certainty != Certainty::Certain; ++i) {
            if (i == most) {
                found_.certainty = Certainty::Undecided;
                break;
            }
            look(Piece(pieces_[i]));
        }
        return found_;
    }

  private:
    struct CellPart {
        Cell cell{};
        CellVoxels voxels{};
    };
    struct Piece {
        Corners corners;
        std::size_t part;
    };
    struct Known {
        Vec3 place{};
        double value = 0;
    };

    /// Appends the parts of the polygon in each cell that it meets. A point in a face is in both.
    void cutAtCells(const Polygon& polygon, std::size_t axis, Cell& cell) {
        if (polygon.empty()) {
            return;
        }
        const Region bounds = certified::boundsOf(polygon);
        const std::int64_t last = std::int64_t{scene_.field.size()[axis]} - 1;
        const auto cellAt = [&](double place) {
            return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place)), -1, last);
        };
        const std::int64_t end = cellAt(bounds.hi[axis] + margin_);
        for (std::int64_t i = cellAt(bounds.lo[axis] - margin_); i <= end; ++i) {
            cell[axis] = i;
            const auto lo = static_cast<double>(i);
            const Polygon part = certified::slab(polygon, axis, lo - margin_, lo + 1 + margin_);
            if (axis > 0) {
                cutAtCells(part, axis - 1, cell);
            } else {
                appendPart(part, cell);
            }
        }
    }

    void appendPart(const Polygon& polygon, const Cell& cell) {
        const CellVoxels voxels = scene_.field.voxelsOf(cell);
        const auto [least, greatest] = std::minmax_element(voxels.begin(), voxels.end());
        if (polygon.empty() || !scene_.opacity.mayBeOpaque({*least, *greatest})) {
            return;
        }
        parts_.push_back({cell, voxels});
        for (std::size_t i = 0; i + 2 < std::max<std::size_t>(polygon.size(), 3); ++i) {
            const std::size_t last = polygon.size() - 1;
            const Corners corners{polygon[0], polygon[std::min(i + 1, last)], polygon[std::min(i + 2, last)]};
            pieces_.push_back({corners, parts_.size() - 1});
        }
    }

    void look(const Piece& piece) {
        const CellPart& part = parts_[piece.part];
        const ValueRange values = scene_.field.over(part.voxels, part.cell, piece.corners, 2 * margin_);
        if (!scene_.opacity.mayBeOpaque(values)) {
            return;
        }
        lookAt(certified::centroid(piece.corners));
        for (const Vec3& corner : piece.corners) {
            lookAt(corner);
        }
        if (found_.certainty == Certainty::Certain) {
            return;
        }
        if (cannotBeDecided(piece, values)) {
            found_.certainty = Certainty::Undecided;
            return;
        }
        for (const Corners& half : certified::halves(piece.corners)) {
            pieces_.push_back({half, piece.part});
        }
    }

    [[nodiscard]] bool cannotBeDecided(const Piece& piece, const ValueRange& values) const {
        return certified::longestEdge(piece.corners) <= scene_.resolution ||
               values.hi - values.lo <= 3 * scene_.field.doubt(2 * margin_) ||
               !certified::meet(certified::boundsOf(piece.corners), inner_);
    }

    /// The part of the triangle in the region is connected and values are continuous, so that all values between two
    /// known ones occur.
    void lookAt(const Vec3& place) {
        if (found_.certainty == Certainty::Certain || !certified::meet({place, place}, inner_)) {
            return;
        }
        const ValueRange value = scene_.field.at(place, margin_);
        if (scene_.opacity.allOpaque(value)) {
            found_ = {Certainty::Certain, textureOf(place), false};
            return;
        }
        if (value.hi >= lowest_.value && value.lo <= highest_.value) {
            return;
        }
        if (value.hi < lowest_.value) {
            lowest_ = {place, value.hi};
        }
        if (value.lo > highest_.value) {
            highest_ = {place, value.lo};
        }
        if (lowest_.value < highest_.value) {
            const std::optional<double> opaque = scene_.opacity.opaqueBetween(lowest_.value, highest_.value);
            if (opaque) {
                found_ = {Certainty::Certain, textureOf(between(*opaque)), true};
            }
        }
    }

    /// Where the value is taken between the places of the lowest and the highest.
    [[nodiscard]] Vec3 between(double value) const {
        Vec3 below = lowest_.place;
        Vec3 above = highest_.place;
        for (int i = 0; i < kBisections; ++i) {
            const Vec3 here = certified::middle(below, above);
            (scene_.field.at(here, 0).lo <= value ? below : above) = here;
        }
        return below;
    }

    [[nodiscard]] Vec3 textureOf(const Vec3& place) const {
        Vec3 out{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[axis] = (place[axis] + 0.5) / scene_.field.size()[axis];
        }
        return out;
    }

    const Scene& scene_;
    const Placed& triangle_;
    double margin_;
    Region outer_; ///< a computed point outside of it is outside the region beyond doubt
    Region inner_; ///< a computed point in it is in the region beyond doubt
    std::vector<CellPart> parts_;
    std::vector<Piece> pieces_; ///< grows behind: all large pieces are examined before the smaller ones
    Known lowest_{{}, kInfinity};
    Known highest_{{}, -kInfinity};
    JudgedTriangle found_;
};

JudgedTriangle decide(const Scene& scene, const Placed& triangle, const Region& region) {
    return Search(scene, triangle, region).run();
}

/// The part in the domain of a cell enlarged.
Region regionOf(const Scene& scene, const Cell& cell, double margin) {
    const Region domain = domainOf(scene);
    Region out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto first = static_cast<double>(cell[axis]);
        out.lo[axis] = std::max(first - margin, domain.lo[axis]);
        out.hi[axis] = std::min(first + 1 + margin, domain.hi[axis]);
    }
    return out;
}

Certainty decideCell(const Scene& scene, const Placed& triangle, const Cell& cell, double margin) {
    if (decide(scene, triangle, regionOf(scene, cell, margin)).certainty == Certainty::None) {
        return Certainty::None;
    }
    const bool certain = decide(scene, triangle, regionOf(scene, cell, 0)).certainty == Certainty::Certain;
    return certain ? Certainty::Certain : Certainty::Undecided;
}

std::vector<JudgedCell> cellsOf(const Scene& scene, const Placed& triangle, double margin) {
    const Region bounds = certified::shrunk(certified::boundsOf(triangle.corners), -2 * margin - kCellMargin);
    const bool placed = triangle.error <= kMostError;
    Cell first{};
    Cell last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double greatest = static_cast<double>(scene.field.size()[axis]) - 1;
        // A triangle beside the domain has no cell.
        const double lo = placed ? std::clamp(std::floor(bounds.lo[axis]), -1.0, greatest + 1) : -1;
        const double hi = placed ? std::clamp(std::floor(bounds.hi[axis]), -2.0, greatest) : greatest;
        first[axis] = static_cast<std::int64_t>(lo);
        last[axis] = static_cast<std::int64_t>(hi);
    }
    std::vector<JudgedCell> out;
    Cell cell{};
    for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
        for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
            for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                const Certainty certainty = decideCell(scene, triangle, cell, margin);
                if (certainty != Certainty::None) {
                    out.push_back({cell, certainty});
                }
            }
        }
    }
    return out;
}

} // namespace

const char* toString(Certainty certainty) noexcept {
    switch (certainty) {
    case Certainty::None:
        return "none";
    case Certainty::Certain:
        return "certain";
    case Certainty::Undecided:
        break;
    }
    return "undecided";
}

Result<CertifiedOracle> certifiedOracle(const OraclePair& pair, double resolution) {
    return guard([&]() -> Result<CertifiedOracle> {
        const Result<Scene> scene = prepare(pair, resolution);
        VOXTACT_TRY(scene);
        CertifiedOracle out;
        bool undecided = false;
        bool certain = false;
        for (std::size_t triangle = 0; triangle < pair.mesh.indices.size() / 3; ++triangle) {
            const Placed placed = place(*scene, triangle);
            out.triangles.push_back(decide(*scene, placed, domainOf(*scene)));
            undecided |= out.triangles.back().certainty == Certainty::Undecided;
            certain |= out.triangles.back().certainty == Certainty::Certain;
        }
        out.certainty = certain ? Certainty::Certain : undecided ? Certainty::Undecided : Certainty::None;
        return out;
    });
}

Result<std::vector<JudgedCell>> certifiedCells(const OraclePair& pair, std::uint32_t triangle, double margin) {
    return guard([&]() -> Result<std::vector<JudgedCell>> {
        const Result<Scene> scene = prepare(pair, kOracleResolution);
        VOXTACT_TRY(scene);
        if (triangle >= pair.mesh.indices.size() / 3) {
            return refuse("there is no triangle " + std::to_string(triangle) + ", the mesh has " +
                          std::to_string(pair.mesh.indices.size() / 3));
        }
        if (!(margin >= 0 && margin <= 1)) {
            return refuse("the margin " + number(margin) + " is outside of 0 to 1 voxel");
        }
        return cellsOf(*scene, place(*scene, triangle), margin);
    });
}

} // namespace voxtact::oracle
