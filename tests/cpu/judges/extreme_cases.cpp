// SPDX-License-Identifier: MIT
#include "cpu/judges/extreme_cases.h"

#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace voxtact::test {

namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}
bool chance(Random& random, double share) {
    return uniform(random, 0, 1) < share;
}
template <class Type> Type pick(Random& random, std::initializer_list<Type> choices) {
    return choices.begin()[below(random, choices.size())];
}

enum class GridKind { Unit, Nice, Anisotropic, Turned, Oblique };

void turn(Random& random, Grid& grid) {
    const Mat4 by = randomRotation(random);
    for (std::size_t i = 0; i < 9; ++i) {
        grid.direction[i] = by[4 * (i / 3) + i % 3];
    }
}

/// The axes of the world in another order, and flipped.
void permute(Random& random, Grid& grid) {
    std::array<std::size_t, 3> order{0, 1, 2};
    std::shuffle(order.begin(), order.end(), random);
    grid.direction = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.direction[3 * axis + order[axis]] = chance(random, 0.5) ? 1 : -1;
    }
}

Grid randomGrid(Random& random, GridKind kind) {
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(1 + below(random, chance(random, 0.2) ? 12 : 4));
        const bool nice = kind == GridKind::Unit || kind == GridKind::Nice;
        grid.spacing[axis] = kind == GridKind::Unit ? 1
                             : nice                 ? pick(random, {0.5, 0.75, 1.5, 3.0, 0.1})
                                                    : uniform(random, 0.2, 4);
        grid.origin[axis] = nice ? pick(random, {0.0, 0.5, -8.0, 1024.0, 0.3}) : uniform(random, -300, 300);
    }
    if (kind == GridKind::Turned || kind == GridKind::Oblique) {
        turn(random, grid);
    } else if (chance(random, 0.4)) {
        permute(random, grid);
    }
    if (kind == GridKind::Oblique) {
        const double shear = uniform(random, -0.9, 0.9);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 + row] += shear * grid.direction[row];
        }
    }
    return grid;
}

/// 0 to 1.
double patternAt(Random& random, std::size_t kind, bool chosen, double level) {
    switch (kind) {
    case 0: // one voxel
        return chosen ? 1 : 0;
    case 1: // a constant
        return level;
    case 2: // steps
        return chance(random, 0.5) ? 1 : 0;
    case 3: // two levels that are hardly apart
        return chance(random, 0.5) ? level : level + 0x1p-20;
    default:
        return uniform(random, 0, 1);
    }
}

VolumeData randomVolume(Random& random, const Grid& grid) {
    const std::size_t kind = below(random, 6);
    const double level = uniform(random, 0, 0.9);
    const std::size_t chosen = below(random, voxelCount(grid));
    std::size_t at = 0;
    const auto stretched = [&](double lo, double hi) {
        return [&, lo, hi](auto...) { return lo + (hi - lo) * patternAt(random, kind, at++ == chosen, level); };
    };
    switch (below(random, 5)) {
    case 0:
        return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, stretched(0, 255));
    case 1:
        return makeVolume<std::uint16_t>(grid, ScalarType::UInt16, stretched(0, 65535));
    case 2:
        return makeVolume<std::int16_t>(grid, ScalarType::Int16, stretched(-32768, 32767));
    default:
        break;
    }
    const double scale = std::pow(10, pick(random, {0.0, 0.0, -3.0, 6.0, 30.0, -30.0}));
    const double lo = pick(random, {0.0, -scale, 1000 * scale});
    return makeVolume<float>(grid, ScalarType::Float32, stretched(lo, lo + scale));
}

/// The whole of the values, a narrow part of them, or far more.
ValueRange randomDomain(Random& random, const ValueRange& values) {
    const double width = std::max({values.hi - values.lo, 1e-6 * std::abs(values.hi), 1e-36});
    switch (below(random, 5)) {
    case 0:
        return {values.lo, values.lo + width};
    case 1:
        return {values.lo - width, values.hi + width};
    case 2: {
        const double middle = uniform(random, values.lo, values.lo + width);
        const double narrow = std::max(width * std::pow(10, uniform(random, -6, -1)), 1e-9 * std::abs(middle));
        return {middle - narrow, middle + narrow};
    }
    case 3:
        return {values.lo - 1e6 * width, values.hi + 1e6 * width};
    default:
        return {values.lo - 0.5 * width, values.lo + 1.5 * width};
    }
}

