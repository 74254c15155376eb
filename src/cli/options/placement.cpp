// SPDX-License-Identifier: MIT
#include "cli/options/placement.h"

#include "cli/options/inputs.h"
#include "cli/output/size_note.h"
#include "core/base/infinity.h"
#include "core/base/text.h"
#include "voxtact/io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

namespace voxtact::app {

namespace {

double lengthOf(const Box& box) {
    return std::hypot(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
}

/// Returns the transform from world to mm along the image axes, with the origin at the first corner.
Mat4 alongImage(const Grid& image) {
    const Result<Mat4> texture_from_world = textureFromWorld(image);
    Mat4 image_from_world = texture_from_world.ok() ? *texture_from_world : identity();
    for (std::size_t i = 0; i < image_from_world.size(); ++i) {
        image_from_world[i] *= i % 4 < 3 ? image.spacing[i % 4] * image.size[i % 4] : 1;
    }
    return image_from_world;
}

Placement placementOf(const Box& box, const Grid& image) {
    Placement placement{1, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double end = image.spacing[axis] * image.size[axis];
        const double length = box.hi[axis] - box.lo[axis];
        const double common = std::min(box.hi[axis], end) - std::max(box.lo[axis], 0.0);
        const double flat = common >= 0 ? 1 : 0;
        placement.overlap *= length > 0 ? std::clamp(common / length, 0.0, 1.0) : flat;
        placement.distance = std::hypot(placement.distance, std::max(-common, 0.0));
    }
    return std::isfinite(placement.overlap) ? placement : Placement{0, kInfinity};
}

/// Differences from the given options.
struct Change {
    bool space = false;
    double scale = 1;
    bool poses = false;

    [[nodiscard]] int count() const { return (space ? 1 : 0) + (scale != 1 ? 1 : 0) + (poses ? 1 : 0); }
};

Box changed(const Box& bounds, const Change& change) {
    Box box = bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (change.space && axis < 2) {
            box.lo[axis] = -bounds.hi[axis];
            box.hi[axis] = -bounds.lo[axis];
        }
        box.lo[axis] *= change.scale;
        box.hi[axis] *= change.scale;
    }
    return box;
}

Placement placementOf(const ReadMesh& mesh, const Change& change, const Grid& image) {
    const Mat4 image_from_world = alongImage(image);
    const Box object = changed(mesh.bounds, change);
    Placement best{0, kInfinity};
    for (const Mat4& pose : mesh.poses) {
        const Mat4 world_from_object = lpsFrom(change.poses ? "ras" : "lps", pose);
        const Placement here = placementOf(transformBox(multiply(image_from_world, world_from_object), object), image);
        if (here.overlap > best.overlap || (best.overlap == 0 && here.distance < best.distance)) {
            best = here;
        }
    }
    return best;
}

/// Returns the other space; empty if the file states its space, or for a builtin.
std::optional<std::string> otherSpace(const ReadMesh& mesh) {
    const Box mirrored = changed(mesh.bounds, {.space = true});
    for (const io::MeshSpace space : {io::MeshSpace::RAS, io::MeshSpace::LPS}) {
        const Result<MeshData> read = io::readMesh(mesh.source, {.space = space, .scale = mesh.options.scale});
        const Result<MeshFacts> facts = read.ok() ? checkMesh(read->view()) : Result<MeshFacts>(read.error());
        if (facts.ok() && facts->bounds.lo == mirrored.lo && facts->bounds.hi == mirrored.hi) {
            return space == io::MeshSpace::RAS ? "ras" : "lps";
        }
    }
    return std::nullopt;
}

/// Returns the text of the changed options.
std::string optionsOf(const ReadMesh& mesh, const Change& change, const std::string& space) {
    std::string options = change.space ? "--mesh-space " + space : "";
    const auto add = [&options](const std::string& option) { options += (options.empty() ? "" : " ") + option; };
    if (change.scale != 1) {
        add("--mesh-scale " + number(mesh.options.scale * change.scale));
    }
    if (change.poses) {
        add(mesh.posesSpace == "ras" ? "--poses-space lps" : "--poses-space ras");
    }
    return options;
}

/// Returns a rounded percentage; 100 % only if exact.
std::string shareText(double share) {
    return number(share < 1 ? std::min(std::round(100 * share), 99.0) : 100) + " %";
}

} // namespace

Placement placementOf(const ReadMesh& mesh, const Grid& image) {
    return placementOf(mesh, Change{}, image);
}

std::vector<OtherReading> otherReadings(const ReadMesh& mesh, const Grid& image) {
    constexpr double kFarMore = 0.05;
    constexpr double kStriking = 50; // ratio of lengths
    constexpr std::array kChanges{Change{true, 1, false}, Change{false, 1e3, false}, Change{false, 1e-3, false},
                                  Change{false, 1, true}, Change{true, 1e3, false},  Change{true, 1e-3, false},
                                  Change{true, 1, true}};
    const double present = placementOf(mesh, image).overlap;
    const double ratio = mesh.poses.empty()
                             ? 1
                             : lengthOf(transformBox(multiply(alongImage(image), mesh.poses.front()), mesh.bounds)) /
                                   std::hypot(image.spacing[0] * image.size[0], image.spacing[1] * image.size[1],
                                              image.spacing[2] * image.size[2]);
    const bool isFile = !mesh.source.starts_with("builtin:");
    const auto isPossible = [&](const Change& change) {
        const bool isLikely = change.scale == 1 || (change.scale > 1 ? ratio * kStriking < 1 : ratio > kStriking);
        return isLikely && (isFile || (!change.space && change.scale == 1)) &&
               (!change.poses || !mesh.posesSpace.empty());
    };
    std::vector<OtherReading> readings;
    int count = 1; // changed options: prefers fewer
    for (const Change& change : kChanges) {
        const double overlap = isPossible(change) ? placementOf(mesh, change, image).overlap : 0;
        if (overlap <= present + kFarMore || (!readings.empty() && change.count() > count)) {
            continue;
        }
        const std::optional<std::string> space = change.space ? otherSpace(mesh) : std::optional<std::string>("");
        if (space) {
            count = change.count();
            readings.push_back({optionsOf(mesh, change, *space), overlap, *space, mesh.options.scale * change.scale});
        }
    }
    std::ranges::stable_sort(readings, std::greater<>(), &OtherReading::overlap);
    return readings;
}

std::string toText(const OtherReading& reading) {
    return shareText(reading.overlap) + " of its box would be inside with " + reading.options;
}

std::string farNote(const ReadMesh& mesh, const std::string& volume, const Grid& image, std::uint64_t poses) {
    char distance[32];
    std::snprintf(distance, sizeof distance, "%.3g", placementOf(mesh, image).distance);
    const std::vector<OtherReading> others = otherReadings(mesh, image);
    const std::string size = mesh.poses.empty() ? "" : sizeNote(mesh.bounds, mesh.poses.front(), image);
    return mesh.source + " does not come near " + volume +
           (poses == 1 ? " at its pose" : " at any of " + std::to_string(poses) + " poses") + ", the boxes are " +
           distance + " mm apart; " +
           (!others.empty() ? toText(others.front())
            : !size.empty() ? "the mesh " + size
                            : "are --mesh-space, --mesh-scale and the poses (world mm, LPS) right?");
}

} // namespace voxtact::app
