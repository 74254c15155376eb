// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/pair_transform.h"
#include "device/detector/pass_desc.h"
#include "vulkan/context_impl.h"

namespace voxtact {

/// Refuses what cmdDetect() cannot record: null objects, objects of another context, poses and cameras that are not
/// finite or not affine, a singular camera, a viewport of 0 or beyond the device's, a threshold outside [0,1]. The
/// camera counts only where the projection has one. Returns the number of pairs.
[[nodiscard]] Result<std::uint32_t> checkBatch(const ContextImpl& context, const PassDesc& desc, const Batch& batch);

/// The viewport of an item: the batch's, or the one that the projection makes of the volume.
[[nodiscard]] VkExtent2D viewportOf(const PassDesc& desc, const Batch& batch, const BatchItem& item) noexcept;

/// Refuses a mesh that shaders cannot read as storage. `what` is what needs that ("the counting method compute").
[[nodiscard]] Result<void> checkStorage(const BatchItem& item, const char* what);

/// Work groups of VOXTACT_COMPUTE_GROUP triangles.
[[nodiscard]] std::uint32_t groupsOf(const Mesh& mesh) noexcept;

/// What a draw or a dispatch of the projections with fragments has at most.
struct DrawSize {
    std::uint32_t triangles = 0; ///< as many as the mesh has, or fewer in one view
    std::uint32_t views = 0;
};
/// By ContextDesc::fragmentsAtOnce.
[[nodiscard]] DrawSize drawSize(const ContextImpl& context, VkExtent2D viewport, std::uint32_t triangles) noexcept;

/// Sample -> normalised scalar of an item, and the threshold. The filter says what a sample is.
[[nodiscard]] shader::ItemConstants itemConstants(const BatchItem& item, Filter filter, double threshold) noexcept;

/// Whether a 32-bit counter could overflow: it cannot while every triangle could cover every pixel and still fit.
[[nodiscard]] bool needsCarry(const PassDesc& desc, const Batch& batch, const BatchItem& item) noexcept;

} // namespace voxtact
