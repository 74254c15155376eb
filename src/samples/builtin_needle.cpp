// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "samples/loft.h"
#include "voxtact/samples.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace voxtact {

namespace {

constexpr std::size_t kQuarter = 8; ///< steps of a quarter of a circle

struct Turn {
    double cosine = 1;
    double sine = 0;
};

Turn sum(const Turn& a, const Turn& b) {
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
}

/// 0 to a quarter of a turn, by square roots alone: the same on every machine.
std::array<Turn, kQuarter + 1> quarterTurns() {
    Turn step{0, 1};
    for (std::size_t parts = 1; parts < kQuarter; parts *= 2) {
        step = {std::sqrt((1 + step.cosine) / 2), std::sqrt((1 - step.cosine) / 2)};
    }
    std::array<Turn, kQuarter + 1> out{};
    for (std::size_t i = 1; i < kQuarter; ++i) {
        out[i] = sum(out[i - 1], step);
    }
    out[kQuarter] = {0, 1};
    return out;
}

Ring ringAt(double radius, double height) {
    const std::array<Turn, kQuarter + 1> turns = quarterTurns();
    Ring ring;
    for (std::size_t i = 0; i < 4 * kQuarter; ++i) {
        const Turn& turn = turns[i % kQuarter];
        const std::array<Vec3, 4> quarters{{{turn.cosine, turn.sine, 0},
                                            {-turn.sine, turn.cosine, 0},
                                            {-turn.cosine, -turn.sine, 0},
                                            {turn.sine, -turn.cosine, 0}}};
        const Vec3& at = quarters[i / kQuarter];
        ring.push_back(
            {{radius * at[0], radius * at[1], height}, static_cast<double>(i) / static_cast<double>(4 * kQuarter)});
    }
    return ring;
}

} // namespace

Result<MeshData> makeNeedle(double diameter, double length) {
    return guard([&]() -> Result<MeshData> {
        if (!(diameter > 0 && length >= diameter && std::isfinite(length))) {
            return refuse("a needle of diameter " + number(diameter) + " mm and length " + number(length) +
                          " mm: the diameter must be above 0, and the length no smaller than that");
        }
        const double radius = 0.5 * diameter;
        const std::array<Turn, kQuarter + 1> turns = quarterTurns();
        std::vector<Ring> rings;
        rings.push_back({{{0, 0, 0}, 0}});
        for (std::size_t i = 1; i <= kQuarter; ++i) {
            rings.push_back(ringAt(radius * turns[i].sine, radius * (1 - turns[i].cosine)));
        }
        for (std::size_t i = length > diameter ? kQuarter : kQuarter - 1; i > 0; --i) {
            rings.push_back(ringAt(radius * turns[i].sine, length - radius * (1 - turns[i].cosine)));
        }
        rings.push_back({{{0, 0, length}, 0}});
        return toMesh(loft(rings), "needle");
    });
}

} // namespace voxtact
