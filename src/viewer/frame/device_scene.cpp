// SPDX-License-Identifier: MIT
#include "viewer/frame/device_scene.h"

#include "core/base/try.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace voxtact::view {

namespace {

constexpr std::size_t kAlignment = 256; // required by PaintedTriangles::wrap()
constexpr Colour kBackground{0.055, 0.062, 0.075};

/// Steps of half a voxel in a fine picture, of a voxel in a coarse one.
RenderTransferFunctionDesc renderDesc(const State& state, bool fine) {
    const Document& document = state.document;
    RenderTransferFunctionDesc desc;
    desc.opacity = {document.edit.curve, document.domain, document.tableSize};
    desc.colours = document.edit.colours;
    desc.step = *std::ranges::min_element(state.volume.grid.spacing) * (fine ? 0.5 : 1);
    return desc;
}

double diagonalOf(const Grid& grid) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sum += std::pow(grid.spacing[axis] * grid.size[axis], 2);
    }
    return std::sqrt(sum);
}

} // namespace

Result<DeviceMesh> DeviceMesh::create(const device::Session& session, const Renderer& renderer, const MeshData& data) {
    const QueueAccess queue = session.device.queueAccess();
    // Returns the same triangles in the same order, with sharp edges.
    const Result<MeshData> creased = splitAtCreases(data.view());
    VOXTACT_TRY(creased);
    DeviceMesh out;
    Result<Mesh> mesh = Mesh::upload(session.context, queue, creased->view(), {.clusters = true});
    VOXTACT_TRY(mesh);
    out.mesh_ = std::move(*mesh);
    Result<MeshNormals> normals = MeshNormals::upload(renderer, queue, creased->view());
    VOXTACT_TRY(normals);
    out.normals_ = std::move(*normals);
    VOXTACT_TRY(out.makeMasks(session, renderer));
    return out;
}

Result<void> DeviceMesh::makeMasks(const device::Session& session, const Renderer& renderer) {
    const std::size_t words = (std::size_t{mesh_->triangles()} + 31) / 32;
    maskBytes_ = (words * sizeof(std::uint32_t) + kAlignment - 1) / kAlignment * kAlignment;
    Result<HostBuffer> masks =
        HostBuffer::create(session.device, kFramesInFlight * maskBytes_, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    VOXTACT_TRY(masks);
    masks_ = std::move(*masks);
    std::ranges::fill(masks_.bytes(), std::byte{});
    for (std::uint32_t slot = 0; slot < kFramesInFlight; ++slot) {
        Result<PaintedTriangles> painted =
            PaintedTriangles::wrap(renderer, {masks_.handle(), slot * maskBytes_, maskBytes_});
        if (painted.ok()) { // else, without geometry shaders, nothing is painted
            painted_[slot] = std::move(*painted);
        }
    }
    return {};
}

void DeviceMesh::paint(std::span<const std::uint32_t> triangles, std::uint32_t slot) {
    const std::span<std::byte> mask = masks_.bytes().subspan(slot * maskBytes_, maskBytes_);
    std::ranges::fill(mask, std::byte{});
    for (const std::uint32_t triangle : triangles) {
        // Lowest bits first, in words of the machine's order: in bytes too, on machines that Vulkan runs on.
        mask[triangle / 8] |= std::byte{1} << (triangle % 8);
    }
}

SceneMesh DeviceMesh::shown(const Instrument& instrument, std::uint32_t slot) const {
    SceneMesh out;
    out.mesh = &*mesh_;
    out.normals = &*normals_;
    out.world_from_object = instrument.world_from_object;
    out.meshColour = meshColour(instrument.mesh);
    if (painted_[slot]) {
        out.paint.what = Paint::Triangles;
        out.paint.triangles = &*painted_[slot];
        out.paint.through = 0.45;
    }
    return out;
}

Result<std::unique_ptr<DeviceScene>> DeviceScene::create(const device::Session& session, const State& state,
                                                         Volume volume, const Lighting& light) {
    std::unique_ptr<DeviceScene> scene(new DeviceScene);
    const QueueAccess queue = session.device.queueAccess();
    scene->light_ = light;
    scene->view_ = answerView(state.volume.grid);
    Result<BlockingRenderer> blocking = BlockingRenderer::create(session.context, queue);
    VOXTACT_TRY(blocking);
    scene->blocking_ = std::move(*blocking);
    scene->volume_ = std::move(volume);
    Result<RenderBricks> bricks = RenderBricks::create(scene->renderer(), *scene->volume_);
    VOXTACT_TRY(bricks);
    scene->bricks_ = std::move(*bricks);
    if (state.labels) {
        Result<LabelMap> labels = LabelMap::upload(session.context, queue, state.labels->map);
        VOXTACT_TRY(labels);
        scene->labels_ = std::move(*labels);
    }
    VOXTACT_TRY(scene->uploadFunctions(session, state));
    for (const MeshData& data : state.meshes) {
        Result<DeviceMesh> mesh = DeviceMesh::create(session, scene->renderer(), data);
        VOXTACT_TRY(mesh);
        scene->meshes_.push_back(std::move(*mesh));
    }
    return scene;
}

Result<void> DeviceScene::uploadFunctions(const device::Session& session, const State& state) {
    const QueueAccess queue = session.device.queueAccess();
    curve_ = state.document.edit.curve;
    colours_ = state.document.edit.colours;
    Result<TransferFunction> function =
        TransferFunction::upload(session.context, queue, renderDesc(state, true).opacity);
    VOXTACT_TRY(function);
    function_ = std::move(*function);
    Result<RenderTransferFunction> fine = RenderTransferFunction::upload(renderer(), queue, renderDesc(state, true));
    VOXTACT_TRY(fine);
    fine_ = std::move(*fine);
    Result<RenderTransferFunction> coarse = RenderTransferFunction::upload(renderer(), queue, renderDesc(state, false));
    VOXTACT_TRY(coarse);
    coarse_ = std::move(*coarse);
    return {};
}

Result<void> DeviceScene::cmdUpdate(VkCommandBuffer commands, const State& state) {
    writtenBefore_ = written_;
    for (const HoleWrite& write : state.writes.from(written_)) {
        VOXTACT_TRY(volume_->cmdWrite(commands, write.hole->box, write.voxels()));
        ++written_;
    }
    const Curve& curve = state.document.edit.curve;
    const std::vector<ColourPoint>& colours = state.document.edit.colours;
    if (sameCurve(curve, curve_) && sameColours(colours, colours_)) {
        return {};
    }
    VOXTACT_TRY(function_->cmdUpdate(commands, renderDesc(state, true).opacity));
    VOXTACT_TRY(fine_->cmdUpdate(commands, renderDesc(state, true)));
    VOXTACT_TRY(coarse_->cmdUpdate(commands, renderDesc(state, false)));
    curve_ = curve;
    colours_ = colours;
    return {};
}

void DeviceScene::paint(const State& state, std::uint32_t slot) {
    for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) {
        const MeshAnswer* answer = state.answer ? state.answer->of(mesh) : nullptr;
        meshes_[mesh].paint(answer == nullptr ? std::span<const std::uint32_t>() : answer->triangles, slot);
    }
}

