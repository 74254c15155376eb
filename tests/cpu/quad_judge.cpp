// SPDX-License-Identifier: MIT
#include "quad_judge.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace voxtact::test {

namespace {

__extension__ using Quad = __float128;

/// Of the terms of a sum or a product: generously more than a hundred roundings.
template <class Real> constexpr Real kRounding = Real(0x1p-46);
template <> constexpr Quad kRounding<Quad> = Quad(0x1p-104);
/// Voxels: pieces are not halved beyond it. And how many are looked at in a cell.
template <class Real> constexpr double kSmallest = 0x1p-14;
template <> constexpr double kSmallest<Quad> = 0x1p-44;
template <class Real> constexpr int kMostPieces = 300;
template <> constexpr int kMostPieces<Quad> = 3000;

template <class Real> Real size(Real value) {
    return value < 0 ? -value : value;
}

template <class Real> using Place = std::array<Real, 3>;

/// A sum that knows whether it was rounded.
template <class Real> struct Sum {
    Real value = 0;
    Real magnitude = 0;
    bool exact = true;

    void add(Real term) {
        const Real sum = value + term;
        const Real ofTerm = sum - value;
        exact = exact && (term - ofTerm) + (value - (sum - ofTerm)) == 0;
        value = sum;
        magnitude += size(term);
    }
    /// Of a double and what has at most 32 bits: exact in 113 bits, never taken for it in 53.
    void addProduct(Real a, Real b) {
        exact = exact && (sizeof(Real) > sizeof(double) || a == 0 || b == 0);
        add(a * b);
    }
    [[nodiscard]] Real error() const { return exact ? Real(0) : kRounding<Real> * magnitude; }
};

template <class Real> struct Vertex {
    Place<Real> at{};
    Real error = 0; ///< voxels, along each axis
    /// Of each face of the domain, [2 * axis + end]: certainly inside of it or in it, in it, beyond it.
    std::array<bool, 6> inside{};
    std::array<bool, 6> on{};
    std::array<bool, 6> beyond{};

    void compare(std::size_t face, Real distance, Real uncertain) {
        inside[face] = distance > uncertain || (uncertain == 0 && distance == 0);
        on[face] = uncertain == 0 && distance == 0;
        beyond[face] = -distance > uncertain;
    }
};

/// A point of world space as sums of products of what the pair was given in.
template <class Real>
std::array<Sum<Real>, 3> worldOf(const Mat4& world_from_object, const std::array<float, 3>& vertex,
                                 const Vec3& origin) {
    std::array<Sum<Real>, 3> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 3; ++k) {
            out[axis].addProduct(Real(world_from_object[4 * k + axis]), Real(vertex[k]));
        }
        out[axis].add(Real(world_from_object[12 + axis]));
        out[axis].add(-Real(origin[axis]));
    }
    return out;
}

/// Where an axis of the grid is one of the world's: that one. 3 where it is not.
std::size_t alongWorld(const Grid& grid, std::size_t column) {
    std::size_t out = 3;
    for (std::size_t row = 0; row < 3; ++row) {
        const double element = grid.direction[3 * column + row];
        if (element == 1 || element == -1) {
            out = row;
        } else if (element != 0) {
            return 3;
        }
    }
    return out;
}

template <class Real>
void placeAligned(const Grid& grid, const std::array<Sum<Real>, 3>& world, std::size_t axis, std::size_t along,
                  Vertex<Real>& vertex) {
    const bool flipped = grid.direction[3 * axis + along] < 0;
    const Real spacing = Real(grid.spacing[axis]);
    Sum<Real> near = world[along];
    near.value = flipped ? -near.value : near.value;
    near.add(spacing / 2);
    Sum<Real> far = near;
    far.value = -near.value;
    far.addProduct(spacing, Real(grid.size[axis]));
    vertex.compare(2 * axis, near.value, near.error());
    vertex.compare(2 * axis + 1, far.value, far.error());
    vertex.at[axis] = near.value / spacing - Real(0.5);
    const Real error = near.error() / spacing + kRounding<Real> * (size(vertex.at[axis]) + 1);
    vertex.error = std::max(vertex.error, error);
}