double entryValue(const ExtremeCase& c, std::size_t entry) {
    return c.domain.lo + (static_cast<double>(entry) + 0.5) / c.tableSize * (c.domain.hi - c.domain.lo);
}

/// Points at entries' own values, so that the table has just these opacities.
void randomFunction(Random& random, ExtremeCase& c) {
    c.domain = randomDomain(random, take(checkVolume(c.volume.view())));
    c.tableSize = pick(random, {2U, 3U, 16U, 255U, 256U, 1024U});
    const std::size_t kind = below(random, 5);
    const std::size_t at = below(random, c.tableSize);
    const double level = pick(random, {1.0, 0.5, 0.1, uniform(random, 0, 1)});
    for (std::size_t entry = 0; entry < c.tableSize; ++entry) {
        const double place = static_cast<double>(entry) / c.tableSize;
        const double opacity = kind == 0   ? (entry == at ? level : 0)
                               : kind == 1 ? (entry == at ? 0 : level)
                               : kind == 2 ? place
                               : kind == 3 ? (entry < at ? 0 : level)
                                           : uniform(random, 0, 1);
        c.points.push_back({entryValue(c, entry), opacity});
    }
    bool ascending = true;
    for (std::size_t i = 1; i < c.points.size(); ++i) {
        ascending = ascending && c.points[i - 1].value < c.points[i].value;
    }
    if (!ascending) { // a domain that doubles cannot divide
        c.points = {{c.domain.lo, 0}, {c.domain.hi, 1}};
    }
    const double opacity =
        c.points[chance(random, 0.5) ? std::min(at, c.points.size() - 1) : below(random, c.points.size())].opacity;
    c.threshold =
        pick(random, {opacity, std::nextafter(opacity, 2.0), std::nextafter(opacity, -1.0), uniform(random, 0, 1)});
    c.threshold = std::clamp(c.threshold, 0.0, 1.0);
}

/// Along an axis, in index space: centres, faces, halves, hardly beside them, anywhere.
double randomCoordinate(Random& random, std::uint32_t size) {
    const double last = size - 0.5;
    const double cell = static_cast<double>(below(random, size + 1)) - 1;
    double at = 0;
    switch (below(random, 7)) {
    case 0:
        at = chance(random, 0.5) ? -0.5 : last;
        break;
    case 1:
        at = cell + 0.5;
        break;
    case 2:
    case 3:
        at = cell;
        break;
    case 4:
        return uniform(random, -3, last + 3);
    default:
        return uniform(random, -0.5, last);
    }
    return chance(random, 0.3) ? at + std::pow(10, uniform(random, -12, -4)) * pick(random, {-1.0, 1.0}) : at;
}

Vec3 randomPlace(Random& random, const Grid& grid) {
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[axis] = randomCoordinate(random, grid.size[axis]);
    }
    return out;
}

using Triangle = std::array<Vec3, 3>;

/// Index space.
Triangle randomTriangle(Random& random, const Grid& grid) {
    Triangle out{randomPlace(random, grid), randomPlace(random, grid), randomPlace(random, grid)};
    switch (below(random, 8)) {
    case 0: { // in a plane
        const std::size_t axis = below(random, 3);
        out[1][axis] = out[0][axis];
        out[2][axis] = out[0][axis];
        break;
    }
    case 1: // along an edge
        for (std::size_t axis = 1; axis < 3; ++axis) {
            out[1][axis] = out[0][axis];
        }
        break;
    case 2: // a sliver
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[2][axis] = out[0][axis] + uniform(random, -1, 1) * std::pow(10, uniform(random, -9, -2));
        }
        break;
    case 3: // large
    {
        const double by = std::pow(10, uniform(random, 1, 8));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[1][axis] += by * uniform(random, -1, 1);
            out[2][axis] += by * uniform(random, -1, 1);
        }
        break;
    }
    case 4: // tiny
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[1][axis] = out[0][axis] + uniform(random, -1, 1) * 1e-3;
            out[2][axis] = out[0][axis] + uniform(random, -1, 1) * 1e-3;
        }
        break;
    default:
        break;
    }
    return out;
}

