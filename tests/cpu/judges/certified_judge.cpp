// SPDX-License-Identifier: MIT
#include "cpu/judges/certified_judge.h"

#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace voxtact::test {

namespace {

using oracle::Certainty;

/// The oracle may be undecided, which allows anything.
void judgePair(const PairAnswer& pair, Certainty oracle, std::ostream& out) {
    if (oracle == Certainty::Certain && !pair.hit && !pair.possible) {
        out << "a certain contact is missed\n";
    }
    if (oracle == Certainty::None && pair.hit) {
        out << "a hit where there is beyond doubt no contact\n";
    }
    if (pair.hit != (pair.count > 0)) {
        out << "hit is " << pair.hit << " with a count of " << pair.count << "\n";
    }
    if (pair.hit && pair.possible) {
        out << "both a hit and possible\n";
    }
    if (pair.possible && pair.exactness == Exactness::Exact) {
        out << "possible, and an exact count\n";
    }
    if (pair.projection != Projection::Certified) {
        out << "the projection is " << toString(pair.projection) << "\n";
    }
}

/// The survivors of each triangle.
std::vector<std::uint64_t> judgeTriangles(const EngineSays& engine, const oracle::CertifiedOracle& oracle,
                                          std::ostream& out) {
    std::vector<std::uint64_t> counts(oracle.triangles.size());
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < engine.triangles.size(); ++i) {
        const TouchedTriangle& touched = engine.triangles[i];
        if (touched.pair != engine.pair.pair || touched.triangle >= counts.size() || touched.count == 0) {
            out << "the list has triangle " << touched.triangle << " of pair " << touched.pair << ", " << touched.count
                << " times\n";
            continue;
        }
        if (i > 0 && touched.triangle <= engine.triangles[i - 1].triangle) {
            out << "the list has triangle " << touched.triangle << " after " << engine.triangles[i - 1].triangle
                << "\n";
        }
        if (oracle.triangles[touched.triangle].certainty == Certainty::None) {
            out << "triangle " << touched.triangle << " is listed, which beyond doubt does not touch\n";
        }
        counts[touched.triangle] += touched.count;
        sum += touched.count;
    }
    if (sum != engine.pair.count) {
        out << "the count is " << engine.pair.count << ", that of the triangles " << sum << "\n";
    }
    return counts;
}

void judgeCells(std::size_t triangle, std::uint64_t count, bool exact, const CellCount& cells, std::ostream& out) {
    if (count > cells.possible || (exact && count < cells.certain)) {
        out << "triangle " << triangle << " has a count of " << count << (exact ? " (exact)" : " (lower bound)")
            << ", it touches in " << cells.certain << " to " << cells.possible << " cells\n";
    }
}

/// How far the engine may place a triangle from where it is (src/exact/certified.h): twice its delta, in voxels.
/// Rounding of the vertices in proportion to the terms of their transform, and clipping in proportion to the triangle's
/// side.
double displacement(const CertifiedCase& c, std::size_t triangle) {
    const Mat4 texture_from_world = textureFromWorld(c.scene.volume.grid).value();
    double terms = 0;
    double side = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double least = 1e300;
        double greatest = -1e300;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* at =
                c.scene.mesh.positions.data() + std::size_t{3} * c.scene.mesh.indices[3 * triangle + corner];
            double place = 0;
            double magnitude = 0.5;
            for (std::size_t column = 0; column < 4; ++column) {
                double element = 0;
                for (std::size_t k = 0; k < 4; ++k) {
                    element += texture_from_world[4 * k + axis] * c.scene.world_from_object[4 * column + k];
                }
                const double term = element * c.scene.volume.grid.size[axis] * (column < 3 ? at[column] : 1.0);
                place += term;
                magnitude += std::abs(term);
            }
            terms = std::max(terms, magnitude);
            least = std::min(least, place);
            greatest = std::max(greatest, place);
        }
        side = std::max(side, greatest - least);
    }
    // The bound for the vertices takes the worst axis of each column: at most three times the worst row.
    return 2 * (0x1p-18 * (side + 2) + 3 * 0x1p-21 * terms);
}

} // namespace

std::vector<CellCount> countCells(const CertifiedCase& c) {
    std::vector<CellCount> out(c.scene.mesh.indices.size() / 3);
    for (std::size_t triangle = 0; triangle < out.size(); ++triangle) {
        const double margin = std::min(oracle::kCellMargin + displacement(c, triangle), 1.0);
        for (const oracle::JudgedCell& cell :
             take(oracle::certifiedCells(c.scene.pair(), static_cast<std::uint32_t>(triangle), margin))) {
            ++out[triangle].possible;
            out[triangle].certain += cell.certainty == Certainty::Certain ? 1U : 0U;
        }
    }
    return out;
}

Result<EngineSays> askEngine(cpu::Detector& detector, const CertifiedCase& c) {
    const cpu::Mesh mesh = take(cpu::Mesh::create(c.scene.mesh.view()));
    const cpu::Volume volume = take(cpu::Volume::create(c.scene.volume.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create(c.scene.pair().transferFunction));
    const cpu::BatchItem item{.mesh = &mesh,
                              .volume = &volume,
                              .transferFunction = &function,
                              .world_from_object = std::span(&c.scene.world_from_object, 1)};
    Result<BatchAnswer> answer =
        detector.detect({.items = std::span(&item, 1), .view = {}, .threshold = c.scene.threshold});
    if (!answer.ok()) {
        return answer.error();
    }
    return EngineSays{answer->pairs.at(0), std::move(answer->triangles)};
}

std::string complaints(const EngineSays& engine, const oracle::CertifiedOracle& oracle,
                       const std::vector<CellCount>& cells) {
    std::ostringstream out;
    judgePair(engine.pair, oracle.certainty, out);
    const std::vector<std::uint64_t> counts = judgeTriangles(engine, oracle, out);
    const bool exact = engine.pair.exactness == Exactness::Exact;
    for (std::size_t triangle = 0; triangle < counts.size(); ++triangle) {
        if (exact && counts[triangle] == 0 && oracle.triangles[triangle].certainty == Certainty::Certain) {
            out << "triangle " << triangle << " certainly touches, and is not in an exact count\n";
        }
        if (!cells.empty()) {
            judgeCells(triangle, counts[triangle], exact, cells[triangle], out);
        }
    }
    return out.str();
}

} // namespace voxtact::test