/// Cramer's rule.
template <class Real>
void placeOblique(const Grid& grid, const std::array<Sum<Real>, 3>& world, std::size_t axis, Vertex<Real>& vertex) {
    const auto element = [&](std::size_t column, std::size_t row) {
        return Real(grid.direction[3 * (column % 3) + row % 3]) * Real(grid.spacing[column % 3]);
    };
    Real sum = 0;
    Real terms = 0;
    Real determinant = 0;
    Real determinantTerms = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        const Real a = element(axis + 1, row + 1) * element(axis + 2, row + 2);
        const Real b = element(axis + 1, row + 2) * element(axis + 2, row + 1);
        sum += (a - b) * world[row].value;
        terms += (size(a) + size(b)) * world[row].magnitude;
        determinant += (a - b) * element(axis, row);
        determinantTerms += (size(a) + size(b)) * size(element(axis, row));
    }
    vertex.at[axis] = sum / determinant;
    const Real error = kRounding<Real> * ((terms + size(vertex.at[axis]) * determinantTerms) / size(determinant) + 1);
    vertex.compare(2 * axis, vertex.at[axis] + Real(0.5), error);
    vertex.compare(2 * axis + 1, Real(grid.size[axis]) - Real(0.5) - vertex.at[axis], error);
    vertex.error = std::max(vertex.error, error);
}

template <class Real>
Vertex<Real> placed(const Grid& grid, const Mat4& world_from_object, const std::array<float, 3>& vertex) {
    const std::array<Sum<Real>, 3> world = worldOf<Real>(world_from_object, vertex, grid.origin);
    bool aligned = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        aligned = aligned && alongWorld(grid, axis) < 3;
    }
    Vertex<Real> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (aligned) {
            placeAligned(grid, world, axis, alongWorld(grid, axis), out);
        } else {
            placeOblique(grid, world, axis, out);
        }
    }
    return out;
}

template <class Real> using Triangle = std::array<Vertex<Real>, 3>;

/// A triangle that meets the half-space of a face in an edge or a corner alone is that edge or corner.
template <class Real> void fold(Triangle<Real>& triangle, std::size_t face) {
    const Vertex<Real>* on = nullptr;
    for (const Vertex<Real>& vertex : triangle) {
        if (!vertex.on[face] && !vertex.beyond[face]) {
            return;
        }
        on = vertex.on[face] ? &vertex : on;
    }
    if (on == nullptr) {
        return;
    }
    const Vertex<Real> kept = *on;
    for (Vertex<Real>& vertex : triangle) {
        vertex = vertex.on[face] ? vertex : kept;
    }
}

/// What is opaque by the table.
class Opaque {
  public:
    Opaque(std::span<const float> table, float threshold) : table_(table), threshold_(threshold), before_{0} {
        for (const float entry : table) {
            before_.push_back(before_.back() + (entry >= threshold ? 1 : 0));
        }
    }

    /// Whether some of the coordinates between may be opaque; of the table's, entry i being at i.
    template <class Real> [[nodiscard]] bool may(Real lo, Real hi) const {
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        if (among(below(from), above(to)) == 0) {
            return false;
        }
        return some(from, to) || at(from) >= Real(threshold_) - kTable<Real> ||
               at(to) >= Real(threshold_) - kTable<Real>;
    }
    template <class Real> [[nodiscard]] bool allOf(Real lo, Real hi) const {
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        const std::int64_t first = below(from);
        const std::int64_t last = above(to);
        if (among(first, last) == last - first + 1) {
            return true;
        }
        const std::int64_t inner = above(from);
        const std::int64_t outer = below(to);
        return (inner > outer || among(inner, outer) == outer - inner + 1) && surely(from) && surely(to);
    }
    template <class Real> [[nodiscard]] bool someOf(Real lo, Real hi) const {
        if (!(lo <= hi)) {
            return false;
        }
        const Real from = clamped(lo);
        const Real to = clamped(hi);
        return some(from, to) || surely(from) || surely(to);
    }