Mat4 randomPose(Random& random) {
    Mat4 out = identity();
    switch (below(random, 5)) {
    case 0:
    case 1:
        break;
    case 2: // what floats hold
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[12 + axis] = pick(random, {0.0, 0.25, -16.0, 4096.0});
        }
        break;
    case 3: // far away
        out = randomRotation(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[12 + axis] = std::pow(10, uniform(random, 1, 6)) * pick(random, {-1.0, 1.0});
        }
        break;
    default:
        out = randomRotation(random);
        for (std::size_t column = 0; column < 3; ++column) {
            const double scale = std::pow(10, uniform(random, -3, 3));
            for (std::size_t row = 0; row < 3; ++row) {
                out[4 * column + row] *= scale;
            }
        }
        break;
    }
    return out;
}

std::string describe(std::uint64_t seed, std::uint64_t number, const char* said, const char* judged) {
    return "VOXTACT_TEST_SEED=" + std::to_string(seed) + ", case " + std::to_string(number) + ": the engine says " +
           said + ", the judge " + judged;
}

const char* textOf(const PairAnswer& pair) {
    return pair.hit ? "touches" : pair.possible ? "possible" : "none";
}

cpu::Detector detectorOf(bool stopAtFirst) {
    cpu::DetectorDesc desc;
    desc.projection = Projection::Certified;
    desc.stopAtFirst = stopAtFirst;
    desc.threads = 1;
    return take(cpu::Detector::create(desc));
}

} // namespace

ExtremeCase makeExtremeCase(std::uint64_t seed, std::uint64_t number) {
    std::seed_seq numbers{seed, seed >> 32U, number, number >> 32U};
    Random random(numbers);
    ExtremeCase c;
    c.volume = randomVolume(random, randomGrid(random, static_cast<GridKind>(below(random, 5))));
    randomFunction(random, c);
    c.world_from_object = randomPose(random);
    const Grid& grid = c.volume.grid;
    const Mat4 object_from_index = multiply(take(inverse(c.world_from_object)), worldFromIndex(grid));
    const std::size_t count = chance(random, 0.6) ? 1 : 1 + below(random, 4);
    for (std::size_t i = 0; i < count; ++i) {
        for (const Vec3& place : randomTriangle(random, grid)) {
            c.mesh.indices.push_back(static_cast<std::uint32_t>(c.mesh.positions.size() / 3));
            for (const double coordinate : transformPoint(object_from_index, place)) {
                c.mesh.positions.push_back(static_cast<float>(coordinate));
            }
        }
    }
    return c;
}

ExtremeTrial::ExtremeTrial() : yesNo_(detectorOf(true)), count_(detectorOf(false)) {}

void ExtremeTrial::run(std::uint64_t seed, std::uint64_t number) {
    const ExtremeCase c = makeExtremeCase(seed, number);
    const cpu::Mesh mesh = take(cpu::Mesh::create(c.mesh.view()));
    const cpu::Volume volume = take(cpu::Volume::create(c.volume.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({c.points, c.domain, c.tableSize}));
    const cpu::BatchItem item{&mesh, &volume, &function, {&c.world_from_object, 1}};
    const auto ask = [&](cpu::Detector& detector) {
        return take(detector.detect({{&item, 1}, {}, c.threshold})).pairs.at(0);
    };
    const PairAnswer pair = ask(count_);
    const PairAnswer quick = ask(yesNo_);
    const Judgement judged = judge({c.mesh.view(), c.volume.view(), c.world_from_object, c.points, c.threshold});
    const bool wrong = (pair.hit && judged == Judgement::None) ||
                       (!pair.hit && !pair.possible && judged == Judgement::Touches) || pair.hit != quick.hit ||
                       pair.possible != quick.possible;
    if (wrong) {
        ++tally_.wrong;
        if (tally_.complaints.size() < 10) {
            tally_.complaints.push_back(describe(seed, number, textOf(pair), toString(judged)) +
                                        (pair.hit != quick.hit || pair.possible != quick.possible
                                             ? std::string("; asked for yes or no it says ") + textOf(quick)
                                             : std::string()));
        }
    } else if (judged == Judgement::Undecidable) {
        ++tally_.unjudged;
    } else if (pair.possible) {
        ++tally_.possible;
    } else {
        ++(pair.hit ? tally_.touches : tally_.none);
    }
}

} // namespace voxtact::test
