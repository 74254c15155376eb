// SPDX-License-Identifier: MIT
#include "detect/batch.h"
#include "core/method_table.h"
#include "core/projection.h"
#include "core/text.h"
#include "core/try.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

/// Width and height of a viewport; 64 bits, so that what is asked for can be beyond every limit.
using Extent = std::array<std::uint64_t, 2>;

/// `what` begins the error text and says how large it is.
Result<void> checkLimits(const ContextImpl& context, const Extent& extent, const std::string& what) {
    const VkPhysicalDeviceLimits& limits = context.limits;
    const std::uint32_t mostX = std::min(limits.maxViewportDimensions[0], limits.maxFramebufferWidth);
    const std::uint32_t mostY = std::min(limits.maxViewportDimensions[1], limits.maxFramebufferHeight);
    if (extent[0] > mostX || extent[1] > mostY) {
        return Error{ErrorCode::LimitExceeded, 0,
                     what +
                         ", the device's limit (maxViewportDimensions, maxFramebufferWidth "
                         "and Height) is " +
                         std::to_string(mostX) + "x" + std::to_string(mostY)};
    }
    return {};
}

Result<void> checkView(const ContextImpl& context, const View& view) {
    const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
    if (view.width == 0 || view.height == 0) {
        return refuse("the viewport is " + size + ", it needs at least one pixel");
    }
    VOXTACT_TRY(checkLimits(context, {view.width, view.height}, "the viewport is " + size));
    if (const Result<Mat4> world_from_clip = inverse(view.clip_from_world); !world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    return {};
}

/// What the projection `dominant-axis` asks of an item.
Result<void> checkDominant(const ContextImpl& context, const DetectorDesc& desc, const BatchItem& item,
                           const std::string& which) {
    if (rowOf(desc.method).coverage == Coverage::Rasteriser) {
        VOXTACT_TRY(checkStorage(item, "the projection dominant-axis"));
    }
    const Grid& grid = item.volume->grid();
    const std::uint64_t side = dominantSide(grid, desc.samplesPerVoxel);
    return checkLimits(context, {side, side}, which + ": " + dominantNeeds(grid, desc.samplesPerVoxel));
}

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

Result<void> checkItem(const ContextImpl& context, const BatchItem& item, const std::string& which) {
    if (item.mesh == nullptr || item.volume == nullptr || item.transferFunction == nullptr) {
        return refuse(which + ": mesh, volume or transferFunction is null");
    }
    if (&item.mesh->impl().context != &context || &item.volume->impl().context != &context ||
        &item.transferFunction->impl().context != &context) {
        return refuse(which + ": mesh, volume or transferFunction belongs to another Context");
    }
    if (const char* what = missingUpload(item); what != nullptr) {
        return neverUploaded(which + ": " + what);
    }
    for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
        // The text is made for a bad pose only: this is the hot loop of recording.
        if (Result<void> checked = checkAffine(item.world_from_object[pose], {}); !checked.ok()) {
            return checkAffine(item.world_from_object[pose], which + ", pose " + std::to_string(pose));
        }
    }
    return {};
}

} // namespace

Result<std::uint32_t> checkBatch(const ContextImpl& context, const DetectorDesc& desc, const Batch& batch) {
    if (!(batch.threshold >= 0 && batch.threshold <= 1)) {
        return refuse("the threshold " + number(batch.threshold) + " is outside [0, 1]");
    }
    if (usesView(desc.projection)) {
        VOXTACT_TRY(checkView(context, batch.view));
    }
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const std::string which = "batch item " + std::to_string(i);
        VOXTACT_TRY(checkItem(context, batch.items[i], which));
        if (rowOf(desc.projection).voxelGrid) {
            VOXTACT_TRY(checkDominant(context, desc, batch.items[i], which));
        }
        pairs += batch.items[i].world_from_object.size();
    }
    if (pairs > std::numeric_limits<std::uint32_t>::max()) {
        return refuse("the batch has " + std::to_string(pairs) + " pairs, more than 32 bits can number");
    }
    return static_cast<std::uint32_t>(pairs);
}

std::uint32_t groupsOf(const Mesh& mesh) noexcept {
    return (mesh.triangles() + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
}

Result<void> checkGroups(const ContextImpl& context, const Mesh& mesh) {
    const std::uint64_t most = context.limits.maxComputeWorkGroupCount[0];
    if (groupsOf(mesh) > most) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the mesh has " + std::to_string(mesh.triangles()) +
                         " triangles, the device's maxComputeWorkGroupCount allows for " +
                         std::to_string(most * VOXTACT_COMPUTE_GROUP)};
    }
    return {};
}

shader::ItemConstants itemConstants(const BatchItem& item, Filter filter, double threshold) noexcept {
    const VolumeImpl& volume = item.volume->impl();
    const bool ofInteger = filter == Filter::Exact && volume.storedUnit > 0;
    const double slope = ofInteger ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    shader::ItemConstants constants =
        itemConstants(slope, volume.valueIntercept, item.transferFunction->impl().domain, threshold);
    constants.storedUnit = static_cast<float>(volume.storedUnit);
    return constants;
}

VkExtent2D viewportOf(const DetectorDesc& desc, const Batch& batch, const BatchItem& item) noexcept {
    if (rowOf(desc.projection).voxelGrid) {
        const auto side = static_cast<std::uint32_t>(dominantSide(item.volume->grid(), desc.samplesPerVoxel));
        return {side, side};
    }
    return {batch.view.width, batch.view.height};
}

shader::MeshConstants meshConstants(const MeshImpl& mesh) noexcept {
    std::uint32_t indexBytes = 0;
    if (mesh.indices != VK_NULL_HANDLE) {
        indexBytes = mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
    }
    return {static_cast<std::uint32_t>(mesh.vertexOffset / sizeof(float)),
            static_cast<std::uint32_t>(mesh.vertexStride / sizeof(float)), static_cast<std::uint32_t>(mesh.indexOffset),
            indexBytes};
}

Result<void> checkStorage(const BatchItem& item, const char* what) {
    if (const std::string& reason = item.mesh->impl().noStorage; !reason.empty()) {
        return Error{ErrorCode::Unsupported, 0, what + (" cannot be used: " + reason)};
    }
    return {};
}

bool needsCarry(const DetectorDesc& desc, const Batch& batch, const BatchItem& item) noexcept {
    const VkExtent2D viewport = viewportOf(desc, batch, item);
    const double most = static_cast<double>(viewport.width) * viewport.height * item.mesh->triangles();
    return most * viewsPerPair(desc.projection) >= 4294967296.0;
}

} // namespace voxtact