  private:
    template <class Real> static constexpr Real kTable = 8 * kRounding<Real>;

    template <class Real> [[nodiscard]] Real clamped(Real x) const {
        const Real last = Real(static_cast<double>(table_.size() - 1));
        return x > 0 ? (x < last ? x : last) : Real(0);
    }
    template <class Real> [[nodiscard]] static std::int64_t below(Real x) { return static_cast<std::int64_t>(x); }
    template <class Real> [[nodiscard]] static std::int64_t above(Real x) {
        const std::int64_t cut = below(x);
        return Real(static_cast<double>(cut)) < x ? cut + 1 : cut;
    }
    /// Opaque entries from `first` to `last`.
    [[nodiscard]] std::int64_t among(std::int64_t first, std::int64_t last) const {
        return before_[static_cast<std::size_t>(last + 1)] - before_[static_cast<std::size_t>(first)];
    }
    template <class Real> [[nodiscard]] bool some(Real from, Real to) const {
        return above(from) <= below(to) && among(above(from), below(to)) > 0;
    }
    template <class Real> [[nodiscard]] Real at(Real x) const {
        const auto first = static_cast<std::size_t>(below(x));
        const auto second = static_cast<std::size_t>(above(x));
        const Real a = Real(table_[first]);
        return a + (x - Real(static_cast<double>(first))) * (Real(table_[second]) - a);
    }
    template <class Real> [[nodiscard]] bool surely(Real x) const {
        const std::int64_t first = below(x);
        const std::int64_t last = above(x);
        return among(first, last) == last - first + 1 || at(x) >= Real(threshold_) + kTable<Real>;
    }

    std::span<const float> table_;
    float threshold_;
    std::vector<std::int64_t> before_;
};

double voxelAt(const VolumeView& volume, const std::array<std::int64_t, 3>& at) {
    std::size_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        const std::int64_t last = std::int64_t{volume.grid.size[axis]} - 1;
        index = index * volume.grid.size[axis] + static_cast<std::size_t>(std::clamp<std::int64_t>(at[axis], 0, last));
    }
    const auto load = [&](auto scalar) {
        std::memcpy(&scalar, volume.voxels.data() + index * sizeof scalar, sizeof scalar);
        return static_cast<double>(scalar);
    };
    switch (volume.type) {
    case ScalarType::UInt8:
        return load(std::uint8_t{});
    case ScalarType::Int16:
        return load(std::int16_t{});
    case ScalarType::UInt16:
        return load(std::uint16_t{});
    case ScalarType::Float32:
        break;
    }
    return load(float{});
}

/// The coordinates of the table that a piece has, and how far they may be off.
template <class Real> struct Range {
    std::array<Real, 3> atCorner;
    Real lo;
    Real hi;
    Real error;
};

