// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "samples/edge_split.h"
#include "samples/loft.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxtact {

namespace {

// A number 3 handle with a number 10 blade, in millimetres along z from the tip.
constexpr double kBelly = 24;  // the curved part of the cutting edge ends
constexpr double kSpine = 30;  // the back of the blade becomes straight
constexpr double kHeel = 34;   // the rear cut of the blade begins
constexpr double kSocket = 38; // the blade ends in the neck of the handle
constexpr double kNeck = 39;
constexpr double kShoulder = 46;
constexpr double kGrip = 58;
constexpr double kRidges = 61;
constexpr double kRidgesEnd = 83;
constexpr double kWaist = 100;
constexpr double kTail = 132;
constexpr double kButt = 150;
constexpr double kButtRadius = 3;
constexpr double kAxisY = -3; // the handle's middle; the tip lies higher, near the back of the blade

constexpr double kBladeHalfThickness = 0.2;
constexpr double kBevel = 1.4;
constexpr double kHeelBevel = 0.15; // where the blade ends: nearly the neck's chamfer
constexpr int kRidgeCount = 8;
constexpr double kRidgeDepth = 0.25;
constexpr double kArea = 3600; // mm^2, about

struct Key {
    double z;
    double value;
};

template <std::size_t N> double interpolate(const std::array<Key, N>& keys, double z) {
    for (std::size_t i = 1; i < N; ++i) {
        if (z <= keys[i].z) {
            const double t = std::max(0.0, (z - keys[i - 1].z) / (keys[i].z - keys[i - 1].z));
            return keys[i - 1].value + (keys[i].value - keys[i - 1].value) * (t * t * (3 - 2 * t));
        }
    }
    return keys.back().value;
}

double handleHalfWidth(double z) {
    constexpr std::array<Key, 5> kKeys{{{kShoulder, 2.3}, {kGrip, 4.6}, {kRidgesEnd, 4.4}, {kWaist, 3.6}, {kTail, 5}}};
    const double alongButt = std::max(0.0, z - (kButt - kButtRadius));
    return interpolate(kKeys, z) -
           (kButtRadius - std::sqrt(std::max(0.0, kButtRadius * kButtRadius - alongButt * alongButt)));
}

double alongHeel(double z) {
    return std::max(0.0, z - kHeel) / (kSocket - kHeel);
}

double cuttingEdge(double z) {
    const double left = 1 - std::min(z, kBelly) / kBelly;
    return -7 * (1 - left * left * left) + 1.8 * alongHeel(z);
}

double spine(double z) {
    const double left = 1 - std::min(z, kSpine) / kSpine;
    const double rear = std::max(0.0, z - (kSocket - 1));
    return 1 - left * left - 1.6 * rear;
}

/// The outline of the cross section at z: y from `low` to `high`, x within +-`halfThickness`.
struct Section {
    bool blade = false;
    double low = 0;
    double high = 0;
    double halfThickness = 0;
    double chamfer = 0; ///< of the handle's four edges; of the blade, the height of the bevel
};

double ridgeDepth(double z, bool ridged) {
    if (!ridged || z <= kRidges || z >= kRidgesEnd) {
        return 0;
    }
    const double period = (z - kRidges) / (kRidgesEnd - kRidges) * kRidgeCount;
    const double phase = period - std::floor(period);
    return kRidgeDepth * (1 - std::abs(2 * phase - 1));
}

Section sectionAt(double z, bool ridged) {
    constexpr std::array<Key, 4> kHalfThickness{
        {{kSocket, kBladeHalfThickness}, {kNeck, 0.9}, {kShoulder, 1}, {kGrip, 1.5}}};
    constexpr std::array<Key, 4> kChamfer{{{kSocket, 0.1}, {kNeck, 0.35}, {kShoulder, 0.4}, {kGrip, 0.6}}};
    Section section;
    section.blade = z <= kSocket;
    if (section.blade) {
        section.low = cuttingEdge(z);
        section.high = spine(z);
        const double width = section.high - section.low;
        section.halfThickness = kBladeHalfThickness * std::min(1.0, width / 2);
        section.chamfer = std::min(kBevel + (kHeelBevel - kBevel) * alongHeel(z), 0.45 * width);
        return section;
    }
    const double halfWidth = handleHalfWidth(z);
    section.low = kAxisY - halfWidth;
    section.high = kAxisY + halfWidth;
    section.halfThickness = interpolate(kHalfThickness, z) - ridgeDepth(z, ridged);
    section.chamfer = interpolate(kChamfer, z);
    return section;
}

/// The corners of a section's outline. Turns are shared by all kinds of section, so that loft() joins like to like.
Ring sectionCorners(const Section& s, double z, bool chamfered) {
    const double x = s.halfThickness;
    const double c = s.chamfer;
    if (s.blade) {
        return {{{x, s.low + c, z}, 0},
                {{x, s.high, z}, 0.32},
                {{-x, s.high, z}, 0.44},
                {{-x, s.low + c, z}, 0.76},
                {{0, s.low, z}, 0.88}};
    }
    if (!chamfered) {
        return {{{x, s.low, z}, 0}, {{x, s.high, z}, 0.32}, {{-x, s.high, z}, 0.44}, {{-x, s.low, z}, 0.76}};
    }
    return {{{x, s.low + c, z}, 0},     {{x, s.high - c, z}, 0.30},  {{x - c, s.high, z}, 0.34},
            {{c - x, s.high, z}, 0.42}, {{-x, s.high - c, z}, 0.46}, {{-x, s.low + c, z}, 0.76},
            {{c - x, s.low, z}, 0.80},  {{x - c, s.low, z}, 0.96}};
}

std::uint32_t parts(double length, double edge) {
    return static_cast<std::uint32_t>(std::max(1.0, std::floor(length / edge + 0.5)));
}

/// A scalpel whose edges are about `edge` long. Details finer than that are left out.
class ScalpelRings {
  public:
    explicit ScalpelRings(double edge) : edge_(edge), ridged_(edge < 2.2), chamfered_(edge < 3) { placeStations(); }