ShownScene DeviceScene::scene(const State& state, std::uint32_t slot, bool fine, const Extent& extent) const {
    ShownScene out;
    for (const Instrument& instrument : state.document.edit.instruments) {
        if (!instrument.shown) {
            continue;
        }
        const SceneMesh mesh = meshes_[instrument.mesh].shown(instrument, slot);
        if (out.scene.mesh == nullptr) {
            static_cast<SceneMesh&>(out.scene) = mesh;
        } else {
            out.others.push_back(mesh);
        }
    }
    out.scene.others = out.others;
    out.scene.volume = &*volume_;
    out.scene.bricks = &*bricks_;
    out.scene.transferFunction = fine ? &*fine_ : &*coarse_;
    out.scene.lighting = light_;
    if (!fine) {
        out.scene.lighting.occlusion = 0;
    }
    out.scene.clip_from_world = clipFromWorld(state.camera, extent, 2 * diagonalOf(state.volume.grid));
    out.scene.background = kBackground;
    return out;
}

std::uint64_t DeviceScene::triangles() const {
    std::uint64_t sum = 0;
    for (const DeviceMesh& mesh : meshes_) {
        sum += mesh.mesh().triangles();
    }
    return sum;
}

AskedPairs DeviceScene::pairs(const Edit& edit) const {
    AskedPairs out;
    const std::vector<Instrument>& instruments = edit.instruments;
    for (const Instrument& instrument : instruments) {
        out.poses.push_back(instrument.world_from_object);
    }
    for (std::size_t i = 0; i < instruments.size(); ++i) {
        const Mesh& mesh = meshes_[instruments[i].mesh].mesh();
        out.items.push_back({&mesh, &*volume_, &*function_, {&out.poses[i], 1}, labels()});
    }
    out.batch.items = out.items;
    out.batch.view = view_;
    out.batch.threshold = edit.threshold;
    return out;
}

} // namespace voxtact::view
