// SPDX-License-Identifier: MIT
#pragma once

#include "device/session.h"
#include "view/frame/resources.h"
#include "view/state.h"
#include "voxtact/render.h"

#include <array>
#include <memory>

namespace voxtact::view {

/// Everything of voxtact's on the device: one upload for pictures, slices and answers.
class DeviceScene {
  public:
    /// Takes the volume, which has bricks and is editable; uploads the rest, and waits. `light`: of the fine picture.
    [[nodiscard]] static Result<std::unique_ptr<DeviceScene>> create(const device::Session& session, const State& state,
                                                                     Volume volume, const Lighting& light);

    /// Records holes, and the tables of a new transfer function, where there are others than before.
    [[nodiscard]] Result<void> cmdUpdate(VkCommandBuffer commands, const State& state);
    /// The commands of the last cmdUpdate() will not be executed.
    void forgetUpdate() {
        curve_.clear();
        written_ = writtenBefore_;
    }
    /// Paints the triangles of the last answer, in the pictures of a slot whose last use is done.
    void paint(const State& state, std::uint32_t slot);
    /// What a picture shows. Valid until the next call.
    [[nodiscard]] const Scene& scene(const State& state, std::uint32_t slot, bool fine, const Extent& extent);
    /// The pair that an answer is about. Valid until the next call.
    [[nodiscard]] Batch batch(const State& state);

    [[nodiscard]] const Volume& volume() const { return *volume_; }
    [[nodiscard]] const Renderer& renderer() const { return blocking_->renderer(); }
    [[nodiscard]] BlockingRenderer& blocking() { return *blocking_; }
    /// Null where there is no label map.
    [[nodiscard]] const LabelMap* labels() const { return labels_ ? &*labels_ : nullptr; }
    [[nodiscard]] std::uint32_t triangles() const { return mesh_->triangles(); }

  private:
    DeviceScene() = default;
    [[nodiscard]] Result<void> uploadFunctions(const device::Session& session, const State& state);
    [[nodiscard]] Result<void> uploadMesh(const device::Session& session, const State& state);

    // In the order in which they end, the last first.
    std::optional<BlockingRenderer> blocking_;
    std::optional<Volume> volume_;
    std::optional<RenderBricks> bricks_;
    std::optional<TransferFunction> function_;
    std::optional<RenderTransferFunction> fine_;
    std::optional<RenderTransferFunction> coarse_;
    std::optional<LabelMap> labels_;
    std::optional<Mesh> mesh_;
    std::optional<MeshNormals> normals_;
    HostBuffer masks_;
    std::size_t maskBytes_ = 0; ///< of a slot
    std::array<std::optional<PaintedTriangles>, kFramesInFlight> painted_;

    std::size_t written_ = 0;          ///< of State::writes
    std::size_t writtenBefore_ = 0;    ///< the last cmdUpdate()
    Curve curve_;                      ///< that the tables are of
    std::vector<ColourPoint> colours_; ///< the same
    Lighting light_;
    Scene scene_;
    BatchItem item_;
    Mat4 pose_{};
};

} // namespace voxtact::view
