// SPDX-License-Identifier: MIT
#include "cpu/scenes/look_scene.h"

#include "core/method/certified_constants.h"
#include "core/transfer/table_points.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace voxtact::test {

namespace {

/// A ramp, a peak of one entry, noise with holes, or a step.
std::vector<float> drawnTable(std::mt19937_64& random) {
    std::vector<float> table(std::size_t{1} << (4 + below(random, 5)));
    const auto kind = below(random, 4);
    const std::size_t at = below(random, table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(table.size() - 1);
        table[i] = kind == 0 ? part : kind == 1 ? (i == at ? 1.0F : 0.0F) : kind == 2 ? drawn(random, 0, 1) : i >= at;
    }
    return table;
}

} // namespace

LookScene::LookScene(std::mt19937_64& random)
    : numbers_(opaqueNumbers(pointsOf(drawnTable(random), {0, 255}), uniform(random, 0.02, 0.98), {}, false)),
      item_(certifiedItem(unitGrid(kSide), numbers_, 1e-3)) {}

shader::CertifiedCorners LookScene::corners(std::mt19937_64& random) const {
    std::array<float, 8> values{};
    const double middle = uniform(random, -10, 265);
    const double spread = std::pow(10, uniform(random, -3, 2));
    float lo = std::numeric_limits<float>::infinity();
    float hi = -lo;
    // Now and then what bends alone: a product of two axes, or of all three.
    const unsigned product = chance(random, 0.3) ? 1 + static_cast<unsigned>(below(random, 7)) : 0;
    for (unsigned i = 0; i < 8; ++i) {
        float& value = values[i];
        const double off = product != 0 ? ((std::popcount(i & product) & 1) != 0 ? -spread : spread)
                                        : uniform(random, -spread, spread);
        value = static_cast<float>(middle + off);
        value = chance(random, 0.5) ? std::round(value) : value;
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    return {values[0], values[1], values[2], values[3], values[4], values[5], values[6], values[7], lo, hi};
}

int LookScene::verdict(const shader::CertifiedCorners& corners, const std::array<shader::CertifiedVertex, 3>& vertices,
                       const std::array<std::int32_t, 3>& place) const {
    const shader::CertifiedBounds bounds = shader::certifiedBounds(item_, vertices[0], vertices[1], vertices[2]);
    const shader::CertifiedTriangle triangle =
        shader::certifiedTriangle(vertices[0].point, vertices[1].point, vertices[2].point, bounds.delta);
    const auto [x, y, z] = place;
    const shader::CertifiedCell cell = shader::certifiedCell(item_, corners, x, y, z, bounds.delta);
    if (!shader::certifiedCellMayBeOpaque(opaque(), cell)) {
        return CERTIFIED_NONE;
    }
    shader::VoxelPoint polygon[CERTIFIED_MAX_CORNERS];
    const int count = shader::certifiedBegin(opaque(), triangle, cell, x, y, z, polygon);
    shader::CertifiedWitness witness{};
    return shader::certifiedSettle(opaque(), item_.resolution, cell, polygon, count, witness);
}

} // namespace voxtact::test