/// The interpolant of a cell, in coordinates of the table.
template <class Real> class Cell {
  public:
    Cell(const JudgedPair& pair, const std::array<std::int64_t, 3>& cell) : cell_(cell) {
        const Real lo = Real(pair.domain.lo);
        const Real scale = Real(static_cast<double>(pair.table.size())) / (Real(pair.domain.hi) - lo);
        Real least = 0;
        Real most = 0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Real value = Real(
                voxelAt(pair.volume, {cell[0] + std::int64_t(corner & 1U), cell[1] + std::int64_t(corner >> 1U & 1U),
                                      cell[2] + std::int64_t(corner >> 2U & 1U)}));
            value_[corner] = (value - lo) * scale - Real(0.5);
            least = corner == 0 ? value_[corner] : std::min(least, value_[corner]);
            most = corner == 0 ? value_[corner] : std::max(most, value_[corner]);
            error_ = std::max(error_, 8 * kRounding<Real> * ((size(value) + size(lo)) * scale + 1));
        }
        range_ = most - least;
    }

    [[nodiscard]] Real range() const { return range_; }

    /// Of a piece whose points may be displaced by `displaced` voxels along each axis.
    [[nodiscard]] Range<Real> over(const std::array<Place<Real>, 3>& piece, Real displaced) const {
        Place<Real> middle{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            middle[axis] = (piece[0][axis] + piece[1][axis] + piece[2][axis]) / 3;
        }
        const Polynomial about(value_, middle, cell_);
        Range<Real> out{};
        Place<Real> reach{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            Place<Real> step{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                step[axis] = piece[corner][axis] - middle[axis];
                reach[axis] = std::max(reach[axis], size(step[axis]));
            }
            const Real flat = about.flat(step);
            out.atCorner[corner] = flat + about.bend(step);
            out.lo = corner == 0 ? flat : std::min(out.lo, flat);
            out.hi = corner == 0 ? flat : std::max(out.hi, flat);
        }
        const Real bend = about.mostBend(reach);
        out.lo -= bend;
        out.hi += bend;
        out.error = error_ + 8 * range_ * displaced;
        return out;
    }

  private:
    /// The interpolant about a point: it ends with the third order.
    struct Polynomial {
        Polynomial(const std::array<Real, 8>& value, const Place<Real>& at, const std::array<std::int64_t, 3>& cell) {
            std::array<Real, 8> c = value;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Real t = at[axis] - Real(static_cast<double>(cell[axis]));
                for (std::size_t i = 0; i < 8; ++i) {
                    const std::size_t bit = std::size_t{1} << axis;
                    if ((i & bit) == 0) {
                        const Real slope = c[i | bit] - c[i];
                        c[i] += t * slope;
                        c[i | bit] = slope;
                    }
                }
            }
            coefficient = c;
        }
        [[nodiscard]] Real flat(const Place<Real>& step) const {
            return coefficient[0] + coefficient[1] * step[0] + coefficient[2] * step[1] + coefficient[4] * step[2];
        }
        [[nodiscard]] Real bend(const Place<Real>& step) const {
            return coefficient[3] * step[0] * step[1] + coefficient[5] * step[0] * step[2] +
                   coefficient[6] * step[1] * step[2] + coefficient[7] * step[0] * step[1] * step[2];
        }
        [[nodiscard]] Real mostBend(const Place<Real>& reach) const {
            return size(coefficient[3]) * reach[0] * reach[1] + size(coefficient[5]) * reach[0] * reach[2] +
                   size(coefficient[6]) * reach[1] * reach[2] + size(coefficient[7]) * reach[0] * reach[1] * reach[2];
        }
        std::array<Real, 8> coefficient{}; ///< of the product of the steps along the axes whose bits are set
    };

    std::array<std::int64_t, 3> cell_;
    std::array<Real, 8> value_{};
    Real range_ = 0;
    Real error_ = 0;
};

template <class Real> using Polygon = std::vector<Place<Real>>;

template <class Real> Polygon<Real> cut(const Polygon<Real>& polygon, std::size_t axis, Real limit, bool above) {
    Polygon<Real> out;
    const auto distance = [&](const Place<Real>& at) { return above ? at[axis] - limit : limit - at[axis]; };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Place<Real>& here = polygon[i];
        const Place<Real>& next = polygon[(i + 1) % polygon.size()];
        const Real a = distance(here);
        const Real b = distance(next);
        if (a >= 0) {
            out.push_back(here);
        }
        if ((a >= 0) != (b >= 0)) {
            const Real weight = a / (a - b);
            Place<Real> at{};
            for (std::size_t k = 0; k < 3; ++k) {
                at[k] = here[k] + weight * (next[k] - here[k]);
            }
            out.push_back(at);
        }
    }
    return out;
}

