// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/recentre.h"
#include "exact/pair_setup.h"
#include "voxtact/scene.h"
#include "vulkan/context_impl.h"

#include <vector>

namespace voxtact {

struct VolumeImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    Grid grid{};
    Mat4 texture_from_world{};
    shader::PairGrid pairGrid{};
    ScalarType type = ScalarType::UInt8; ///< of the uploaded voxels
    VkFormat format = VK_FORMAT_UNDEFINED;
    bool filtered = true;  ///< by the device's sampler, linearly
    double valueSlope = 1; ///< value = valueSlope * texel + valueIntercept, texel being what the sampler returns
    double valueIntercept = 0;
    double storedUnit = 0; ///< the integer behind texel 1.0; 0 for float texels, whose stored value is the texel
    std::optional<ValueRange> valueRange{};
    std::optional<std::vector<ValueRange>> boundary{}; ///< boundaryRanges(); nothing when not known
    Image image{};                                     ///< empty when wrapped
    Buffer staging{};
    Buffer editScratch{};    ///< the texels of a slice or more; empty when not editable
    Buffer editRows{};       ///< which of these an edit changes
    DescriptorSet editSet{}; ///< of the two
    VkPipeline editPipeline = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    Buffer bricks{}; ///< vec4(lo, hi, wideLo, wideHi) of stored values for each brick, x fastest; empty without
    std::array<std::int32_t, 3> brickCount{}; ///< zero without bricks
    VkPipeline brickPipeline = VK_NULL_HANDLE;
    bool bricksFilled = false;   ///< recorded, of the whole grid
    bool uploaded = false;       ///< recorded, or the caller's own
    DescriptorSet descriptors{}; ///< VOXTACT_SET_VOLUME: the image, the bricks
};

/// What the host knows of a transfer function.
struct TransferFunctionKnown {
    std::vector<ControlPoint> points{}; ///< none for a wrapped one whose table it does not know
    ValueRange domain{};                ///< of the table
};

struct TransferFunctionImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    TransferFunctionKnown known{};
    bool filtered = true;           ///< by the device's sampler, linearly
    std::vector<float> table{};     ///< the host's copy; empty for a wrapped one without
    Image image{};                  ///< empty when wrapped
    Buffer texels{};                ///< where the image is filled from; empty when wrapped
    Buffer staging{};               ///< the same, as it was created
    TransferFunctionKnown staged{}; ///< of that
    bool uploaded = false;          ///< recorded, or the caller's own
    DescriptorSet descriptors{};    ///< VOXTACT_SET_TRANSFER_FUNCTION: the table
};

/// What the host knows of a mesh's vertices: nothing where they are the caller's.
struct MeshKnown {
    std::optional<MeshFacts> facts{};
    MeshOrigin origin{}; ///< of the floats on the device
    /// Of the longest sides of triangles, squared, object units: sums over the clusters before each number, the last
    /// over all. 64 triangles each, as the passes take them.
    std::vector<double> squaresBefore{};
    std::vector<double> squaresBeforeGroup{}; ///< the same, of 64 triangles each in the order of the mesh
};

struct MeshImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    VkBuffer vertices = VK_NULL_HANDLE;
    VkDeviceSize vertexOffset = 0;
    VkDeviceSize vertexStride = 12;
    std::uint32_t vertexCount = 0;
    VkBuffer indices = VK_NULL_HANDLE; ///< null: not indexed
    VkDeviceSize indexOffset = 0;
    VkIndexType indexType = VK_INDEX_TYPE_UINT32;
    std::uint32_t triangleCount = 0;
    MeshKnown known{};           ///< of the vertices as they were recorded last
    DescriptorSet descriptors{}; ///< for shaders that read the mesh as storage; empty where `noStorage` says why
    std::string noStorage{};
    /// Positions, indices, then clusters as CertifiedConstants says. Of a wrapped mesh with clusters: its indices, 32
    /// bits each, and clusters; empty when wrapped without.
    Buffer buffer{};
    std::optional<std::uint32_t> clusterWord{}; ///< of the buffer; nothing: no clusters on the device
    DescriptorSet refitSet{};                   ///< of the pass that fits these; empty where no command does
    VkPipeline refitPipeline = VK_NULL_HANDLE;
    Buffer staging{};      ///< of the buffer; of a wrapped mesh: its triangles in clusters
    bool uploaded = false; ///< recorded, or the caller's own
    bool editable = false;
    /// Of an editable mesh: three indices per triangle, the triangles in clusters (empty without), and what was known
    /// when it was made.
    std::vector<std::uint32_t> triangles{};
    std::vector<std::uint32_t> order{};
    MeshKnown made{};

    [[nodiscard]] bool wrapped() const noexcept { return vertices != buffer.get(); }
    [[nodiscard]] bool indexed() const noexcept { return indices != VK_NULL_HANDLE; }
    /// Vertices that a draw of it may reach.
    [[nodiscard]] std::uint32_t drawnVertices() const noexcept { return indexed() ? vertexCount : 3 * triangleCount; }
};

/// Poses of the caller's.
struct PoseBufferImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    std::uint32_t firstWord = 0; ///< where the first pose begins
    std::uint32_t words = 0;     ///< from one to the next
    std::uint32_t count = 0;
    double maxScale = 1; ///< WrappedPoses::maxScale
    DescriptorSet descriptors{};
};

/// The layout of a PoseBuffer's set, made for the first that asks.
[[nodiscard]] Result<VkDescriptorSetLayout> poseSetLayout(ContextImpl& context);

/// The format of a label map: numbers of labels.
inline constexpr VkFormat kLabelFormat = VK_FORMAT_R16_UINT;

struct LabelMapImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    Grid grid{};
    std::shared_ptr<const std::vector<std::int32_t>> values{}; ///< shared with the Results that are still to be read
    Image image{};
    Buffer staging{};
    bool uploaded = false; ///< recorded
    DescriptorSet descriptors{};
};

/// A set of ContextImpl::labelSetLayout.
[[nodiscard]] Result<DescriptorSet> makeLabelSet(ContextImpl& context, VkImageView view, const char* name);

} // namespace voxtact
