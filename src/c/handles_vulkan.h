// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"
#include "voxtact/detector.h"
#include "voxtact/voxtact_vulkan.h"

#include <optional>
#include <vector>

// Definitions of the opaque types of voxtact_vulkan.h, as in handles.h.

namespace voxtact::c {

/// Results of the caller's, or a slot of a ring's.
struct OwnOrSlot {
    std::optional<Results> own;
    Results* slot = nullptr;
    bool timestamps = false;

    [[nodiscard]] Results& get() noexcept { return own ? *own : *slot; }
    [[nodiscard]] const Results& get() const noexcept { return own ? *own : *slot; }
};

} // namespace voxtact::c

struct vxt_features {
    voxtact::FeatureRequest object;
};
struct vxt_context {
    voxtact::Context object;
    voxtact::c::SharedErrors errors;
};
struct vxt_volume {
    voxtact::Volume object;
    voxtact::c::SharedErrors errors;
};
struct vxt_transfer_function {
    voxtact::TransferFunction object;
    voxtact::c::SharedErrors errors;
};
struct vxt_mesh {
    voxtact::Mesh object;
    voxtact::c::SharedErrors errors;
};
struct vxt_pose_buffer {
    voxtact::PoseBuffer object;
    voxtact::c::SharedErrors errors;
};
struct vxt_label_map {
    voxtact::LabelMap object;
    voxtact::c::SharedErrors errors;
};
struct vxt_detector {
    voxtact::Detector object;
    voxtact::c::SharedErrors errors;
};
struct vxt_blocking_detector {
    voxtact::BlockingDetector object;
    voxtact::c::SharedErrors errors;
};
struct vxt_results {
    voxtact::c::OwnOrSlot object;
    voxtact::c::SharedErrors errors;
};

namespace voxtact::c {

/// A ring and a handle for each of its slots.
struct RingAndSlots {
    ResultRing ring;
    std::vector<vxt_results> slots;
};

} // namespace voxtact::c

struct vxt_result_ring {
    voxtact::c::RingAndSlots object;
    voxtact::c::SharedErrors errors;
};