/// A triangle against the whole volume.
template <class Real> class Search {
  public:
    Search(const JudgedPair& pair, const Opaque& opaque, Triangle<Real> triangle) : pair_(pair), opaque_(opaque) {
        for (std::size_t face = 0; face < 6; ++face) {
            outside_ = outside_ || (triangle[0].beyond[face] && triangle[1].beyond[face] && triangle[2].beyond[face]);
            fold(triangle, face);
            outside_ = outside_ || (triangle[0].beyond[face] && triangle[1].beyond[face] && triangle[2].beyond[face]);
        }
        Real far = 2;
        Real error = 0;
        for (const Vertex<Real>& vertex : triangle) {
            corners_.push_back(vertex.at);
            error = std::max(error, vertex.error);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                far = std::max(far, size(vertex.at[axis]));
            }
        }
        for (std::size_t face = 0; face < 6; ++face) {
            inside_[face] = triangle[0].inside[face] && triangle[1].inside[face] && triangle[2].inside[face];
        }
        displaced_ = 16 * (error + kRounding<Real> * (far + 1));
    }

    Judgement run() {
        if (outside_) {
            return Judgement::None;
        }
        if (!(displaced_ < Real(0x1p-10))) {
            return Judgement::Undecidable;
        }
        std::array<std::int64_t, 3> first{};
        std::array<std::int64_t, 3> last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t most = std::int64_t{pair_.volume.grid.size[axis]} - 1;
            const auto [lo, hi] = extent(axis);
            const Real end = Real(static_cast<double>(most)) + 1;
            first[axis] = lo - displaced_ < end
                              ? std::max<std::int64_t>(floorOf(std::max(lo - displaced_, Real(-1))), -1)
                              : most + 1;
            last[axis] = hi + displaced_ > Real(-1) ? std::min(floorOf(std::min(hi + displaced_, end)), most) : -2;
        }
        bool open = false;
        std::array<std::int64_t, 3> cell{};
        for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
                for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                    const Judgement here = inCell(cell);
                    if (here == Judgement::Touches) {
                        return here;
                    }
                    open = open || here == Judgement::Undecidable;
                }
            }
        }
        return open ? Judgement::Undecidable : Judgement::None;
    }

  private:
    using Piece = std::array<Place<Real>, 3>;
    /// Of points that are certainly in the domain.
    struct Seen {
        bool some = false;
        Real lo = 0;
        Real hi = 0;
    };

    [[nodiscard]] static std::int64_t floorOf(Real value) {
        const auto cut = static_cast<std::int64_t>(value);
        return Real(static_cast<double>(cut)) > value ? cut - 1 : cut;
    }
    [[nodiscard]] std::pair<Real, Real> extent(std::size_t axis) const {
        const auto [lo, hi] = std::minmax({corners_[0][axis], corners_[1][axis], corners_[2][axis]});
        return {lo, hi};
    }

    /// Whether the point of the triangle that this one stands for is in the domain.
    [[nodiscard]] bool inDomain(const Place<Real>& at) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Real end = Real(static_cast<double>(pair_.volume.grid.size[axis])) - Real(0.5);
            if ((!inside_[2 * axis] && !(at[axis] - displaced_ >= Real(-0.5))) ||
                (!inside_[2 * axis + 1] && !(at[axis] + displaced_ <= end))) {
                return false;
            }
        }
        return true;
    }

    Judgement inCell(const std::array<std::int64_t, 3>& number) const {
        Polygon<Real> polygon = corners_;
        for (std::size_t axis = 0; axis < 3 && polygon.size() >= 3; ++axis) {
            const Real at = Real(static_cast<double>(number[axis]));
            const Real end = Real(static_cast<double>(pair_.volume.grid.size[axis])) - Real(0.5);
            polygon = cut(polygon, axis, std::max(at, Real(-0.5)) - displaced_, true);
            polygon = cut(polygon, axis, std::min(at + 1, end) + displaced_, false);
        }
        if (polygon.size() < 3) {
            return Judgement::None;
        }
        const Cell<Real> cell(pair_, number);
        std::vector<Piece> waiting;
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
            waiting.push_back({polygon[0], polygon[i], polygon[i + 1]});
        }
        Seen seen;
        bool open = false;
        for (int pieces = 0; !waiting.empty(); ++pieces) {
            if (pieces == kMostPieces<Real>) {
                return Judgement::Undecidable;
            }
            const Piece piece = waiting.back();
            waiting.pop_back();
            const Range<Real> range = cell.over(piece, displaced_);
            if (!opaque_.may(range.lo - range.error, range.hi + range.error)) {
                continue;
            }
            if (proves(piece, range, seen)) {
                return Judgement::Touches;
            }
            if (!halve(piece, range, waiting)) {
                open = true;
            }
        }
        return open ? Judgement::Undecidable : Judgement::None;
    }

    bool proves(const Piece& piece, const Range<Real>& range, Seen& seen) const {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            if (!inDomain(piece[corner])) {
                continue;
            }
            const Real value = range.atCorner[corner];
            if (opaque_.allOf(value - range.error, value + range.error)) {
                return true;
            }
            seen.lo = seen.some ? std::min(seen.lo, value) : value;
            seen.hi = seen.some ? std::max(seen.hi, value) : value;
            seen.some = true;
        }
        return seen.some && opaque_.someOf(seen.lo + range.error, seen.hi - range.error);
    }

    /// False where that would be of no use.
    bool halve(const Piece& piece, const Range<Real>& range, std::vector<Piece>& waiting) const {
        std::size_t longest = 0;
        Real most = -1;
        for (std::size_t edge = 0; edge < 3; ++edge) {
            Real length = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                length = std::max(length, size(piece[(edge + 1) % 3][axis] - piece[edge][axis]));
            }
            if (length > most) {
                most = length;
                longest = edge;
            }
        }
        if (!(most > Real(kSmallest<Real>)) || !(range.hi - range.lo > range.error)) {
            return false;
        }
        Place<Real> middle{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            middle[axis] = (piece[longest][axis] + piece[(longest + 1) % 3][axis]) / 2;
        }
        waiting.push_back({piece[longest], middle, piece[(longest + 2) % 3]});
        waiting.push_back({middle, piece[(longest + 1) % 3], piece[(longest + 2) % 3]});
        return true;
    }

    const JudgedPair& pair_;
    const Opaque& opaque_;
    Polygon<Real> corners_;
    std::array<bool, 6> inside_{};
    bool outside_ = false;
    Real displaced_ = 0;
};

