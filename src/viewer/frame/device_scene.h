// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/resources.h"
#include "viewer/state.h"
#include "voxtact/render.h"
#include "vulkan/own/session.h"

#include <array>
#include <memory>
#include <mutex>

namespace voxtact::view {

/// A mesh on the device, with what paints its triangles.
class DeviceMesh {
  public:
    [[nodiscard]] static Result<DeviceMesh> create(const device::Session& session, const Renderer& renderer,
                                                   const MeshData& data);

    /// Paints exactly these triangles, in the pictures of a slot whose last use is complete.
    void paint(std::span<const std::uint32_t> triangles, std::uint32_t slot);
    /// Returns the mesh for a picture. Valid as long as this.
    [[nodiscard]] SceneMesh shown(const Instrument& instrument, std::uint32_t slot) const;
    [[nodiscard]] const Mesh& mesh() const { return *mesh_; }

  private:
    [[nodiscard]] Result<void> makeMasks(const device::Session& session, const Renderer& renderer);

    std::optional<Mesh> mesh_;
    std::optional<MeshNormals> normals_;
    HostBuffer masks_;
    std::size_t maskBytes_ = 0; ///< of a slot
    std::array<std::optional<PaintedTriangles>, kFramesInFlight> painted_;
};

/// Scene of a picture, with its other meshes. Movable, not copyable.
struct ShownScene {
    Scene scene;
    std::vector<SceneMesh> others;
};

/// The pairs of a question, one per instrument, and the objects that the batch points to. Movable, not copyable.
struct AskedPairs {
    std::vector<Mat4> poses;
    std::vector<BatchItem> items;
    Batch batch;
};

/// Everything of voxtact's on the device: one upload for pictures, slices and answers.
class DeviceScene {
  public:
    /// Takes the volume, which has bricks and is editable. Uploads the rest and waits. `light`: of the fine picture.
    [[nodiscard]] static Result<std::unique_ptr<DeviceScene>> create(const device::Session& session, const State& state,
                                                                     Volume volume, const Lighting& light);

    /// Records changed holes and the tables of a changed transfer function.
    [[nodiscard]] Result<void> cmdUpdate(VkCommandBuffer commands, const State& state);
    /// The commands of the last cmdUpdate() will not be executed.
    void forgetUpdate() {
        curve_.clear();
        written_ = writtenBefore_;
    }
    /// Number of the first unrecorded write in State::writes.
    [[nodiscard]] std::uint64_t written() const { return written_; }
    /// Paints the triangles of the last answer on all meshes, in the pictures of a slot whose last use is complete.
    void paint(const State& state, std::uint32_t slot);
    /// Returns the scene of a picture with the visible meshes. Valid as long as this.
    [[nodiscard]] ShownScene scene(const State& state, std::uint32_t slot, bool fine, const Extent& extent) const;
    /// Valid as long as this.
    [[nodiscard]] AskedPairs pairs(const Edit& edit) const;
    /// Lock for threads that record commands that use or change this: frames and concurrent answers.
    [[nodiscard]] std::mutex& recording() { return recording_; }

    [[nodiscard]] const Volume& volume() const { return *volume_; }
    [[nodiscard]] const Renderer& renderer() const { return blocking_->renderer(); }
    [[nodiscard]] BlockingRenderer& blocking() { return *blocking_; }
    /// Null where there is no label map.
    [[nodiscard]] const LabelMap* labels() const { return labels_ ? &*labels_ : nullptr; }
    /// Number of meshes, and of all their triangles.
    [[nodiscard]] std::uint32_t meshes() const { return static_cast<std::uint32_t>(meshes_.size()); }
    [[nodiscard]] std::uint64_t triangles() const;

  private:
    DeviceScene() = default;
    [[nodiscard]] Result<void> uploadFunctions(const device::Session& session, const State& state);

    // Destroyed in reverse order.
    std::optional<BlockingRenderer> blocking_;
    std::optional<Volume> volume_;
    std::optional<RenderBricks> bricks_;
    std::optional<TransferFunction> function_;
    std::optional<RenderTransferFunction> fine_;
    std::optional<RenderTransferFunction> coarse_;
    std::optional<LabelMap> labels_;
    std::vector<DeviceMesh> meshes_; ///< by their numbers in Sources::meshes

    std::uint64_t written_ = 0;        ///< of State::writes
    std::uint64_t writtenBefore_ = 0;  ///< the last cmdUpdate()
    Curve curve_;                      ///< that the tables are of
    std::vector<ColourPoint> colours_; ///< the same
    Lighting light_;
    View view_; ///< that answers in the view are of
    std::mutex recording_;
};

} // namespace voxtact::view
