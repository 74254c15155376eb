// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/fcl_peer.h"
#include "bench/measure/machine.h"
#include "core/base/try.h"
#include "voxtact/cpu.h"
#include "voxtact/detector.h"

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::lab {

/// Puts what was made, if it was, where it belongs: in a Part, or an optional one.
template <class Part, class Place> [[nodiscard]] Result<void> put(Result<Part> made, Place& place) {
    VOXTACT_TRY(made);
    if constexpr (std::same_as<Place, Part>) {
        place = std::move(*made);
    } else {
        place.emplace(std::move(*made));
    }
    return {};
}

/// Source of data in options: a path, or builtin:NAME.
struct Loaders {
    std::function<Result<VolumeData>(const std::string& source)> volume;
    std::function<Result<MeshData>(const std::string& source)> mesh;
};

/// A volume with its opacity: in host memory, and the objects of the engines.
struct VolumePart {
    std::string name; ///< a path, or builtin:NAME
    VolumeData data;
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;
    double threshold = kDefaultThreshold;
    LabelData labels{}; ///< may be empty
    std::optional<cpu::Volume> host{};
    std::optional<cpu::TransferFunction> hostFunction{};
    std::optional<Volume> device{};
    std::optional<TransferFunction> deviceFunction{};
    std::optional<LabelMap> deviceLabels{};
    std::shared_ptr<const FclVolume> fcl{};

    [[nodiscard]] TransferFunctionDesc transferFunction() const { return {points, domain, tableSize}; }
};

/// A mesh, the same.
struct MeshPart {
    std::string name;
    MeshData data;
    std::optional<cpu::Mesh> host{};
    std::optional<Mesh> device{};

    [[nodiscard]] std::uint32_t triangles() const { return static_cast<std::uint32_t>(data.indices.size() / 3); }
};

/// A measured scene: a mesh at poses against a volume, and the camera of projections that have one. Copies share the
/// parts. Objects on a device must end before the device: the session outlives the scenes prepared for it, or a
/// DeviceStay ends before it.
struct Scene {
    std::shared_ptr<VolumePart> volume;
    std::shared_ptr<MeshPart> mesh;
    std::vector<Mat4> poses;
    std::vector<std::uint32_t> poseNumbers; ///< of each pose, in the whole list
    std::string posesFrom;                  ///< "random, seed 1", or a path
    View view;

    /// `count` of the poses, spread evenly.
    [[nodiscard]] Scene withPoses(std::uint32_t count) const;
};

/// For a scene that outlives its session: the end of the stay, even by an exception, removes the scene from the device.
class DeviceStay {
  public:
    explicit DeviceStay(const Scene& scene) noexcept : volume_(*scene.volume), mesh_(*scene.mesh) {}
    DeviceStay(const DeviceStay&) = delete;
    DeviceStay& operator=(const DeviceStay&) = delete;
    ~DeviceStay();

  private:
    VolumePart& volume_;
    MeshPart& mesh_;
};

/// `count` numbers below `total`, spread evenly; all of them when there are no more.
[[nodiscard]] std::vector<std::uint32_t> spreadEvenly(std::uint32_t count, std::uint32_t total);

/// In the form of --opacity: "40:0,80:1".
[[nodiscard]] std::string opacityText(std::span<const ControlPoint> points);

/// Creates the host engine's objects, once.
[[nodiscard]] Result<void> makeHost(VolumePart& volume);
/// Uploads the objects of device methods, including labels, if any.
[[nodiscard]] Result<void> upload(const device::Session& session, const VolumeOptions& options, VolumePart& volume);
/// Does both. Returns LimitExceeded if the volume exceeds the device, InvalidArgument (--tf-size) if the table does.
[[nodiscard]] Result<void> makeReady(const device::Session& session, const VolumeOptions& options, VolumePart& volume);
/// For the host engine, and for the device unless `session` is null.
[[nodiscard]] Result<void> makeReady(const device::Session* session, MeshPart& mesh);
/// A whole scene, whose viewport is checked as below.
[[nodiscard]] Result<void> makeReady(const device::Session& session, const Scene& scene,
                                     const VolumeOptions& options = {});

/// Refuses a viewport beyond the limits of device or host.
[[nodiscard]] Result<void> checkViewport(const device::Session& session, const VkExtent2D& size);

} // namespace voxtact::lab
