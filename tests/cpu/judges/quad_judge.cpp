// SPDX-License-Identifier: MIT
#include "cpu/judges/quad_judge.h"

#include "cpu/judges/quad_cell.h"
#include "cpu/judges/quad_opacity.h"

#include <utility>

namespace voxtact::test {

namespace quad {

namespace {

/// Voxels: pieces are not halved beyond it. And how many are examined in a cell.
template <class Real> constexpr double kSmallest = 0x1p-14;
template <> constexpr double kSmallest<Quad> = 0x1p-44;
template <class Real> constexpr int kMostPieces = 300;
template <> constexpr int kMostPieces<Quad> = 3000;

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

} // namespace quad

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
    const quad::Opaque opaque(pair.points, pair.threshold);
    std::vector<std::array<std::array<float, 3>, 3>> open;
    for (std::size_t triangle = 0; triangle < pair.mesh.indices.size() / 3; ++triangle) {
        std::array<std::array<float, 3>, 3> at{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t vertex = pair.mesh.indices[3 * triangle + corner];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                at[corner][axis] = static_cast<float>(pair.mesh.positions[3 * vertex + axis]);
            }
        }
        const Judgement rough = quad::judgeTriangle<double>(pair, opaque, at);
        if (rough == Judgement::Touches) {
            return rough;
        }
        if (rough == Judgement::Undecidable) {
            open.push_back(at);
        }
    }
    bool undecidable = false;
    for (const auto& at : open) {
        const Judgement fine = quad::judgeTriangle<quad::Quad>(pair, opaque, at);
        if (fine == Judgement::Touches) {
            return fine;
        }
        undecidable = undecidable || fine == Judgement::Undecidable;
    }
    return undecidable ? Judgement::Undecidable : Judgement::None;
}

} // namespace voxtact::test
