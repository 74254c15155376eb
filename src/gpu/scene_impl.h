// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/memory.h"
#include "voxtact/scene.h"

#include <vector>

namespace voxtact {

struct VolumeImpl {
    ContextImpl& context;
    Grid grid{};
    Mat4 texture_from_world{};
    VkFormat format = VK_FORMAT_UNDEFINED;
    double valueSlope = 1; ///< value = valueSlope * texel + valueIntercept, texel being what the sampler returns
    double valueIntercept = 0;
    double storedUnit = 0; ///< the integer behind texel 1.0; 0 for float texels, whose stored value is the texel
    std::optional<ValueRange> valueRange{};
    std::optional<std::vector<ValueRange>> boundary{}; ///< boundaryRanges(); nothing when not known
    Image image{};                                     ///< empty when wrapped
    Buffer staging{};
    VkImageView view = VK_NULL_HANDLE;
    DescriptorSet descriptors{};
};

struct TransferFunctionImpl {
    ContextImpl& context;
    ValueRange domain{};
    std::vector<float> table{}; ///< the host's copy; empty for a wrapped one without
    Image image{};
    Buffer staging{};
    DescriptorSet descriptors{};
};

struct MeshImpl {
    ContextImpl& context;
    VkBuffer vertices = VK_NULL_HANDLE;
    VkDeviceSize vertexOffset = 0;
    VkDeviceSize vertexStride = 12;
    VkBuffer indices = VK_NULL_HANDLE; ///< null: not indexed
    VkDeviceSize indexOffset = 0;
    VkIndexType indexType = VK_INDEX_TYPE_UINT32;
    std::uint32_t triangleCount = 0;
    std::optional<MeshFacts> facts{};
    DescriptorSet descriptors{}; ///< for the compute path; empty where `noCompute` says why
    std::string noCompute{};
    Buffer buffer{}; ///< positions, then indices; empty when wrapped
    Buffer staging{};
};

/// The format of a label map: numbers of labels.
inline constexpr VkFormat kLabelFormat = VK_FORMAT_R16_UINT;

struct LabelMapImpl {
    ContextImpl& context;
    Grid grid{};
    std::shared_ptr<const std::vector<std::int32_t>> values{}; ///< shared with the Results that are still to be read
    Image image{};
    Buffer staging{};
    DescriptorSet descriptors{};
};

/// A set of ContextImpl::labelSetLayout.
[[nodiscard]] Result<DescriptorSet> makeLabelSet(ContextImpl& context, VkImageView view, const char* name);

} // namespace voxtact
