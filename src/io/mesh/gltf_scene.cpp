// SPDX-License-Identifier: MIT
#include "io/mesh/gltf_scene.h"

#include <cmath>

namespace voxtact::io {

namespace {

Mat4 translationAndScale(const std::vector<double>& translation, const std::vector<double>& scale) {
    Mat4 matrix = identity();
    for (std::size_t i = 0; i < 3; ++i) {
        matrix[5 * i] = scale[i];
        matrix[12 + i] = translation[i];
    }
    return matrix;
}

/// Returns the rotation of a unit quaternion x, y, z, w.
Mat4 rotation(const std::vector<double>& quaternion, const std::string& node) {
    const double length =
        std::hypot(std::hypot(quaternion[0], quaternion[1]), std::hypot(quaternion[2], quaternion[3]));
    constexpr double kTolerance = 1e-2;
    if (!(std::abs(length - 1) <= kTolerance)) {
        throw GltfRefusal{node + " has a rotation whose length is not 1"};
    }
    const double x = quaternion[0] / length;
    const double y = quaternion[1] / length;
    const double z = quaternion[2] / length;
    const double w = quaternion[3] / length;
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + w * z),
            2 * (x * z - w * y),
            0,
            2 * (x * y - w * z),
            1 - 2 * (x * x + z * z),
            2 * (y * z + w * x),
            0,
            2 * (x * z + w * y),
            2 * (y * z - w * x),
            1 - 2 * (x * x + y * y),
            0,
            0,
            0,
            0,
            1};
}

Mat4 parentFromNode(const GltfJson& json, const std::string& node) {
    const auto matrix = numbers(json, "matrix", 16);
    const auto translation = numbers(json, "translation", 3);
    const auto quaternion = numbers(json, "rotation", 4);
    const auto scale = numbers(json, "scale", 3);
    if (matrix) {
        if (translation || quaternion || scale) {
            throw GltfRefusal{node + " has a matrix and a translation, rotation or scale"};
        }
        Mat4 result{};
        std::copy(matrix->begin(), matrix->end(), result.begin());
        if (result[3] != 0 || result[7] != 0 || result[11] != 0 || result[15] != 1) {
            throw GltfRefusal{node + " has a matrix whose last row is not 0 0 0 1"};
        }
        return result;
    }
    Mat4 result = translationAndScale(translation.value_or(std::vector<double>(3, 0)), {1, 1, 1});
    if (quaternion) {
        result = multiply(result, rotation(*quaternion, node));
    }
    return scale ? multiply(result, translationAndScale({0, 0, 0}, *scale)) : result;
}

/// With all descendants.
bool isHidden(const GltfJson& node) {
    const GltfJson* const extensions = member(node, "extensions");
    const GltfJson* const visibility = extensions == nullptr ? nullptr : member(*extensions, "KHR_node_visibility");
    return visibility != nullptr && member(*visibility, "visible") != nullptr && !flag(*visibility, "visible");
}

} // namespace

GltfScene::GltfScene(const GltfDocument& document) : document_(document) {
    takeTree();
    takeTransforms();
}

void GltfScene::takeTree() {
    const std::size_t count = document_.list("nodes").size();
    children_.resize(count);
    isChild_.resize(count);
    for (std::size_t node = 0; node < count; ++node) {
        children_[node] = naturals(document_.item("nodes", node), "children");
        for (const std::uint64_t child : children_[node]) {
            if (child >= count) {
                throw GltfRefusal{"it refers to node " + std::to_string(child) + ", which does not exist"};
            }
            if (isChild_[child]) {
                throw GltfRefusal{"node " + std::to_string(child) + " is below two nodes"};
            }
            isChild_[child] = true;
        }
    }
}

