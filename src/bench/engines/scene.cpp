// SPDX-License-Identifier: MIT
#include "bench/engines/scene.h"

#include "bench/measure/numbers.h"
#include "core/base/refuse.h"
#include "core/base/text.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

Result<void> uploadTable(const device::Session& session, VolumePart& volume) {
    return put(TransferFunction::upload(session.context, session.device.queueAccess(), volume.transferFunction()),
               volume.deviceFunction);
}

Result<void> uploadVoxels(const device::Session& session, const VolumeOptions& options, VolumePart& volume) {
    const QueueAccess queue = session.device.queueAccess();
    VOXTACT_TRY(put(Volume::upload(session.context, queue, volume.data.view(), options), volume.device));
    return volume.labels.values.empty()
               ? Result<void>()
               : put(LabelMap::upload(session.context, queue, volume.labels), volume.deviceLabels);
}

} // namespace

std::vector<std::uint32_t> spreadEvenly(std::uint32_t count, std::uint32_t total) {
    std::vector<std::uint32_t> numbers;
    const std::uint32_t taken = std::min(count, total);
    for (std::uint32_t i = 0; i < taken; ++i) {
        numbers.push_back(static_cast<std::uint32_t>(std::uint64_t{i} * total / taken));
    }
    return numbers;
}

std::string opacityText(std::span<const ControlPoint> points) {
    std::string text;
    for (const ControlPoint& point : points) {
        text += (text.empty() ? "" : ",") + number(point.value) + ":" + number(point.opacity);
    }
    return text;
}

Scene Scene::withPoses(std::uint32_t count) const {
    Scene some{volume, mesh, {}, {}, posesFrom, view};
    for (const std::uint32_t index : spreadEvenly(count, static_cast<std::uint32_t>(poses.size()))) {
        some.poses.push_back(poses[index]);
        some.poseNumbers.push_back(poseNumbers[index]);
    }
    return some;
}

DeviceStay::~DeviceStay() {
    volume_.deviceLabels.reset();
    volume_.deviceFunction.reset();
    volume_.device.reset();
    mesh_.device.reset();
}

Result<void> makeHost(VolumePart& volume) {
    if (volume.host) {
        return {};
    }
    VOXTACT_TRY(put(cpu::Volume::create(volume.data.view()), volume.host));
    return put(cpu::TransferFunction::create(volume.transferFunction()), volume.hostFunction);
}

Result<void> upload(const device::Session& session, const VolumeOptions& options, VolumePart& volume) {
    Result<void> voxels = uploadVoxels(session, options, volume);
    return voxels.ok() ? uploadTable(session, volume) : voxels;
}

Result<void> makeReady(const device::Session& session, const VolumeOptions& options, VolumePart& volume) {
    VOXTACT_TRY(uploadVoxels(session, options, volume));
    if (Result<void> table = uploadTable(session, volume); !table.ok()) {
        return table.error().code == ErrorCode::LimitExceeded ? refuse("--tf-size: " + table.error().text)
                                                              : table.error();
    }
    return makeHost(volume);
}

Result<void> makeReady(const device::Session* session, MeshPart& mesh) {
    if (session != nullptr) {
        VOXTACT_TRY(put(Mesh::upload(session->context, session->device.queueAccess(), mesh.data.view(),
                                     {.name = mesh.data.name.c_str(), .clusters = true}),
                        mesh.device));
    }
    return mesh.host ? Result<void>() : put(cpu::Mesh::create(mesh.data.view()), mesh.host);
}

Result<void> makeReady(const device::Session& session, const Scene& scene, const VolumeOptions& options) {
    VOXTACT_TRY(checkViewport(session, {scene.view.width, scene.view.height}));
    VOXTACT_TRY(makeReady(session, options, *scene.volume));
    return makeReady(&session, *scene.mesh);
}

Result<void> checkViewport(const device::Session& session, const VkExtent2D& size) {
    const VkExtent2D most = session.context.maxViewport();
    if (size.width <= most.width && size.height <= most.height &&
        std::max(size.width, size.height) <= cpu::kMaxViewport) {
        return {};
    }
    return refuse(concat("--size: ", size.width, "x", size.height, " is beyond what '", session.device.physical().name,
                         "' can do"));
}

} // namespace voxtact::lab
