// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/recentre.h"
#include "core/method/certified_constants.h"
#include "host/scene/scene_impl.h"
#include "host/scene/stored_voxels.h"

#include <atomic>
#include <cmath>

namespace voxtact::cpu {

namespace {

Result<void> checkSides(const Grid& grid) {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > kMaxSide) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "the volume has " + std::to_string(grid.size[axis]) + " voxels along " + kAxes[axis] +
                             ", the host engine takes at most " + std::to_string(kMaxSide)};
        }
    }
    return {};
}

} // namespace

std::uint64_t nextObjectId() noexcept {
    static std::atomic<std::uint64_t> next{1};
    return next.fetch_add(1, std::memory_order_relaxed);
}

VolumeImpl::VolumeImpl(const VolumeView& data)
    : grid(data.grid), type(data.type), texture_from_world(textureFromWorld(data.grid).value()),
      pairGrid(voxtact::pairGrid(data.grid, texture_from_world)), storedIntercept(cpu::storedIntercept(data.type)),
      image(data), bricks(image) {}

void VolumeImpl::edited(const VoxelBox& box) {
    bricks.update(image, box);
    id = nextObjectId();
}

Volume::Volume(std::unique_ptr<VolumeImpl> impl) noexcept : impl_(std::move(impl)) {}
Volume::Volume(Volume&&) noexcept = default;
Volume& Volume::operator=(Volume&&) noexcept = default;
Volume::~Volume() = default;

Result<Volume> Volume::create(const VolumeView& data) {
    return guard([&]() -> Result<Volume> {
        VOXTACT_TRY(checkSides(data.grid));
        VOXTACT_TRY(checkVolume(data));
        return Volume(std::make_unique<VolumeImpl>(data));
    });
}

const Grid& Volume::grid() const noexcept {
    return impl_->grid;
}

TransferFunction::TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept : impl_(std::move(impl)) {}
TransferFunction::TransferFunction(TransferFunction&&) noexcept = default;
TransferFunction& TransferFunction::operator=(TransferFunction&&) noexcept = default;
TransferFunction::~TransferFunction() = default;

Result<TransferFunction> TransferFunction::create(const TransferFunctionDesc& desc) {
    return guard([&]() -> Result<TransferFunction> {
        Result<std::vector<float>> table = sampleTable(desc);
        VOXTACT_TRY(table);
        auto impl = std::make_unique<TransferFunctionImpl>();
        impl->points.assign(desc.points.begin(), desc.points.end());
        impl->domain = tableDomain(desc);
        impl->table = std::move(*table);
        return TransferFunction(std::move(impl));
    });
}

Mesh::Mesh(std::unique_ptr<MeshImpl> impl) noexcept : impl_(std::move(impl)) {}
Mesh::Mesh(Mesh&&) noexcept = default;
Mesh& Mesh::operator=(Mesh&&) noexcept = default;
Mesh::~Mesh() = default;

Result<Mesh> Mesh::create(const MeshView& data) {
    return guard([&]() -> Result<Mesh> {
        const Result<CheckedMesh> mesh = checkedMesh(data);
        VOXTACT_TRY(mesh);
        return Mesh(std::make_unique<MeshImpl>(FloatMesh{mesh->positions, data.indices}, mesh->facts, mesh->origin));
    });
}

const MeshFacts& Mesh::facts() const noexcept {
    return impl_->facts;
}

Result<void> Mesh::update(std::span<const double> positions) {
    return guard([&]() -> Result<void> {
        if (positions.size() != std::size_t{3} * impl_->facts.vertices) {
            return refuse("the update has " + std::to_string(positions.size()) + " coordinates, the mesh has " +
                          std::to_string(impl_->facts.vertices) + " vertices of three");
        }
        const std::vector<std::uint32_t> indices = impl_->indices();
        const Result<CheckedMesh> mesh = checkedMesh({positions, indices, impl_->facts.deflection});
        VOXTACT_TRY(mesh);
        impl_->bend(mesh->positions, mesh->facts, mesh->origin);
        return {};
    });
}

} // namespace voxtact::cpu
