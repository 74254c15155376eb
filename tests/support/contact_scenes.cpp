// SPDX-License-Identifier: MIT
#include "support/contact_scenes.h"
#include "core/geometry/vec3.h"
#include "support/scenes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace voxtact::test {

namespace {

Vec3 scaled(const Vec3& a, double factor) {
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

Vec3 column(const Mat4& matrix, std::size_t number) {
    return {matrix[4 * number], matrix[4 * number + 1], matrix[4 * number + 2]};
}

Vec3 centreOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

/// Voxels between a place and the nearest face of the image.
double voxelsInside(const Grid& grid, const Vec3& world) {
    const Vec3 texture = transformPoint(textureFromWorld(grid).value(), world);
    double least = 1e9;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        least = std::min(least, std::min(texture[axis], 1 - texture[axis]) * grid.size[axis]);
    }
    return least;
}

VolumeData sampled(const Grid& grid, const std::function<double(const Vec3&)>& distance) {
    const Mat4 world_from_index = worldFromIndex(grid);
    return makeVolume<float>(grid, ScalarType::Float32, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return distance(
            transformPoint(world_from_index, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
    });
}

/// A mesh at the middle of the volume, and a camera that sees the whole mesh.
ContactScene sceneIn(const Grid& grid, std::string name, double meshSide, std::mt19937_64& random) {
    ContactScene scene;
    scene.name = std::move(name);
    scene.points = {{-40, 0}, {40, 1}};
    scene.domain = {-40, 40};
    scene.mesh = makeCube(-meshSide, meshSide);
    const Vec3 centre = centreOf(grid);
    scene.world_from_object = multiply(translation(centre), randomRotation(random));
    scene.view = {framingCamera(grid, 160, 160), 160, 160};
    return scene;
}

ContactScene halfSpace(std::mt19937_64& random, bool sheared) {
    const Grid grid = obliqueGrid(random, sheared);
    const Vec3 normal = column(randomRotation(random), 0);
    const Vec3 centre = centreOf(grid);
    const auto depth = [=](const Vec3& at) { return -dot(normal, minus(at, centre)); };
    ContactScene scene = sceneIn(grid, sheared ? "half space, sheared" : "half space", 4.5, random);
    scene.volume = sampled(grid, depth);
    scene.place = [=](const Vec3& at) { return Place{normal, depth(at), voxelsInside(grid, at) > 2}; };
    scene.degrees = 0.02;
    scene.mm = 0.001;
    return scene;
}

ContactScene ball(std::mt19937_64& random) {
    const Grid grid = obliqueGrid(random, false);
    const Vec3 centre = centreOf(grid);
    constexpr double kRadius = 12;
    const auto depth = [=](const Vec3& at) { return kRadius - length(minus(at, centre)); };
    ContactScene scene = sceneIn(grid, "ball", 7, random);
    scene.volume = sampled(grid, depth);
    scene.place = [=](const Vec3& at) {
        return Place{unit(minus(at, centre)), depth(at), length(minus(at, centre)) > 6 && voxelsInside(grid, at) > 2};
    };
    // Second differences of the distance are 1/r; their effect over one and a half voxels of 1.4 mm.
    scene.degrees = 1.5;
    scene.mm = 0.06;
    return scene;
}

ContactScene box(std::mt19937_64& random) {
    const Grid grid = obliqueGrid(random, false);
    const Mat4 turn = randomRotation(random);
    const Vec3 centre = centreOf(grid);
    constexpr double kHalf = 10;
    // Distances to the planes of the six faces, the nearest first.
    const auto faces = [=](const Vec3& at) {
        std::vector<std::pair<double, Vec3>> out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vec3 along = column(turn, axis);
            const double place = dot(along, minus(at, centre));
            out.emplace_back(kHalf - place, along);
            out.emplace_back(kHalf + place, scaled(along, -1));
        }
        std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        return out;
    };
    ContactScene scene = sceneIn(grid, "box", 7, random);
    scene.volume = sampled(grid, [=](const Vec3& at) { return faces(at)[0].first; });
    scene.place = [=](const Vec3& at) {
        const auto nearest = faces(at);
        // Only one face lies in the cells of the differences, which reach less than 3.5 mm, and on the way out.
        const bool sure = nearest[1].first - nearest[0].first > 5 && voxelsInside(grid, at) > 2;
        return Place{nearest[0].second, nearest[0].first, sure};
    };
    scene.degrees = 0.02;
    scene.mm = 0.001;
    return scene;
}

/// Distance of a point to a triangle's plane, or to its outline where it is beyond that.
double distanceToTriangle(const Vec3& at, const Vec3 (&corners)[3]) {
    const Vec3 normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    double most = std::abs(dot(unit(normal), minus(at, corners[0])));
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 inward = unit(cross(normal, minus(corners[(i + 1) % 3], corners[i])));
        most = std::max(most, -dot(inward, minus(at, corners[i])));
    }
    return most;
}