    std::uint64_t triangles() const {
        std::uint64_t segments = 0;
        forEachOutline([&](const Ring& corners) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                segments += segmentParts(corners, i);
            }
        });
        return 2 * segments;
    }

    std::vector<Ring> rings() const {
        std::vector<Ring> rings{{{{0, 0, 0}, 0}}};
        forEachOutline([&](const Ring& corners) { rings.push_back(refined(corners)); });
        rings.push_back({{{0, kAxisY, kButt}, 0}});
        return rings;
    }

  private:
    void placeStations() {
        std::vector<double> keys{0, kBelly, kHeel, kSocket, kNeck, kShoulder, kGrip};
        if (ridged_) {
            for (int i = 0; i <= 2 * kRidgeCount; ++i) {
                keys.push_back(kRidges + (kRidgesEnd - kRidges) * i / (2 * kRidgeCount));
            }
        }
        keys.insert(keys.end(), {kWaist, kTail, kButt - kButtRadius, kButt});
        for (std::size_t i = 1; i < keys.size(); ++i) {
            placeBetween(keys[i - 1], keys[i]);
        }
    }

    /// Equal steps along the outline, not along z: the belly and the butt are steep.
    void placeBetween(double begin, double end) {
        constexpr std::size_t kSamples = 64;
        std::array<double, kSamples + 1> travelled{};
        const auto zAt = [&](double sample) { return begin + (end - begin) * sample / kSamples; };
        Section before = sectionAt(begin, false);
        for (std::size_t i = 1; i <= kSamples; ++i) {
            const Section here = sectionAt(zAt(static_cast<double>(i)), false);
            const double dz = (end - begin) / kSamples;
            const double dy = std::max(std::abs(here.low - before.low), std::abs(here.high - before.high));
            travelled[i] = travelled[i - 1] + std::sqrt(dz * dz + dy * dy);
            before = here;
        }
        const std::uint32_t count = parts(travelled[kSamples], edge_);
        std::size_t sample = 0;
        for (std::uint32_t k = 1; k < count; ++k) {
            const double goal = travelled[kSamples] * k / count;
            while (travelled[sample + 1] < goal) {
                ++sample;
            }
            const double rest = (goal - travelled[sample]) / (travelled[sample + 1] - travelled[sample]);
            stations_.push_back(zAt(static_cast<double>(sample) + rest));
        }
        stations_.push_back(end);
    }

    template <class Visit> void forEachOutline(Visit&& visit) const {
        for (const double z : stations_) {
            visit(sectionCorners(sectionAt(z, ridged_), z, chamfered_));
        }
        // The flat end of the handle: smaller and smaller copies of its outline, so that no fan of needles closes it.
        Section end = sectionAt(kButt, ridged_);
        const Section outer = end;
        const std::uint32_t count = parts((outer.high - outer.low) / 2, edge_);
        for (std::uint32_t k = count - 1; k > 0; --k) {
            const double scale = static_cast<double>(k) / count;
            end.low = kAxisY + (outer.low - kAxisY) * scale;
            end.high = kAxisY + (outer.high - kAxisY) * scale;
            end.halfThickness = outer.halfThickness * scale;
            end.chamfer = outer.chamfer * scale;
            visit(sectionCorners(end, kButt, chamfered_));
        }
    }

    std::uint32_t segmentParts(const Ring& corners, std::size_t i) const {
        const Vec3& a = corners[i].position;
        const Vec3& b = corners[(i + 1) % corners.size()].position;
        return parts(std::sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])), edge_);
    }

    Ring refined(const Ring& corners) const {
        Ring ring;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3& a = corners[i].position;
            const Vec3& b = corners[(i + 1) % corners.size()].position;
            const double turns = (i + 1 < corners.size() ? corners[i + 1].turn : 1.0) - corners[i].turn;
            const std::uint32_t count = segmentParts(corners, i);
            for (std::uint32_t k = 0; k < count; ++k) {
                const double t = static_cast<double>(k) / count;
                ring.push_back(
                    {{a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2]}, corners[i].turn + turns * t});
            }
        }
        return ring;
    }

    double edge_;
    bool ridged_;
    bool chamfered_;
    std::vector<double> stations_;
};

} // namespace

Result<MeshData> makeScalpel(std::uint32_t triangles) {
    return guard([&]() -> Result<MeshData> {
        const auto minimum = static_cast<std::uint32_t>(ScalpelRings(2 * kButt).triangles());
        VOXTACT_TRY(checkTriangleCount("a scalpel", triangles, minimum));
        // 0.5: well below the edge of equilateral triangles (1.52 sqrt(area/number)), so the first try is too fine.
        double edge = 0.5 * std::sqrt(kArea / triangles);
        while (ScalpelRings(edge).triangles() > triangles) {
            edge *= 1.01;
        }
        Surface surface = loft(ScalpelRings(edge).rings());
        splitLongestEdges(surface, triangles, [](const Vec3& middle) { return middle; });
        return toMesh(std::move(surface), "scalpel");
    });
}

} // namespace voxtact
