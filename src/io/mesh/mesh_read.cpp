// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "io/errors.h"
#include "io/mesh/mesh_census.h"
#include "voxtact/io.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

namespace voxtact::io {

namespace {

struct FaceCount {
    std::uint64_t triangles = 0;
    std::uint64_t others = 0; ///< points and lines
};

FaceCount countFaces(const aiScene& scene) {
    FaceCount count;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const unsigned corners = mesh.mFaces[f].mNumIndices;
            count.triangles += corners >= 3 ? corners - 2 : 0;
            count.others += corners < 3 ? 1 : 0;
        }
    }
    return count;
}

Mat4 toMat4(const aiMatrix4x4& matrix) {
    Mat4 result{};
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column) {
            result[std::size_t{4} * column + row] = static_cast<double>(matrix[row][column]);
        }
    }
    return result;
}

double determinant(const Mat4& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

Mat4 objectFromFile(const MeshReadOptions& options) {
    const double flip = options.space == MeshSpace::RAS ? -options.scale : options.scale;
    Mat4 matrix = identity();
    matrix[0] = flip;
    matrix[5] = flip;
    matrix[10] = options.scale;
    return matrix;
}

struct PositionHash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const noexcept {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : bits) {
            hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash);
    }
};

/// All triangles of the scene in one mesh; corners with the same bits become one vertex.
class Gatherer {
  public:
    Gatherer(const aiScene& scene, MeshData& mesh) : scene_(scene), mesh_(mesh) {}

    /// The reason why the scene cannot be used. Nodes nest as deeply as the file says, hence no recursion.
    std::optional<std::string> gather(const Mat4& object_from_file) {
        std::vector<std::pair<const aiNode*, Mat4>> pending{{scene_.mRootNode, object_from_file}};
        while (!pending.empty()) {
            const auto [node, object_from_parent] = pending.back();
            pending.pop_back();
            const Mat4 object_from_node = multiply(object_from_parent, toMat4(node->mTransformation));
            for (unsigned i = 0; i < node->mNumMeshes; ++i) {
                if (auto reason = add(*scene_.mMeshes[node->mMeshes[i]], object_from_node)) {
                    return reason;
                }
            }
            for (unsigned i = node->mNumChildren; i > 0; --i) {
                pending.emplace_back(node->mChildren[i - 1], object_from_node);
            }
        }
        return std::nullopt;
    }

  private:
    std::optional<std::string> add(const aiMesh& part, const Mat4& object_from_node) {
        // A mirroring node turns triangles inside out.
        const bool mirrored = determinant(object_from_node) < 0;
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) {
                continue;
            }
            for (const unsigned corner : {0U, mirrored ? 2U : 1U, mirrored ? 1U : 2U}) {
                const unsigned index = face.mIndices[corner];
                if (index >= part.mNumVertices) {
                    return "a triangle uses vertex " + std::to_string(index) + ", its mesh has " +
                           std::to_string(part.mNumVertices);
                }
                if (!addCorner(part.mVertices[index], object_from_node)) {
                    return "triangle " + std::to_string(mesh_.indices.size() / 3) +
                           " has a corner that is NaN, infinite, or too far away for a float";
                }
            }
        }
        constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
        return mesh_.indices.size() > kMost ? std::optional<std::string>("it has too many triangles") : std::nullopt;
    }

    bool addCorner(const aiVector3D& corner, const Mat4& object_from_node) {
        const Vec3 point =
            transformPoint(object_from_node, {static_cast<double>(corner.x), static_cast<double>(corner.y),
                                              static_cast<double>(corner.z)});
        std::array<std::uint32_t, 3> bits{};
        std::array<float, 3> position{};
        for (std::size_t i = 0; i < 3; ++i) {
            // Adding zero makes -0 a plain 0, which negated axes would otherwise keep apart.
            position[i] = static_cast<float>(point[i]) + 0.0F;
            if (!std::isfinite(position[i])) {
                return false;
            }
            bits[i] = std::bit_cast<std::uint32_t>(position[i]);
        }
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
        const auto [entry, isNew] = vertices_.try_emplace(bits, next);
        if (isNew) {
            mesh_.positions.insert(mesh_.positions.end(), position.begin(), position.end());
        }
        mesh_.indices.push_back(entry->second);
        return true;
    }

    const aiScene& scene_;
    MeshData& mesh_;
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PositionHash> vertices_;
};

/// The scene with polygons cut into triangles; refuses what is not what the file states.
Result<const aiScene*> import(Assimp::Importer& importer, const std::filesystem::path& path, MeshData& mesh) {
    const Result<std::uint64_t> stated = statedTriangles(path);
    if (!stated.ok()) {
        return stated.error();
    }
    if (*stated == 0) {
        return cannotRead(path, "it holds no triangle");
    }
    // Its own wish for speed is not ours: a mesh must not be split or sorted.
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        return cannotRead(path, oneLine(importer.GetErrorString()));
    }
    const FaceCount before = countFaces(*scene);
    if (before.triangles != *stated) {
        return cannotRead(path, "only " + std::to_string(before.triangles) + " of the " + std::to_string(*stated) +
                                    " triangles that it states can be used (indices out of range?); repair the file");
    }
    if (before.others != 0) {
        mesh.notes.push_back(std::to_string(before.others) + " points or lines left out");
    }
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (scene == nullptr || countFaces(*scene).triangles != *stated) {
        return cannotRead(path, "a polygon cannot be cut into triangles (it crosses itself?); triangulate the file");
    }
    return scene;
}

void noteBones(const aiScene& scene, MeshData& mesh) {
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        if (scene.mMeshes[i]->mNumBones != 0 || scene.mMeshes[i]->mNumAnimMeshes != 0) {
            mesh.notes.emplace_back("bones and morph targets are left out: the mesh is as it lies in the file");
            return;
        }
    }
}

} // namespace

Result<MeshData> readMesh(const std::filesystem::path& path, const MeshReadOptions& options) {
    return guard([&]() -> Result<MeshData> {
        if (!(options.scale > 0) || !std::isfinite(options.scale)) {
            return Error{ErrorCode::InvalidArgument, 0, "the scale of a mesh must be positive and finite"};
        }
        MeshData mesh;
        mesh.name = path.filename().string();
        Assimp::Importer importer;
        importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
        const Result<const aiScene*> scene = import(importer, path, mesh);
        if (!scene.ok()) {
            return scene.error();
        }
        noteBones(**scene, mesh);
        if (const auto reason = Gatherer(**scene, mesh).gather(objectFromFile(options))) {
            return cannotRead(path, *reason);
        }
        if (mesh.indices.empty()) {
            return cannotRead(path, "its scene holds no triangle");
        }
        return mesh;
    });
}

} // namespace voxtact::io
