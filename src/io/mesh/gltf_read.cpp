// SPDX-License-Identifier: MIT
#include "io/errors.h"
#include "io/mesh/gltf_accessor.h"
#include "io/mesh/gltf_scene.h"
#include "io/mesh/gltf_skin.h"

#include <algorithm>
#include <limits>
#include <map>

namespace voxtact::io {

namespace {

constexpr std::uint64_t kMostTriangles = std::numeric_limits<std::uint32_t>::max() / 3;
constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

double determinant(const Mat4& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

enum class Mode : std::uint64_t { Points, Lines, LineLoop, LineStrip, Triangles, TriangleStrip, TriangleFan };

Mode modeOf(const GltfJson& primitive) {
    const std::uint64_t mode = natural(primitive, "mode", 4);
    if (mode > 6) {
        throw GltfRefusal{"a primitive has the unknown mode " + std::to_string(mode)};
    }
    return static_cast<Mode>(mode);
}

std::uint64_t pointsOrLines(Mode mode, std::uint64_t corners) {
    return mode == Mode::Lines ? corners / 2 : mode == Mode::LineStrip ? corners - 1 : corners;
}

std::uint64_t trianglesOf(Mode mode, std::uint64_t corners) {
    if (mode == Mode::Triangles && corners % 3 != 0) {
        throw GltfRefusal{"a primitive has " + std::to_string(corners) + " corners, not three a triangle"};
    }
    return mode == Mode::Triangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
}

/// Numbers of the specification.
std::array<std::uint64_t, 3> cornersOf(Mode mode, std::uint64_t triangle) {
    if (mode == Mode::Triangles) {
        return {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
    }
    if (mode == Mode::TriangleStrip) {
        return {triangle, triangle + 1 + triangle % 2, triangle + 2 - triangle % 2};
    }
    return {triangle + 1, triangle + 2, 0};
}

/// Positions with their morph targets at the weights that the file gives.
class Positions {
  public:
    Positions(GltfDocument& document, const GltfJson& primitive, std::uint64_t accessor,
              const std::vector<double>& weights)
        : base_(document, accessor, GltfUse::Positions) {
        // Memory is taken for each vertex; a sparse accessor can state any number of them in a few bytes.
        constexpr std::uint64_t kMostUnstored = std::uint64_t{1} << 20U;
        if (!base_.isStored() && base_.count() > kMostUnstored) {
            throw GltfRefusal{"a sparse accessor states " + std::to_string(base_.count()) + " positions without data"};
        }
        const GltfJson& targets = objects(primitive, "targets");
        for (std::size_t i = 0; i < std::min(weights.size(), targets.size()); ++i) {
            const std::optional<std::uint64_t> moved = natural(targets[i], "POSITION");
            if (weights[i] != 0 && moved) {
                targets_.push_back({weights[i], GltfAccessor(document, *moved, GltfUse::Displacements)});
                if (targets_.back().displacements.count() != base_.count()) {
                    throw GltfRefusal{"a morph target has another number of vertices than its primitive"};
                }
            }
        }
    }

    [[nodiscard]] std::uint64_t count() const noexcept { return base_.count(); }

    [[nodiscard]] Vec3 at(std::uint64_t vertex) const {
        Vec3 position = base_.vector(vertex);
        for (const Target& target : targets_) {
            const Vec3 moved = target.displacements.vector(vertex);
            for (std::size_t i = 0; i < 3; ++i) {
                position[i] += target.weight * moved[i];
            }
        }
        return position;
    }

  private:
    struct Target {
        double weight;
        GltfAccessor displacements;
    };
    GltfAccessor base_;
    std::vector<Target> targets_;
};

class GltfReader {
  public:
    explicit GltfReader(const MeshSource& source) : document_(source), scene_(document_) {}

    MeshFile read() {
        const std::vector<GltfPlacement> placements = scene_.placements(file_.notes);
        checkTotal(placements);
        for (const GltfPlacement& placement : placements) {
            const GltfJson& mesh = document_.item("meshes", placement.mesh);
            const std::vector<double> weights = morphWeights(placement, mesh);
            const std::optional<std::vector<Mat4>> joints = jointsOf(placement);
            for (const GltfJson& primitive : objects(mesh, "primitives")) {
                addPrimitive(primitive, placement, weights, joints ? &*joints : nullptr);
            }
        }
        if (!document_.list("animations").empty()) {
            file_.notes.emplace_back("animations are left out: the mesh is as it stands before them");
        }
        return std::move(file_);
    }

  private:
    [[nodiscard]] static std::vector<double> weightsOf(const GltfJson& json) {
        const GltfJson* const weights = member(json, "weights");
        return weights == nullptr ? std::vector<double>() : *numbers(json, "weights", weights->size());
    }

    /// The node's, else the mesh's, else zero.
    [[nodiscard]] std::vector<double> morphWeights(const GltfPlacement& placement, const GltfJson& mesh) const {
        if (placement.node) {
            const GltfJson& node = document_.item("nodes", *placement.node);
            if (member(node, "weights") != nullptr) {
                return weightsOf(node);
            }
        }
        return weightsOf(mesh);
    }

    [[nodiscard]] std::optional<std::vector<Mat4>> jointsOf(const GltfPlacement& placement) {
        if (!placement.node) {
            return std::nullopt;
        }
        const std::optional<std::uint64_t> skin = natural(document_.item("nodes", *placement.node), "skin");
        return skin ? std::optional(jointMatrices(document_, scene_, *skin)) : std::nullopt;
    }

    void addPrimitive(const GltfJson& primitive, const GltfPlacement& placement, const std::vector<double>& weights,
                      const std::vector<Mat4>* joints) {
        const GltfJson* const attributes = member(primitive, "attributes");
        const std::optional<std::uint64_t> accessor =
            attributes == nullptr ? std::nullopt : natural(*attributes, "POSITION");
        if (!accessor) {
            throw GltfRefusal{"a primitive has no positions"};
        }
        const Mode mode = modeOf(primitive);
        const Positions positions(document_, primitive, *accessor, weights);
        std::optional<GltfAccessor> indices;
        if (const std::optional<std::uint64_t> index = natural(primitive, "indices")) {
            indices.emplace(document_, *index, GltfUse::Indices);
        }
        const std::uint64_t corners = indices ? indices->count() : positions.count();
        if (mode < Mode::Triangles) {
            file_.pointsAndLines += pointsOrLines(mode, corners);
            return;
        }
        const std::uint64_t triangles = trianglesOf(mode, corners);
        std::optional<GltfSkinning> skinning;
        if (joints != nullptr) {
            // A skinned mesh ignores the transform of its node.
            skinning.emplace(document_, *attributes, positions.count(), *joints);
        }
        used_.assign(positions.count(), kNoVertex);
        for (std::uint64_t triangle = 0; triangle < triangles; ++triangle) {
            std::array<std::uint64_t, 3> vertices = cornersOf(mode, triangle);
            for (std::uint64_t& vertex : vertices) {
                vertex = indices ? indices->natural(vertex, 0) : vertex;
                if (vertex >= positions.count()) {
                    throw GltfRefusal{"a triangle uses vertex " + std::to_string(vertex) + ", its primitive has " +
                                      std::to_string(positions.count())};
                }
            }
            const Mat4 turned = skinning ? skinning->worldFromVertex(vertices[0]) : placement.world_from_node;
            // Mirroring turns triangles inside out.
            if (determinant(turned) < 0) {
                std::swap(vertices[1], vertices[2]);
            }
            for (const std::uint64_t vertex : vertices) {
                addCorner(vertex, positions, skinning ? &*skinning : nullptr, placement.world_from_node);
            }
            file_.faceSizes.push_back(3);
        }
    }

    void addCorner(std::uint64_t vertex, const Positions& positions, const GltfSkinning* skinning,
                   const Mat4& world_from_node) {
        if (used_[vertex] == kNoVertex) {
            used_[vertex] = static_cast<std::uint32_t>(file_.vertices.size());
            file_.vertices.push_back(transformPoint(
                skinning != nullptr ? skinning->worldFromVertex(vertex) : world_from_node, positions.at(vertex)));
        }
        file_.corners.push_back(used_[vertex]);
    }

    /// Collects the attributes of a mesh's primitives. Adds to `stored` the number of elements of each accessor in the
    /// file.
    [[nodiscard]] std::uint64_t statedTriangles(std::uint64_t mesh, std::map<std::uint64_t, std::uint64_t>& stored) {
        std::uint64_t total = 0;
        for (const GltfJson& primitive : objects(document_.item("meshes", mesh), "primitives")) {
            const GltfJson* const attributes = member(primitive, "attributes");
            const std::optional<std::uint64_t> indices = natural(primitive, "indices");
            const std::optional<std::uint64_t> positions =
                attributes == nullptr ? std::nullopt : natural(*attributes, "POSITION");
            const std::optional<std::uint64_t> index = indices ? indices : positions;
            if (index && modeOf(primitive) >= Mode::Triangles) {
                const GltfAccessor accessor(document_, *index, indices ? GltfUse::Indices : GltfUse::Positions);
                stored[*index] = accessor.isStored() ? accessor.count() : 0;
                total += std::min(trianglesOf(modeOf(primitive), accessor.count()), kMostTriangles + 1);
            }
        }
        return std::min(total, kMostTriangles + 1);
    }

    /// Nodes may repeat a mesh, and primitives an accessor, so that a small file states any number of triangles.
    void checkTotal(const std::vector<GltfPlacement>& placements) {
        std::vector<std::optional<std::uint64_t>> stated(document_.list("meshes").size());
        std::map<std::uint64_t, std::uint64_t> stored;
        std::uint64_t total = 0;
        for (const GltfPlacement& placement : placements) {
            std::optional<std::uint64_t>& triangles = stated[placement.mesh];
            if (!triangles) {
                triangles = statedTriangles(placement.mesh, stored);
            }
            total += *triangles;
        }
        std::uint64_t most = std::uint64_t{1} << 24U;
        for (const auto& [accessor, elements] : stored) {
            most += elements;
        }
        if (total > std::min(most, kMostTriangles)) {
            throw GltfRefusal{"it repeats its meshes to " + std::to_string(total) + " triangles, more than " +
                              std::to_string(std::min(most, kMostTriangles))};
        }
    }

    GltfDocument document_;
    GltfScene scene_;
    MeshFile file_;
    std::vector<std::uint32_t> used_; ///< of the current primitive: positions of its vertices among the file's
};

} // namespace

Result<MeshFile> readGltf(const MeshSource& source) {
    try {
        return GltfReader(source).read();
    } catch (const GltfRefusal& refusal) {
        return cannotRead(source.path, refusal.reason);
    } catch (const GltfJson::exception& problem) {
        return cannotRead(source.path, "it is not a proper glTF file: " + jsonReason(problem.what()));
    }
}

} // namespace voxtact::io
