// SPDX-License-Identifier: MIT
#pragma once

#include "device/scene/scene_impl.h"
#include "exact/render.h"
#include "voxtact/render.h"
#include "vulkan/context_impl.h"

namespace voxtact {

/// Formats of the pre-integrated table, and of the results of the mesh pass.
inline constexpr VkFormat kRenderTableFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kMeshColourFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kMeshDistanceFormat = VK_FORMAT_R32_SFLOAT;
inline constexpr VkFormat kMeshDepthFormat = VK_FORMAT_D32_SFLOAT;

/// Push constants with the index of a mesh.
inline constexpr VkShaderStageFlags kMeshStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

/// The source of a mesh's paint; each has a pipeline.
enum class PaintBy : std::uint32_t { Nobody, Fragments, Triangles, Vertices };
inline constexpr std::size_t kPaintBys = 4;

struct RendererImpl : SharedImpl<RendererImpl> {
    RendererImpl(ContextImpl& c, const RendererDesc& d) : context(c), desc(d) {}

    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    RendererDesc desc{};
    Owned<VkDescriptorSetLayout> makingLayout{};   ///< of the table's pass
    Owned<VkDescriptorSetLayout> functionLayout{}; ///< PICTURE_SET_FUNCTION
    Owned<VkDescriptorSetLayout> targetsLayout{};  ///< PICTURE_SET_TARGETS
    Owned<VkDescriptorSetLayout> bricksLayout{};   ///< PICTURE_SET_BRICKS, PICTURE_SET_PAINT
    Owned<VkPipelineLayout> makingPipelineLayout{};
    Owned<VkPipelineLayout> pictureLayout{};
    Owned<VkPipelineLayout> paintLayout{}; ///< of a mesh that is painted
    Owned<VkPipeline> makingPipeline{};
    /// By PaintBy, then flat and smooth. Those by triangles are empty without the feature geometryShader.
    std::array<std::array<Owned<VkPipeline>, 2>, kPaintBys> meshPipelines{};
    std::array<Owned<VkPipeline>, 2> volumePipelines{}; ///< without occlusion and with it
    DescriptorSet noBricks{};
};

struct RenderTransferFunctionImpl {
    const RendererImpl& renderer;
    std::shared_ptr<const RendererImpl> owner = renderer.shared_from_this();
    ValueRange domain{};
    double step = 0;
    std::vector<float> table{};     ///< the opacities
    std::vector<float> integrals{}; ///< for preintegrate.comp
    Image image{};
    Buffer integralBuffer{};
    Buffer extremes{};
    DescriptorSet making{};
    DescriptorSet reading{};
    bool uploaded = false; ///< recorded
};

struct RenderTargetsImpl {
    const RendererImpl& renderer;
    std::shared_ptr<const RendererImpl> owner = renderer.shared_from_this();
    VkExtent2D extent{};
    Image colour{};
    Image distance{};
    Image depth{};
    Buffer constants{};
    DescriptorSet descriptors{};
};

struct MeshNormalsImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    std::uint32_t vertices = 0;
    Buffer buffer{};
    Buffer staging{};
    bool uploaded = false; ///< recorded
};

struct RenderBricksImpl {
    const RendererImpl& renderer;
    std::shared_ptr<const RendererImpl> owner = renderer.shared_from_this();
    const VolumeImpl* volume = nullptr;
    DescriptorSet descriptors{};
};

/// Uints that the shaders of a painted mesh read: PICTURE_SET_PAINT.
struct PaintWords {
    explicit PaintWords(ContextImpl& c) : context(c) {}

    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    std::uint64_t room = 0; ///< number of triangles or vertices
    Buffer buffer{};        ///< empty when wrapped
    Buffer staging{};
    bool uploaded = false; ///< recorded, or the caller's own
    DescriptorSet descriptors{};
};
struct PaintedTrianglesImpl : PaintWords {
    using PaintWords::PaintWords;
};
struct PaintedVerticesImpl : PaintWords {
    using PaintWords::PaintWords;
};

