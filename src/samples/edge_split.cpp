// SPDX-License-Identifier: MIT
#include "samples/edge_split.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace voxtact {

namespace {

/// Half edge 3t+k runs from corner k of triangle t to the next one.
std::uint32_t nextInTriangle(std::uint32_t half) {
    return half % 3 == 2 ? half - 2 : half + 1;
}

struct Candidate {
    double squaredLength;
    std::uint32_t from;
    std::uint32_t to;
    std::uint32_t half;

    bool operator<(const Candidate& other) const {
        return std::tie(squaredLength, from, to) < std::tie(other.squaredLength, other.from, other.to);
    }
};

class Splitter {
  public:
    explicit Splitter(Surface& surface) : surface_(surface) {
        pairHalves();
        std::vector<Candidate> candidates;
        candidates.reserve(surface_.corners.size() / 2);
        for (std::uint32_t half = 0; half < surface_.corners.size(); ++half) {
            if (from(half) < to(half)) {
                candidates.push_back(candidate(half));
            }
        }
        queue_ = Queue({}, std::move(candidates));
    }

    void splitLongest(const PlaceMiddle& place) {
        while (stale(queue_.top())) {
            queue_.pop();
        }
        const Candidate longest = queue_.top();
        queue_.pop();
        const Vec3& a = surface_.points[longest.from];
        const Vec3& b = surface_.points[longest.to];
        const Vec3 middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
        split(longest.half, place(middle));
    }

  private:
    using Queue = std::priority_queue<Candidate>;

    std::uint32_t from(std::uint32_t half) const { return surface_.corners[half]; }
    std::uint32_t to(std::uint32_t half) const { return surface_.corners[nextInTriangle(half)]; }
    bool stale(const Candidate& c) const { return from(c.half) != c.from || to(c.half) != c.to; }

    Candidate candidate(std::uint32_t half) const {
        // Always measured and named from the smaller vertex: the order must not depend on which half is asked.
        const std::uint32_t named = from(half) < to(half) ? half : twins_[half];
        const Vec3& a = surface_.points[from(named)];
        const Vec3& b = surface_.points[to(named)];
        const double x = b[0] - a[0];
        const double y = b[1] - a[1];
        const double z = b[2] - a[2];
        return {x * x + y * y + z * z, from(named), to(named), named};
    }

    void pairHalves() {
        const std::vector<std::uint32_t>& corners = surface_.corners;
        std::vector<std::uint32_t> begin(surface_.points.size() + 1, 0);
        for (const std::uint32_t corner : corners) {
            ++begin[corner + 1];
        }
        for (std::size_t i = 1; i < begin.size(); ++i) {
            begin[i] += begin[i - 1];
        }
        std::vector<std::uint32_t> outgoing(corners.size());
        std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
        for (std::uint32_t half = 0; half < corners.size(); ++half) {
            outgoing[fill[corners[half]]++] = half;
        }
        twins_.resize(corners.size());
        for (std::uint32_t half = 0; half < corners.size(); ++half) {
            const auto first = outgoing.begin() + begin[to(half)];
            const auto last = outgoing.begin() + begin[to(half) + 1];
            twins_[half] = *std::find_if(first, last, [&](std::uint32_t other) { return to(other) == from(half); });
        }
    }

    void pair(std::uint32_t half, std::uint32_t twin) {
        twins_[half] = twin;
        twins_[twin] = half;
    }

    /// Cuts the triangle of `half` from the new vertex to the corner opposite. The triangle keeps the first part of the
    /// edge; the new triangle, whose number is returned, gets the second as its first edge.
    std::uint32_t cutTriangle(std::uint32_t half, std::uint32_t vertex) {
        std::vector<std::uint32_t>& corners = surface_.corners;
        const std::uint32_t next = nextInTriangle(half);
        const std::uint32_t opposite = corners[nextInTriangle(next)];
        const std::uint32_t outer = twins_[next];
        const auto fresh = static_cast<std::uint32_t>(corners.size());
        corners.insert(corners.end(), {vertex, corners[next], opposite});
        corners[next] = vertex;
        twins_.resize(corners.size());
        pair(fresh + 1, outer);
        pair(fresh + 2, next);
        return fresh;
    }

    void split(std::uint32_t half, const Vec3& position) {
        const auto vertex = static_cast<std::uint32_t>(surface_.points.size());
        surface_.points.push_back(position);
        const std::uint32_t twin = twins_[half];
        const std::uint32_t fresh = cutTriangle(half, vertex);
        const std::uint32_t freshTwin = cutTriangle(twin, vertex);
        pair(half, freshTwin);
        pair(twin, fresh);
        // The outer edge of a new triangle has a new index, so queued entries may be stale.
        for (const std::uint32_t changed : {half, twin, fresh + 1, fresh + 2, freshTwin + 1, freshTwin + 2}) {
            queue_.push(candidate(changed));
        }
    }

    Surface& surface_;
    std::vector<std::uint32_t> twins_;
    Queue queue_;
};

} // namespace

void splitLongestEdges(Surface& surface, std::uint32_t triangles, const PlaceMiddle& place) {
    const std::size_t wanted = std::size_t{3} * triangles;
    if (surface.corners.size() >= wanted) {
        return;
    }
    Splitter splitter(surface);
    while (surface.corners.size() < wanted) {
        splitter.splitLongest(place);
    }
}

} // namespace voxtact