template <class Real>
Judgement judgeTriangle(const JudgedPair& pair, const Opaque& opaque, const std::array<std::array<float, 3>, 3>& at) {
    Triangle<Real> triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        triangle[corner] = placed<Real>(pair.volume.grid, pair.world_from_object, at[corner]);
    }
    return Search<Real>(pair, opaque, triangle).run();
}

} // namespace

const char* toString(Judgement judgement) noexcept {
    switch (judgement) {
    case Judgement::None:
        return "none";
    case Judgement::Touches:
        return "touches";
    case Judgement::Undecidable:
        break;
    }
    return "undecidable";
}

Judgement judge(const JudgedPair& pair) {
    const Opaque opaque(pair.table, pair.threshold);
    std::vector<std::array<std::array<float, 3>, 3>> open;
    for (std::size_t triangle = 0; triangle < pair.mesh.indices.size() / 3; ++triangle) {
        std::array<std::array<float, 3>, 3> at{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t vertex = pair.mesh.indices[3 * triangle + corner];
            std::copy_n(pair.mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * vertex), 3, at[corner].begin());
        }
        const Judgement rough = judgeTriangle<double>(pair, opaque, at);
        if (rough == Judgement::Touches) {
            return rough;
        }
        if (rough == Judgement::Undecidable) {
            open.push_back(at);
        }
    }
    bool undecidable = false;
    for (const auto& at : open) {
        const Judgement fine = judgeTriangle<Quad>(pair, opaque, at);
        if (fine == Judgement::Touches) {
            return fine;
        }
        undecidable = undecidable || fine == Judgement::Undecidable;
    }
    return undecidable ? Judgement::Undecidable : Judgement::None;
}

} // namespace voxtact::test
