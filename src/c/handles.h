// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"
#include "voxtact/cpu.h"

#include <atomic>
#include <vector>

// Definitions of the opaque types of voxtact.h. Every handle has its object as `object`; those that belong to a context
// share its errors as `errors`.

struct vxt_labels {
    voxtact::LabelData object;
};
struct vxt_volume_data {
    voxtact::VolumeData object;
};
struct vxt_mesh_data {
    voxtact::MeshData object;
};
struct vxt_poses {
    std::vector<voxtact::Mat4> object;
};
struct vxt_control_points {
    std::vector<vxt_control_point> object;
};
struct vxt_box_pairs {
    std::vector<vxt_box_pair> object;
};
struct vxt_cancel {
    std::atomic<bool> object{false};
};
struct vxt_host_volume {
    voxtact::cpu::Volume object;
};
struct vxt_host_transfer_function {
    voxtact::cpu::TransferFunction object;
};
struct vxt_host_mesh {
    voxtact::cpu::Mesh object;
};
struct vxt_host_engine {
    voxtact::cpu::HostEngine object;
};
struct vxt_tracker {
    voxtact::cpu::DistanceTracker object;
};

namespace voxtact::c {

/// The object of a handle, which may be null.
template <class Handle> auto* objectOf(Handle* handle) noexcept {
    return handle == nullptr ? nullptr : &handle->object;
}

} // namespace voxtact::c
