// SPDX-License-Identifier: MIT
#include "io/mesh/gltf_skin.h"

#include <cmath>

namespace voxtact::io {

std::vector<Mat4> jointMatrices(GltfDocument& document, const GltfScene& scene, std::uint64_t skin) {
    const GltfJson& json = document.item("skins", skin);
    const std::vector<std::uint64_t> joints = naturals(json, "joints");
    std::optional<GltfAccessor> bound;
    if (const std::optional<std::uint64_t> accessor = natural(json, "inverseBindMatrices")) {
        bound.emplace(document, *accessor, GltfUse::Matrices);
        if (bound->count() < joints.size()) {
            throw GltfRefusal{"skin " + std::to_string(skin) + " has " + std::to_string(joints.size()) +
                              " joints and only " + std::to_string(bound->count()) + " inverse bind matrices"};
        }
    }
    std::vector<Mat4> matrices;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const Mat4 inverseBind = bound ? bound->matrix(i) : identity();
        constexpr double kTolerance = 1e-5;
        if (!(std::abs(inverseBind[3]) <= kTolerance && std::abs(inverseBind[7]) <= kTolerance &&
              std::abs(inverseBind[11]) <= kTolerance && std::abs(inverseBind[15] - 1) <= kTolerance)) {
            throw GltfRefusal{"skin " + std::to_string(skin) + ": the last row of inverse bind matrix " +
                              std::to_string(i) + " is not 0 0 0 1"};
        }
        matrices.push_back(multiply(scene.worldFromNode(joints[i]), inverseBind));
    }
    return matrices;
}

GltfSkinning::GltfSkinning(GltfDocument& document, const GltfJson& attributes, std::uint64_t vertices,
                           const std::vector<Mat4>& joints)
    : matrices_(joints) {
    for (std::size_t set = 0;; ++set) {
        const std::optional<std::uint64_t> joint = natural(attributes, ("JOINTS_" + std::to_string(set)).c_str());
        const std::optional<std::uint64_t> weight = natural(attributes, ("WEIGHTS_" + std::to_string(set)).c_str());
        if (!joint && !weight && set > 0) {
            return;
        }
        if (!joint || !weight) {
            throw GltfRefusal{"a node has a skin, but its mesh has no joints or weights (JOINTS_" +
                              std::to_string(set) + ", WEIGHTS_" + std::to_string(set) +
                              "); export it without the skin"};
        }
        sets_.push_back(
            {GltfAccessor(document, *joint, GltfUse::Joints), GltfAccessor(document, *weight, GltfUse::Weights)});
        if (sets_.back().joints.count() != vertices || sets_.back().weights.count() != vertices) {
            throw GltfRefusal{"a primitive has " + std::to_string(vertices) +
                              " positions and another number of joints"
                              " or weights"};
        }
    }
}

Mat4 GltfSkinning::worldFromVertex(std::uint64_t vertex) const {
    Mat4 sum{};
    double total = 0;
    for (const Set& set : sets_) {
        for (std::size_t i = 0; i < 4; ++i) {
            const double weight = set.weights.number(vertex, i);
            const std::uint32_t joint = set.joints.natural(vertex, i);
            if (!(weight >= 0)) {
                throw GltfRefusal{"vertex " + std::to_string(vertex) + " of a skinned mesh has a negative weight"};
            }
            if (weight == 0) {
                continue;
            }
            if (joint >= matrices_.size()) {
                throw GltfRefusal{"vertex " + std::to_string(vertex) + " of a skinned mesh has joint " +
                                  std::to_string(joint) + ", its skin has " + std::to_string(matrices_.size())};
            }
            for (std::size_t k = 0; k < sum.size(); ++k) {
                sum[k] += weight * matrices_[joint][k];
            }
            total += weight;
        }
    }
    constexpr double kTolerance = 1e-2;
    if (!(std::abs(total - 1) <= kTolerance)) {
        throw GltfRefusal{"the weights of vertex " + std::to_string(vertex) + " of a skinned mesh do not sum to 1"};
    }
    for (double& entry : sum) {
        entry /= total;
    }
    return sum;
}

} // namespace voxtact::io
