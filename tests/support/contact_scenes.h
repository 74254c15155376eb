// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/results.h"

#include <functional>
#include <random>
#include <string>

namespace voxtact::test {

/// Known facts of a position.
struct Place {
    Vec3 normal{};
    double depth = 0; ///< mm
    bool sure = true; ///< false: too near an edge of the solid, or of the image
};

/// A solid whose normals and depths are known, and a mesh that cuts it.
struct ContactScene {
    std::string name;
    VolumeData volume;
    std::vector<ControlPoint> points;
    ValueRange domain;
    MeshData mesh;
    Mat4 world_from_object = identity();
    View view;
    double threshold = 0.5;
    double maxDepth = kDefaultMaxDepth;
    std::function<Place(const Vec3&)> place;
    double degrees = 0; ///< the most that a normal may be off
    double mm = 0;      ///< the same of a depth
};

/// Grids with different spacings, turned at random, and sheared where asked for.
[[nodiscard]] Grid obliqueGrid(std::mt19937_64& random, bool sheared);

/// A half space, a ball and a box whose voxels hold the signed distance to their surface, positive inside; the opacity
/// is linear in it.
[[nodiscard]] std::vector<ContactScene> makeContactScenes(std::mt19937_64& random);

/// Errors of the contacts of a scene.
struct ContactErrors {
    std::size_t compared = 0; ///< contacts at places that are sure
    double degrees = 0;       ///< the most
    double mm = 0;
    double value = 0;        ///< in the image's units, against the opacity that it stands for
    double fromTriangle = 0; ///< mm
};
[[nodiscard]] ContactErrors contactErrors(const ContactScene& scene, const std::vector<Contact>& contacts);

/// A label map with several labels, negative ones among them, on a grid of its own around the volume's.
[[nodiscard]] VolumeData makeLabelImage(std::mt19937_64& random, const Grid& around);
/// True if a point is so near to a face of a voxel of the label map that its label may be that of the neighbour.
[[nodiscard]] bool labelIsDoubtful(const LabelData& labels, const Vec3& world);

/// Everything of two answers but their times and methods, bit for bit. The text says where they differ first; empty
/// where they do not.
[[nodiscard]] std::string differenceOf(const BatchAnswer& a, const BatchAnswer& b);
/// Checks an answer's consistency: the counts against the sums over triangles, contacts, boxes and labels. Returns the
/// differences; empty if there are none. Expects all outputs, and a list that is not cut.
[[nodiscard]] std::string inconsistencyOf(const BatchAnswer& answer);

} // namespace voxtact::test
