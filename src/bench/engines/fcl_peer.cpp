// SPDX-License-Identifier: MIT
#include "bench/engines/fcl_peer.h"

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/octree/collision/mesh_octree_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/octree/octree_solver.h>
#include <fcl/narrowphase/distance.h>
#include <octomap/octomap.h>

namespace voxtact::lab {

namespace {

/// OctoMap's keys: cell 32768 begins at the origin.
constexpr std::uint32_t kOriginKey = 32768;
constexpr std::uint32_t kKeys = 65536;
/// Log odds of a cell that is certainly occupied.
constexpr float kOccupied = 3;

template <class Scalar> fcl::Transform3<Scalar> transformOf(const FclMatrix& matrix) {
    fcl::Transform3<Scalar> out = fcl::Transform3<Scalar>::Identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            out.matrix()(row, column) = static_cast<Scalar>(matrix[static_cast<std::size_t>(4 * column + row)]);
        }
    }
    return out;
}

template <class Scalar> using Model = fcl::BVHModel<fcl::OBBRSS<Scalar>>;

template <class Scalar> std::shared_ptr<Model<Scalar>> modelOf(const FclMesh& from) {
    const auto vertex = [&from](std::uint32_t index) {
        const double* at = from.positions.data() + 3 * std::size_t{index};
        return fcl::Vector3<Scalar>(static_cast<Scalar>(at[0]), static_cast<Scalar>(at[1]), static_cast<Scalar>(at[2]));
    };
    auto mesh = std::make_shared<Model<Scalar>>();
    mesh->beginModel(static_cast<int>(from.indices.size() / 3));
    for (std::size_t i = 0; i < from.indices.size(); i += 3) {
        mesh->addTriangle(vertex(from.indices[i]), vertex(from.indices[i + 1]), vertex(from.indices[i + 2]));
    }
    mesh->endModel();
    return mesh;
}

void collide(const Model<double>& mesh, const fcl::Transform3d& world_from_mesh, const fcl::OcTreed& octree,
             const fcl::Transform3d& world_from_tree, const fcl::CollisionRequestd& request,
             fcl::CollisionResultd& result) {
    fcl::collide(&mesh, world_from_mesh, &octree, world_from_tree, request, result);
}

/// The part of fcl::collide() for these two. The whole function would compile all pairs of shapes, which libfcl has
/// only for double: a minute of compilation.
void collide(const Model<float>& mesh, const fcl::Transform3f& world_from_mesh, const fcl::OcTreef& octree,
             const fcl::Transform3f& world_from_tree, const fcl::CollisionRequestf& request,
             fcl::CollisionResultf& result) {
    using Solver = fcl::detail::GJKSolver_libccdf;
    Solver solver;
    solver.collision_tolerance = request.gjk_tolerance;
    const fcl::detail::OcTreeSolver<Solver> octreeSolver(&solver);
    fcl::detail::MeshOcTreeCollisionTraversalNode<fcl::OBBRSS<float>, Solver> node;
    fcl::detail::initialize(node, mesh, world_from_mesh, octree, world_from_tree, &octreeSolver, request, result);
    fcl::detail::collide(&node);
}

using Tree = std::shared_ptr<const octomap::OcTree>;

template <class Scalar> FclPeer makePeer(const Tree& tree, const FclMatrix& world_from_tree, const FclMesh& of) {
    const auto octree = std::make_shared<fcl::OcTree<Scalar>>(tree);
    return [mesh = modelOf<Scalar>(of), octree, world_from_tree](const FclMatrix& world_from_object) {
        const fcl::CollisionRequest<Scalar> request(1, false);
        fcl::CollisionResult<Scalar> result;
        collide(*mesh, transformOf<Scalar>(world_from_object), *octree, transformOf<Scalar>(world_from_tree), request,
                result);
        return result.isCollision();
    };
}

FclDistance makeDistance(const Tree& tree, const FclMatrix& world_from_tree, const FclMesh& of) {
    const auto octree = std::make_shared<fcl::OcTreed>(tree);
    return [mesh = modelOf<double>(of), octree, world_from_tree](const FclMatrix& world_from_object) {
        const fcl::DistanceRequestd request;
        fcl::DistanceResultd result;
        return fcl::distance(mesh.get(), transformOf<double>(world_from_object), octree.get(),
                             transformOf<double>(world_from_tree), request, result);
    };
}

FclMotion makeMotion(const Tree& tree, const FclMatrix& world_from_tree, const FclMesh& of) {
    const auto octree = std::make_shared<fcl::OcTreed>(tree);
    return [mesh = modelOf<double>(of), octree, still = transformOf<double>(world_from_tree)](
               const FclMatrix& from, const FclMatrix& to, FclOnTheWay how, unsigned poses) {
        const fcl::CCDSolverType solver =
            how == FclOnTheWay::Poses ? fcl::CCDC_NAIVE : fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
        const fcl::ContinuousCollisionRequestd request(poses, 1e-6, fcl::CCDM_SCREW, fcl::GST_LIBCCD, solver);
        fcl::ContinuousCollisionResultd result;
        const double at = fcl::continuousCollide(mesh.get(), transformOf<double>(from), transformOf<double>(to),
                                                 octree.get(), still, still, request, result);
        return at < 0 || result.is_collide ? at : 1.0;
    };
}

} // namespace

std::shared_ptr<const FclVolume> makeFclVolume(const FclCells& cells, std::string& why) {
    std::array<std::uint32_t, 3> first{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (cells.size[axis] > kKeys) {
            why = "the octree would have more than 65536 cells per side";
            return nullptr;
        }
        first[axis] = kOriginKey - cells.size[axis] / 2;
    }
    auto tree = std::make_shared<octomap::OcTree>(cells.side);
    std::size_t cell = 0;
    for (std::uint32_t z = 0; z < cells.size[2]; ++z) {
        for (std::uint32_t y = 0; y < cells.size[1]; ++y) {
            for (std::uint32_t x = 0; x < cells.size[0]; ++x, ++cell) {
                if ((*cells.occupied)[cell]) {
                    const octomap::OcTreeKey key(static_cast<octomap::key_type>(first[0] + x),
                                                 static_cast<octomap::key_type>(first[1] + y),
                                                 static_cast<octomap::key_type>(first[2] + z));
                    tree->setNodeValue(key, kOccupied, true);
                }
            }
        }
    }
    tree->updateInnerOccupancy();
    tree->prune();
    const auto with = [tree = Tree(std::move(tree)), at = cells.world_from_tree](auto make) {
        return [tree, at, make](const FclMesh& mesh) { return make(tree, at, mesh); };
    };
    return std::make_shared<const FclVolume>(
        FclVolume{.version = std::string("FCL ") + FCL_VERSION,
                  .peer = [one = with(makePeer<float>), two = with(makePeer<double>)](
                              const FclMesh& mesh,
                              FclScalar scalar) { return scalar == FclScalar::Float ? one(mesh) : two(mesh); },
                  .distance = with(makeDistance),
                  .motion = with(makeMotion)});
}

} // namespace voxtact::lab