/// Nodes nest as deeply as the file says, hence no recursion.
void GltfScene::takeTransforms() {
    world_from_node_.assign(children_.size(), identity());
    std::size_t reached = 0;
    std::vector<std::pair<std::uint64_t, Mat4>> pending;
    for (std::uint64_t root = 0; root < children_.size(); ++root) {
        if (!isChild_[root]) {
            pending.emplace_back(root, identity());
        }
        while (!pending.empty()) {
            const auto [node, world_from_parent] = pending.back();
            pending.pop_back();
            ++reached;
            world_from_node_[node] = multiply(
                world_from_parent, parentFromNode(document_.item("nodes", node), "node " + std::to_string(node)));
            for (const std::uint64_t child : children_[node]) {
                pending.emplace_back(child, world_from_node_[node]);
            }
        }
    }
    if (reached != children_.size()) {
        throw GltfRefusal{"some of its nodes are below themselves"};
    }
}

const Mat4& GltfScene::worldFromNode(std::uint64_t node) const {
    if (node >= world_from_node_.size()) {
        throw GltfRefusal{"it refers to node " + std::to_string(node) + ", which does not exist"};
    }
    return world_from_node_[node];
}

std::vector<std::uint64_t> GltfScene::roots(std::vector<std::string>& notes) const {
    const std::size_t scenes = document_.list("scenes").size();
    const std::optional<std::uint64_t> named = natural(document_.root(), "scene");
    if (scenes == 0 && !named) {
        std::vector<std::uint64_t> all;
        for (std::uint64_t node = 0; node < isChild_.size(); ++node) {
            if (!isChild_[node]) {
                all.push_back(node);
            }
        }
        notes.emplace_back("the file has no scene: all its nodes are taken");
        return all;
    }
    const std::uint64_t scene = named.value_or(0);
    if (scenes > 1) {
        notes.push_back("scene " + std::to_string(scene) + " of " + std::to_string(scenes) +
                        " is taken, counted from 0");
    }
    std::vector<std::uint64_t> nodes = naturals(document_.item("scenes", scene), "nodes");
    std::vector<bool> seen(isChild_.size());
    for (const std::uint64_t node : nodes) {
        if (node >= isChild_.size() || isChild_[node] || seen[node]) {
            throw GltfRefusal{"scene " + std::to_string(scene) + " has node " + std::to_string(node) +
                              ", which does not exist, is below another, or is there twice"};
        }
        seen[node] = true;
    }
    return nodes;
}

std::vector<GltfPlacement> GltfScene::placements(std::vector<std::string>& notes) const {
    std::vector<GltfPlacement> placed;
    const std::size_t meshes = document_.list("meshes").size();
    if (document_.list("scenes").empty() && children_.empty()) {
        for (std::uint64_t mesh = 0; mesh < meshes; ++mesh) {
            placed.push_back({mesh, std::nullopt});
        }
        if (meshes != 0) {
            notes.emplace_back("the file has no scene and no nodes: all its meshes are taken as they are");
        }
        return placed;
    }
    std::vector<std::uint64_t> pending = roots(notes);
    std::reverse(pending.begin(), pending.end());
    std::vector<bool> isPlaced(meshes);
    std::uint64_t hidden = 0;
    while (!pending.empty()) {
        const std::uint64_t node = pending.back();
        pending.pop_back();
        const GltfJson& json = document_.item("nodes", node);
        if (const GltfJson* const extensions = member(json, "extensions");
            extensions != nullptr && extensions->contains("EXT_mesh_gpu_instancing")) {
            throw GltfRefusal{"node " + std::to_string(node) +
                              " is repeated by EXT_mesh_gpu_instancing, which is not supported; export it without"};
        }
        if (isHidden(json)) {
            ++hidden;
            continue;
        }
        if (const std::optional<std::uint64_t> mesh = natural(json, "mesh")) {
            static_cast<void>(document_.item("meshes", *mesh));
            placed.push_back({*mesh, node, world_from_node_[node]});
            isPlaced[*mesh] = true;
        }
        pending.insert(pending.end(), children_[node].rbegin(), children_[node].rend());
    }
    if (hidden != 0) {
        notes.push_back(std::to_string(hidden) + (hidden == 1 ? " hidden node" : " hidden nodes") +
                        " (KHR_node_visibility) left out, with what is below");
    }
    if (const auto left = std::count(isPlaced.begin(), isPlaced.end(), false); left != 0) {
        notes.push_back(std::to_string(left) + " meshes that are not in the scene left out");
    }
    return placed;
}

} // namespace voxtact::io
