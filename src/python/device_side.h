// SPDX-License-Identifier: MIT
#pragma once

#include "device.h"
#include "edits.h"
#include "pictures.h"
#include "request.h"
#include "voxtact/detector.h"

#include <map>
#include <memory>
#include <span>

namespace voxtact::python {

/// A scene on a Vulkan device: what is on the device, in the order in which it is made. One call at a time.
class DeviceSide {
  public:
    DeviceSide(std::shared_ptr<Device> device, const VolumeView& volume, const OpacityDesc& opacity,
               const LabelData* labels);

    void setOpacity(const OpacityDesc& opacity);
    void edit(const Edit& edit);
    /// `labels`: those that clearances are measured to.
    [[nodiscard]] BatchAnswer detect(const Request& request, std::size_t first, std::size_t count,
                                     const Question& question, double threshold,
                                     std::span<const std::int32_t> labels = {});
    /// `first` and `count` are of segments, and the question has a `motion`.
    [[nodiscard]] MotionAnswer move(const Request& request, std::size_t first, std::size_t count,
                                    const Question& question, double threshold);
    /// Pairs of one call, at most: their outputs, and clearances to so many labels, must have room.
    [[nodiscard]] static std::size_t mostPairs(const Request& request, const Question& question,
                                               std::size_t labels = 0) noexcept;
    /// `progress` is called after some rows each; it may throw, which ends the picture.
    [[nodiscard]] Picture picture(const PictureWish& wish, const OpacityDesc& opacity);
    [[nodiscard]] const std::shared_ptr<Device>& device() const noexcept { return device_; }

  private:
    struct Drawn {
        Mesh mesh;
        MeshNormals normals;
    };
    struct Uploaded {
        std::weak_ptr<const Shape> owner;
        std::optional<Mesh> asked; ///< for detection
        std::optional<Drawn> drawn;
    };

    [[nodiscard]] BlockingDetector& detectorFor(const Question& question);
    [[nodiscard]] Uploaded& uploaded(const std::shared_ptr<const Shape>& shape);
    [[nodiscard]] const Mesh& onDevice(const std::shared_ptr<const Shape>& shape);
    [[nodiscard]] const Drawn& drawn(const std::shared_ptr<const Shape>& shape);
    /// Of each pair, where they are shown.
    [[nodiscard]] std::vector<PaintedTriangles> paint(const PictureWish& wish);
    [[nodiscard]] RenderTransferFunction upload(const PictureWish& wish, const OpacityDesc& opacity);

    std::shared_ptr<Device> device_;
    Volume volume_;
    TransferFunction function_;
    std::optional<LabelMap> labels_;
    std::map<const Shape*, Uploaded> meshes_;
    std::map<Question::Key, BlockingDetector> detectors_;
    std::optional<BlockingRenderer> renderer_;
    std::optional<RenderBricks> bricks_;
};

} // namespace voxtact::python
