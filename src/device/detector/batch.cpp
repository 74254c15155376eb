// SPDX-License-Identifier: MIT
#include "device/detector/batch.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/batch/batch_check.h"
#include "device/scene/mesh_layout.h"
#include "device/scene/scene_impl.h"
#include "vulkan/submit.h"

#include <algorithm>

namespace voxtact {

namespace {

/// What of an item was never uploaded; null: all was.
const char* missingUpload(const BatchItem& item) {
    if (!item.mesh->impl().uploaded) {
        return "the mesh";
    }
    if (!item.volume->impl().uploaded) {
        return "the volume";
    }
    return item.transferFunction->impl().uploaded ? nullptr : "the transfer function";
}

Result<void> checkDevicePoses(const ContextImpl& context, const BatchItem& item, bool devicePoses,
                              const std::string& which) {
    if (item.poses == nullptr) {
        return item.poseCount ? Result<void>(refuse(which + ": poseCount is of poses, which is null")) : Result<void>();
    }
    if (!devicePoses) {
        return refuse(which + " has poses on the device; the detector was made without devicePoses");
    }
    if (&item.poses->impl().context != &context) {
        return refuse(which + ": poses belongs to another Context");
    }
    if (!item.world_from_object.empty()) {
        return refuse(which + " has poses and world_from_object; it can have one of them");
    }
    if (item.pairs() > item.poses->count()) {
        return refuse(which + ": poseCount is " + std::to_string(item.pairs()) + ", poses has " +
                      std::to_string(item.poses->count()));
    }
    return {};
}

struct DeviceSide {
    const ContextImpl& context;
    bool devicePoses;   ///< devicePoses
    bool draws;         ///< vertices are the input of a draw
    bool readsVertices; ///< vertices are pulled from a storage buffer
    Filter filter;

    [[nodiscard]] Result<void> checkExtent(const WideExtent& extent, const std::string& what) const {
        const VkPhysicalDeviceLimits& limits = context.limits;
        const std::uint32_t mostX = std::min(limits.maxViewportDimensions[0], limits.maxFramebufferWidth);
        const std::uint32_t mostY = std::min(limits.maxViewportDimensions[1], limits.maxFramebufferHeight);
        if (extent[0] <= mostX && extent[1] <= mostY) {
            return {};
        }
        return Error{ErrorCode::LimitExceeded, 0,
                     what +
                         ", the device's limit (maxViewportDimensions, maxFramebufferWidth "
                         "and Height) is " +
                         std::to_string(mostX) + "x" + std::to_string(mostY)};
    }

    [[nodiscard]] Result<void> checkItem(const BatchItem& item, const std::string& which) const {
        if (&item.mesh->impl().context != &context || &item.volume->impl().context != &context ||
            &item.transferFunction->impl().context != &context) {
            return refuse(which + ": mesh, volume or transferFunction belongs to another Context");
        }
        VOXTACT_TRY(checkDevicePoses(context, item, devicePoses, which));
        if (const char* what = missingUpload(item); what != nullptr) {
            return neverUploaded(which + ": " + what);
        }
        if (filter == Filter::Hardware && !(item.volume->impl().filtered && item.transferFunction->impl().filtered)) {
            return Error{ErrorCode::Unsupported, 0,
                         which + ": the device cannot filter the " +
                             (item.volume->impl().filtered ? "transfer function's table" : "volume's format") +
                             " linearly; the filter exact needs no filtering"};
        }
        if (draws) {
            return checkVertexInput(item.mesh->impl(), which);
        }
        return readsVertices ? checkStorage(item, "the projection dominant-axis") : Result<void>();
    }

    [[nodiscard]] bool holdsValues(const BatchItem& item) const { return areSingle(itemConstants(item, filter, 0)); }
};

} // namespace

Result<std::uint32_t> checkBatch(const ContextImpl& context, const PassDesc& desc, const Batch& batch) {
    const bool rasterised = rowOf(desc.method).coverage == Coverage::Rasteriser;
    const bool pulls = rowOf(desc.projection).voxelGrid;
    return checkBatch(desc.projection, desc.samplesPerVoxel, batch,
                      DeviceSide{context, desc.devicePoses, rasterised && !pulls, rasterised && pulls, desc.filter});
}

std::size_t BatchItem::pairs() const noexcept {
    return poses == nullptr ? world_from_object.size() : poseCount.value_or(poses->count());
}

std::uint32_t groupsOf(const Mesh& mesh) noexcept {
    return (mesh.triangles() + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
}

DrawSize drawSize(const ContextImpl& context, VkExtent2D viewport, std::uint32_t triangles) noexcept {
    constexpr std::uint64_t kMostTriangles = std::uint64_t{1} << 22U;
    const std::uint64_t pixels = std::max<std::uint64_t>(std::uint64_t{viewport.width} * viewport.height, 1);
    const auto most =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(context.fragmentsAtOnce / pixels, 1, kMostTriangles));
    return {std::min(triangles, most), std::max(most / triangles, 1U)};
}

shader::ItemConstants itemConstants(const BatchItem& item, Filter filter, double threshold) noexcept {
    const VolumeImpl& volume = item.volume->impl();
    const bool ofInteger = filter == Filter::Exact && volume.storedUnit > 0;
    const double slope = ofInteger ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    shader::ItemConstants constants =
        itemConstants(slope, volume.valueIntercept, item.transferFunction->impl().known.domain, threshold);
    constants.storedUnit = static_cast<float>(volume.storedUnit);
    return constants;
}

VkExtent2D viewportOf(const PassDesc& desc, const Batch& batch, const BatchItem& item) noexcept {
    if (rowOf(desc.projection).voxelGrid) {
        const auto side = static_cast<std::uint32_t>(dominantSide(item.volume->grid(), desc.samplesPerVoxel));
        return {side, side};
    }
    return {batch.view.width, batch.view.height};
}

Result<void> checkStorage(const BatchItem& item, const char* what) {
    if (const std::string& reason = item.mesh->impl().noStorage; !reason.empty()) {
        return Error{ErrorCode::Unsupported, 0, what + (" cannot be used: " + reason)};
    }
    return {};
}

bool needsCarry(const PassDesc& desc, const Batch& batch, const BatchItem& item) noexcept {
    const VkExtent2D viewport = viewportOf(desc, batch, item);
    const double most = static_cast<double>(viewport.width) * viewport.height * item.mesh->triangles();
    return most * viewsPerPair(desc.projection) >= 4294967296.0;
}

} // namespace voxtact