double distanceToTriangle(const ContactScene& scene, const Contact& contact) {
    Vec3 corners[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = scene.mesh.indices[std::size_t{3} * contact.triangle + i];
        const double* at = scene.mesh.positions.data() + std::size_t{3} * vertex;
        corners[i] = transformPoint(scene.world_from_object, {at[0], at[1], at[2]});
    }
    return distanceToTriangle(contact.position, corners);
}

} // namespace

Grid obliqueGrid(std::mt19937_64& random, bool sheared) {
    Grid grid;
    grid.size = {48, 40, 34};
    grid.spacing = {0.9, 1.1, 1.4};
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = uniform(random, -60, 60);
        const Vec3 along = axis == 2 && sheared
                               ? unit({turn[8] + 0.4 * turn[0], turn[9] + 0.4 * turn[1], turn[10] + 0.4 * turn[2]})
                               : column(turn, axis);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = along[row];
        }
    }
    return grid;
}

std::vector<ContactScene> makeContactScenes(std::mt19937_64& random) {
    std::vector<ContactScene> scenes;
    for (int turn = 0; turn < 3; ++turn) {
        scenes.push_back(halfSpace(random, false));
        scenes.push_back(halfSpace(random, true));
        scenes.push_back(ball(random));
        scenes.push_back(box(random));
    }
    return scenes;
}

ContactErrors contactErrors(const ContactScene& scene, const std::vector<Contact>& contacts) {
    ContactErrors errors;
    for (const Contact& contact : contacts) {
        errors.fromTriangle = std::max(errors.fromTriangle, distanceToTriangle(scene, contact));
        // The table has 256 entries, half of one at each end, and is linear between.
        errors.value = std::max(errors.value, std::abs((contact.value + 40) / 80 - contact.opacity));
        const Place place = scene.place(contact.position);
        if (!place.sure || place.depth > scene.maxDepth) {
            continue;
        }
        ++errors.compared;
        const double sine = length(cross(contact.normal, place.normal));
        const double angle = std::atan2(sine, dot(contact.normal, place.normal)) * 180 / std::numbers::pi;
        errors.degrees = std::max(errors.degrees, angle);
        errors.mm = std::max(errors.mm, std::abs(contact.depth - place.depth));
    }
    return errors;
}

VolumeData makeLabelImage(std::mt19937_64& random, const Grid& around) {
    Grid grid;
    grid.size = {17, 13, 11};
    const Vec3 centre = centreOf(around);
    const Mat4 world = worldFromTexture(around);
    const Mat4 turn = randomRotation(random);
    const double side = length(minus(transformPoint(world, {1, 1, 1}), transformPoint(world, {0, 0, 0})));
    Vec3 toFirst{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Some of the volume is outside.
        grid.spacing[axis] = 0.8 * side / grid.size[axis];
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
            toFirst[row] += turn[4 * axis + row] * grid.spacing[axis] * (grid.size[axis] - 1) / 2;
        }
    }
    grid.origin = minus(centre, toFirst);
    constexpr std::int16_t kLabels[] = {-7, 0, 1, 2, 5, 1000};
    return makeVolume<std::int16_t>(grid, ScalarType::Int16,
                                    [&](auto...) { return kLabels[random() % std::size(kLabels)]; });
}

bool labelIsDoubtful(const LabelData& labels, const Vec3& world) {
    constexpr double kVoxels = 1e-3;
    const Vec3 texture = transformPoint(textureFromWorld(labels.grid).value(), world);
    bool doubtful = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double voxel = texture[axis] * labels.grid.size[axis];
        doubtful = doubtful || std::abs(voxel - std::round(voxel)) < kVoxels;
    }
    return doubtful;
}