/// Refuses a number that is not above 0, or out of single precision's range. `what` begins the error text.
[[nodiscard]] Result<void> checkPositive(double value, const std::string& what);

/// Returns the available names, for messages.
struct PaintName {
    const char* words = ""; ///< "the bits of the painted triangles": plural
    const char* whole = ""; ///< "painted triangles"
};
/// Refuses more bytes than the device can bind.
[[nodiscard]] Result<void> checkPaintBytes(const ContextImpl& context, VkDeviceSize bytes, const PaintName& name);
/// `perWord`: triangles or vertices in a word.
[[nodiscard]] Result<void> makePaintWords(PaintWords& paint, const RendererImpl& renderer,
                                          std::span<const std::uint32_t> words, std::uint64_t perWord,
                                          const PaintName& name);
[[nodiscard]] Result<void> wrapPaintWords(PaintWords& paint, const RendererImpl& renderer, const BufferRange& words,
                                          std::uint64_t perWord, const PaintName& name);
[[nodiscard]] Result<void> cmdUploadPaintWords(PaintWords& paint, VkCommandBuffer commandBuffer, const PaintName& name);

/// Inputs of the recording of a picture.
struct PictureSetup {
    shader::PictureConstants constants{};
    bool depthTurned = false; ///< the camera's near plane is at depth 1
};

/// Refuses invisible scenes. Expects an otherwise valid scene.
[[nodiscard]] Result<PictureSetup> setUpPicture(const Scene& scene, const Target& target);

/// The meshes of a scene, by number from 0: its own, if it has one, then the others.
[[nodiscard]] std::size_t meshCount(const Scene& scene) noexcept;
[[nodiscard]] const SceneMesh& meshOf(const Scene& scene, std::size_t number) noexcept;
/// Refuses an unusable pose or colours.
[[nodiscard]] Result<void> checkMeshLook(const SceneMesh& mesh);
/// Expects a valid mesh.
[[nodiscard]] shader::PictureMesh setUpMesh(const Scene& scene, const SceneMesh& mesh);

[[nodiscard]] Result<void> checkLighting(const Lighting& lighting);
[[nodiscard]] Result<void> checkClipPlanes(std::span<const ClipPlane> planes);
/// Expects valid planes and lighting.
void setClipPlanes(shader::PictureConstants& constants, const Scene& scene);
void setLight(shader::PictureConstants& constants, const Scene& scene, const Mat4& world_from_clip);

/// Records the meshes in front of the background, their distance and their constants; without meshes, only the
/// background.
void cmdMeshPass(const RendererImpl& renderer, VkCommandBuffer commandBuffer, const Scene& scene,
                 const PictureSetup& setup, const Target& target, VkRect2D area);

/// Format of the renderer's own images.
[[nodiscard]] VkRenderingAttachmentInfo renderAttachment(VkImageView view, VkImageLayout layout,
                                                         VkAttachmentLoadOp load);
void beginRendering(const ContextImpl& context, VkCommandBuffer commandBuffer, VkExtent2D picture, VkRect2D area,
                    std::span<const VkRenderingAttachmentInfo> colours, const VkRenderingAttachmentInfo* depth,
                    bool depthTurned);

[[nodiscard]] Result<void> checkColour(const Colour& colour, const char* what);
/// Refuses a paint without its inputs. Expects an otherwise valid scene.
[[nodiscard]] Result<void> checkPaint(const ContextImpl& context, const SceneMesh& mesh);
[[nodiscard]] PaintBy paintedBy(Paint what) noexcept;
void setPaint(shader::PictureMesh& constants, const Volume& volume, const MeshPaint& paint);

/// Fills RendererImpl::meshPipelines.
[[nodiscard]] Result<void> makeMeshPipelines(RendererImpl& renderer);

/// Integrals of extinction times colour (three) and of extinction up to each entry of a table, in entries, then the
/// values at each: what preintegrate.comp reads. `channels`: red, green, blue and opacity of the entries.
[[nodiscard]] std::vector<float> extinctionIntegrals(const std::array<std::vector<float>, 4>& channels,
                                                     double opacityUnit);

} // namespace voxtact