std::string differenceOf(const BatchAnswer& a, const BatchAnswer& b) {
    // Compares bits: NaN equals itself, -0 differs from 0.
    const auto bits = [](const Contact& contact) {
        return std::tuple(contact.pair, contact.triangle, std::bit_cast<std::array<std::uint64_t, 3>>(contact.position),
                          std::bit_cast<std::array<std::uint64_t, 3>>(contact.normal),
                          std::bit_cast<std::uint64_t>(contact.depth), std::bit_cast<std::uint64_t>(contact.value),
                          std::bit_cast<std::uint64_t>(contact.opacity), contact.label);
    };
    const auto first = [](const auto& x, const auto& y, const char* what, auto&& same) {
        if (x.size() != y.size()) {
            return std::string(what) + ": " + std::to_string(x.size()) + " and " + std::to_string(y.size());
        }
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (!same(x[i], y[i])) {
                return std::string(what) + " " + std::to_string(i);
            }
        }
        return std::string();
    };
    std::string text =
        first(a.pairs, b.pairs, "pairs", [](const auto& x, const auto& y) { return x.count == y.count; });
    text += first(a.triangles, b.triangles, " triangles", [](const auto& x, const auto& y) {
        return x.pair == y.pair && x.triangle == y.triangle && x.count == y.count;
    });
    text += first(a.bounds, b.bounds, " bounds", [](const auto& x, const auto& y) {
        return x.has_value() == y.has_value() && (!x || (x->lo == y->lo && x->hi == y->hi));
    });
    text += first(a.labels, b.labels, " labels", [](const auto& x, const auto& y) {
        return x.pair == y.pair && x.label == y.label && x.count == y.count;
    });
    text += first(a.contacts, b.contacts, " contacts",
                  [&](const Contact& x, const Contact& y) { return bits(x) == bits(y); });
    return text + (a.contactsFound == b.contactsFound ? "" : " contactsFound");
}

std::string inconsistencyOf(const BatchAnswer& answer) {
    std::vector<std::uint64_t> ofTriangles(answer.pairs.size());
    std::vector<std::uint64_t> ofContacts(answer.pairs.size());
    std::vector<std::uint64_t> ofLabels(answer.pairs.size());
    std::vector<std::optional<Box>> boxes(answer.pairs.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> byTriangle;
    for (const TouchedTriangle& triangle : answer.triangles) {
        ofTriangles[triangle.pair] += triangle.count;
        byTriangle[{triangle.pair, triangle.triangle}] = triangle.count;
    }
    for (const LabelCount& label : answer.labels) {
        ofLabels[label.pair] += label.count;
    }
    for (const Contact& contact : answer.contacts) {
        ++ofContacts[contact.pair];
        --byTriangle[{contact.pair, contact.triangle}];
        std::optional<Box>& box = boxes[contact.pair];
        box = box ? *box : Box{contact.position, contact.position};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box->lo[axis] = std::min(box->lo[axis], contact.position[axis]);
            box->hi[axis] = std::max(box->hi[axis], contact.position[axis]);
        }
    }
    for (std::size_t pair = 0; pair < answer.pairs.size(); ++pair) {
        const std::uint64_t count = answer.pairs[pair].count;
        const std::string which = "pair " + std::to_string(pair) + " of count " + std::to_string(count) + ": ";
        if (ofTriangles[pair] != count || ofContacts[pair] != count || ofLabels[pair] != count) {
            return which + std::to_string(ofTriangles[pair]) + " of its triangles, " +
                   std::to_string(ofContacts[pair]) + " contacts, " + std::to_string(ofLabels[pair]) + " of labels";
        }
        const std::optional<Box>& box = answer.bounds[pair];
        if (box.has_value() != boxes[pair].has_value() ||
            (box && (box->lo != boxes[pair]->lo || box->hi != boxes[pair]->hi))) {
            return which + "the box is not that of the contacts";
        }
    }
    for (const auto& [triangle, rest] : byTriangle) {
        if (rest != 0) {
            return "triangle " + std::to_string(triangle.second) + ": its contacts are not as many as its survivors";
        }
    }
    return answer.contactsFound == answer.contacts.size() ? "" : "contactsFound";
}

} // namespace voxtact::test
