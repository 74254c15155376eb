// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Pictures (target voxtact::render): a translucent volume by ray casting, with opaque meshes at the right depth.
/// Volume and Mesh are those of the detector: one upload serves both.
///
/// Ray casting: one triangle fills the picture; the inverse camera matrix clips each pixel's ray to the volume's box.
/// The box's faces are not rasterised: the eye may be inside, and orthographic and perspective cameras share one path.
/// Samples are one step apart along the ray, in millimetres. A table of integrals gives colour and opacity between two
/// samples, so thin shells of the transfer function are not missed. This is pre-integrated classification (Engel, Kraus
/// and Ertl, "High-Quality Pre-Integrated Volume Rendering Using Hardware-Accelerated Pixel Shading", 2001). A ray ends
/// when its opacity reaches 0.99.
///
/// MeshPaint shows a detector's decisions on the mesh. The detector's shader code decides each visible fragment (a
/// pixel that the mesh covers), from the same numbers.
///
/// Colours are in the picture's space, without conversion: sRGB for an sRGB picture in a UNORM image.
///
/// Lifetime: all objects must outlive the command buffers that use them, but may outlive their Renderer.
///
/// Thread-safety: const functions are safe from any thread; all others need the caller's own lock.
namespace voxtact {

struct RendererImpl;
struct RenderTransferFunctionImpl;
struct RenderTargetsImpl;
struct MeshNormalsImpl;
struct RenderBricksImpl;
struct PaintedTrianglesImpl;
struct PaintedVerticesImpl;

/// Scalar -> opacity and colour. Lengths are above 0.
struct RenderTransferFunctionDesc {
    TransferFunctionDesc opacity{};            ///< as for the detector; at most 1024 entries
    std::span<const ColourPoint> colours = {}; ///< ascending values; constant outside; none: white
    /// Path length, mm, over which a ray is absorbed by `opacity`. Opacities above 0.999 count as 0.999.
    double opacityUnit = 1;
    double step = 0.5; ///< mm between samples of a ray; recommended: half a voxel
};

/// Options of a Renderer.
struct RendererDesc {
    VkFormat colorFormat = VK_FORMAT_R8G8B8A8_UNORM; ///< format of the pictures; there is no depth image
};

/// Maximum of the numbers of Lighting.
inline constexpr double kMaxLight = 1e6;

/// Light from the eye and from a side light, on both sides of a surface (Blinn-Phong). Range of `ambient`, `diffuse`,
/// `specular`, `shininess` and `side`: 0 to kMaxLight.
struct Lighting {
    bool volume = true;    ///< shades the volume by its gradient (central differences); false: plain colours
    bool mesh = true;      ///< shades meshes
    double ambient = 0.25; ///< ambient light
    double diffuse = 0.75; ///< diffuse light from the eye
    double specular = 0.2; ///< strength of highlights
    double shininess = 30; ///< exponent of highlights: a larger exponent gives smaller highlights
    /// Strength of the side light on surfaces that face the light. Strength of its highlight: side * specular.
    double side = 0;
    Vec3 sideFrom{-0.55, 0.6, 0.6}; ///< direction of the side light: to the picture's right, up, towards the eye
    /// 0..1: darkening of enclosed points of the volume. Occluders lie within `reach`, along the bisector of the normal
    /// and the direction to the eye; cut faces are open.
    double occlusion = 0;
    double reach = 8; ///< mm: range of occluders
    /// Shades cut faces (at the volume's border, a clipping plane or the near plane) by the plane's normal, with light
    /// from the eye and without highlights. Extends two voxels of the longest spacing behind the face, then blends to
    /// the gradient over two more. false: uses the gradient, which is noise on a cut face.
    bool faces = true;
};
/// Returns a preset. `soft`: light from the eye and from its upper left, with occlusion within a fraction of the
/// volume's diagonal. `eye`: Lighting's defaults. `none`: plain colours. Empty for an unknown name.
[[nodiscard]] VOXTACT_API std::optional<Lighting> lightingNamed(std::string_view name, const Grid& grid) noexcept;

/// Removes the side to which `normal` points: the points p of world space with dot(normal, p) > offset.
struct ClipPlane {
    Vec3 normal{};     ///< any length except 0; scales `offset`
    double offset = 0; ///< mm along a normal of length 1
};
/// Maximum number of planes of a Scene.
inline constexpr std::size_t kMaxClipPlanes = 6;
/// Returns a plane that removes one side of a volume; empty for an unknown name. `left`, `right`, `back`, `front`,
/// `top` and `bottom`: beyond `at` mm of the world's x, y or z. `near`: nearer to the eye than `at` mm in front of the
/// volume's middle. Without `at`, the plane passes through the middle. Only `near` uses `towardsEye`, a unit vector.
[[nodiscard]] VOXTACT_API std::optional<ClipPlane> clipSide(std::string_view side, std::optional<double> at,
                                                            const Grid& grid, const Vec3& towardsEye) noexcept;

class RenderTransferFunction;
class RenderTargets;
class MeshNormals;
class RenderBricks;
class PaintedTriangles;
class PaintedVertices;

/// Paint on a mesh.
enum class Paint : std::uint32_t {
    Plain,     ///< none: SceneMesh::meshColour everywhere
    Contacts,  ///< passing fragments
    Discarded, ///< discarded fragments, and passing fragments by opacity, from dark gray at the threshold to white
    Triangles, ///< chosen triangles
    Vertices,  ///< a colour per vertex, interpolated linearly
};

/// Options of a mesh's paint. Paint is lit like the mesh. If the mesh occludes itself, the nearest fragment is visible.
///
/// For Contacts and Discarded, a fragment passes if a Detector counts it. The Detector uses a rasterising method with
/// Projection::View and Filter::Hardware, for a View of Scene::clip_from_world and Target::extent. An explicit
/// Boundary::Clamp may differ; Boundary::Auto does not.
struct MeshPaint {
    Paint what = Paint::Plain;                          ///< kind of paint
    const TransferFunction* transferFunction = nullptr; ///< the detector's; for Contacts and Discarded
    double threshold = kDefaultThreshold;               ///< the detector's; 0..1
    const PaintedTriangles* triangles = nullptr;        ///< for Triangles; of SceneMesh::mesh
    const PaintedVertices* vertices = nullptr;          ///< for Vertices; as many as SceneMesh::normals needs
    Colour contactColour{1, 0.23, 0.08};                ///< passing fragments and chosen triangles; others: meshColour
    Colour discardedColour{0.16, 0.36, 0.88};           ///< for Discarded: discarded fragments
    /// 0..1: visibility through the volume in front: of passing fragments and chosen triangles; with Discarded and
    /// Vertices, of the whole mesh. 0: occluded like the rest of the mesh. 1: in front of the volume.
    double through = 0;
};

/// A mesh at a pose, with its appearance.
struct SceneMesh {
    const Mesh* mesh = nullptr; ///< mesh to draw
    /// Normals of `mesh` for smooth shading; null: flat triangles. A wrapped mesh needs at least
    /// WrappedMesh::vertexCount normals or, without indices, three per triangle.
    const MeshNormals* normals = nullptr;
    Mat4 world_from_object = identity(); ///< pose of the mesh; affine, not singular
    Colour meshColour{0.75, 0.78, 0.82}; ///< colour without paint
    MeshPaint paint{};                   ///< paint on the mesh
    bool clipped = false;                ///< cut by Scene::clipPlanes, like the volume
};
/// Returns the default SceneMesh::meshColour of the mesh with this index: distinct from other meshes, tissue and
/// contacts. Index 0 gives the default of SceneMesh; colours repeat after six.
[[nodiscard]] VOXTACT_API Colour meshColour(std::size_t number) noexcept;
/// Returns a MeshPaint::through that makes the paint visible: 0.8, or 1 for Discarded, which paints the whole mesh.
[[nodiscard]] VOXTACT_API double throughFor(Paint paint) noexcept;

/// Visible objects: a volume, and meshes in it. The base class is the first mesh; without meshes, `mesh` is null.
struct Scene : SceneMesh {
    const Volume* volume = nullptr;                           ///< required
    const RenderTransferFunction* transferFunction = nullptr; ///< required
    const RenderBricks* bricks = nullptr;                     ///< optional, of `volume`: skips transparent parts
    std::span<const SceneMesh> others = {};     ///< further meshes, or the same mesh at further poses; none is null
    std::span<const ClipPlane> clipPlanes = {}; ///< at most kMaxClipPlanes
    /// Orthographic or perspective; not singular. The near plane may be at depth 0 or 1, the far plane at infinity.
    Mat4 clip_from_world{};
    Colour background{}; ///< behind all objects
    Lighting lighting{}; ///< for the volume and all meshes
    /// Shifts the first sample of each ray by a fraction of the step, a hash of the pixel. Gives noise instead of
    /// bands, identical in all pictures of one size.
    bool jitter = true;
};

/// Destination of a picture.
struct Target {
    VkImageView view = VK_NULL_HANDLE; ///< of RendererDesc::colorFormat, one sample, usage COLOR_ATTACHMENT
    VkExtent2D extent{};               ///< size of the picture, from the image's corner; at most targets->extent()
    VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL; ///< or GENERAL; while the commands execute
    RenderTargets* targets = nullptr;                                ///< required; of this Renderer
    /// Part of the picture to render; without an extent, the whole picture. Pixels outside stay unchanged; pixels
    /// inside equal those of the whole picture. Render a slow picture in parts.
    VkRect2D area{};
    /// Timestamp pool, or null. Receives three timestamps: before the picture, after the mesh, after the volume. Reset
    /// the three queries first; the queue's family must support timestamps.
    VkQueryPool timestamps = VK_NULL_HANDLE;
    std::uint32_t firstTimestamp = 0; ///< index of the first query in `timestamps`
};

/// Renders pictures in one colour format.
class Renderer {
  public:
    /// Returns Unsupported if the device cannot render to the format, its pixels are integers, or the device lacks
    /// another format that the renderer needs.
    [[nodiscard]] VOXTACT_API static Result<Renderer> create(const Context& context, const RendererDesc& desc = {});
    VOXTACT_API Renderer(Renderer&&) noexcept;
    VOXTACT_API Renderer& operator=(Renderer&&) noexcept;
    VOXTACT_API ~Renderer();

    /// Records a picture, without allocation, submission or wait. Writes all pixels of the extent or of Target::area,
    /// with alpha 1.
    ///
    ///   call it          outside a render pass, in a primary command buffer, on a queue with graphics
    ///   expects          volume, bricks, transfer functions, mesh, normals and paint readable as cmdUpload() leaves
    ///                    them; wrapped ones in the given layout, made visible to VERTEX_INPUT / FRAGMENT_SHADER by the
    ///                    caller; the target's image in Target::layout, ready for COLOR_ATTACHMENT_OUTPUT /
    ///                    COLOR_ATTACHMENT_WRITE; discards the contents of the area
    ///   leaves           the image in the same layout, written at COLOR_ATTACHMENT_OUTPUT / COLOR_ATTACHMENT_WRITE:
    ///                    the next reader must wait for this write
    ///   targets          waits for an earlier use of the same RenderTargets in this queue
    ///   queries          no occlusion query may be active
    ///   bound state lost graphics pipeline, descriptor sets 0..3 of the graphics bind point, vertex bindings 0 and 1,
    ///                    index buffer, push constants, dynamic viewport and scissor
    ///
    /// Records nothing on error. Refuses a singular camera or pose, colours outside 0..1, objects that do not belong
    /// together, and a paint without its inputs. Refuses more than 65536 samples on a ray through the volume, and an
    /// area outside the picture. Refuses more than kMaxClipPlanes planes, and a plane with a zero normal.
    VOXTACT_API Result<void> cmdRender(VkCommandBuffer commandBuffer, const Scene& scene, const Target& target) const;

    [[nodiscard]] RendererImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Renderer(std::unique_ptr<RendererImpl> impl) noexcept;
    std::unique_ptr<RendererImpl> impl_;
};

/// A picture in host memory.
struct Picture {
    std::uint32_t width = 0;        ///< pixels
    std::uint32_t height = 0;       ///< pixels
    std::vector<std::uint8_t> rgba; ///< four bytes per pixel, the uppermost row first
};

/// Renders into its own image (R8G8B8A8_UNORM), submits on the caller's queue, waits, and reads the picture. Keeps the
/// images for the next picture of the same size.
///
/// Thread-safety: none; one thread at a time.
class BlockingRenderer {
  public:
    /// Creates a renderer. `queue` needs graphics.
    [[nodiscard]] VOXTACT_API static Result<BlockingRenderer> create(const Context& context, const QueueAccess& queue);
    VOXTACT_API BlockingRenderer(BlockingRenderer&&) noexcept;
    VOXTACT_API BlockingRenderer& operator=(BlockingRenderer&&) noexcept;
    VOXTACT_API ~BlockingRenderer();

    /// Receives the progress: rows done and in total. Return false to cancel: render() returns Cancelled.
    using Progress = std::function<bool(std::uint32_t done, std::uint32_t rows)>;

    /// Refuses what RenderTargets::create() and Renderer::cmdRender() refuse.
    [[nodiscard]] VOXTACT_API Result<Picture> render(const Scene& scene, VkExtent2D extent);
    /// Renders the same picture in bands of rows, one submission of about 0.2 s each. Calls `progress` after each band,
    /// on this thread; `progress` must not throw. After Cancelled, the next picture may start immediately.
    [[nodiscard]] VOXTACT_API Result<Picture> render(const Scene& scene, VkExtent2D extent, const Progress& progress);
    /// Returns the recording renderer, for creating the objects of a Scene; valid as long as this object.
    [[nodiscard]] VOXTACT_API const Renderer& renderer() const noexcept;

  private:
    struct State;
    explicit BlockingRenderer(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Scalar -> opacity and colour, on the device: the square table of pre-integrated classification, with one row and
/// column per entry of the opacity.
class RenderTransferFunction {
  public:
    /// Refuses what sampleTable() refuses, for opacity and colours, and a step or opacity unit that is not positive and
    /// finite.
    [[nodiscard]] VOXTACT_API static Result<RenderTransferFunction> create(const Renderer& renderer,
                                                                           const RenderTransferFunctionDesc& desc);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<RenderTransferFunction>
    upload(const Renderer& renderer, const QueueAccess& queue, const RenderTransferFunctionDesc& desc);
    VOXTACT_API RenderTransferFunction(RenderTransferFunction&&) noexcept;
    VOXTACT_API RenderTransferFunction& operator=(RenderTransferFunction&&) noexcept;
    VOXTACT_API ~RenderTransferFunction();

    /// Records the computation of the table.
    ///   call it       outside a render pass, on a queue with compute
    ///   expects       nothing; waits for earlier commands that read the table
    ///   leaves        the table readable by any shader stage, in every later command
    ///   queries       an active occlusion query is not affected
    ///   bound state   lost: compute pipeline, descriptor sets of the compute bind point, push constants
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Like cmdUpload(), for a new function with the same number of entries. Allocates no device memory. Takes effect
    /// in command-buffer order, but domain and step change at recording: record in the order of execution.
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const RenderTransferFunctionDesc& desc);

    /// Returns true if an entry of the table has an opacity above 0; otherwise, the volume is invisible.
    [[nodiscard]] VOXTACT_API bool visible() const noexcept;

    /// Does nothing; exists for upload().
    void releaseStaging() noexcept {}
    [[nodiscard]] RenderTransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit RenderTransferFunction(std::unique_ptr<RenderTransferFunctionImpl> impl) noexcept;
    std::unique_ptr<RenderTransferFunctionImpl> impl_;
};

/// Intermediate images of one picture in flight. Thread-safety: none; one recording at a time.
class RenderTargets {
  public:
    /// Refuses an extent of zero, or beyond Context::maxViewport().
    [[nodiscard]] VOXTACT_API static Result<RenderTargets> create(const Renderer& renderer, VkExtent2D extent);
    VOXTACT_API RenderTargets(RenderTargets&&) noexcept;
    VOXTACT_API RenderTargets& operator=(RenderTargets&&) noexcept;
    VOXTACT_API ~RenderTargets();

    /// Returns the size of the largest picture.
    [[nodiscard]] VOXTACT_API VkExtent2D extent() const noexcept;
    [[nodiscard]] RenderTargetsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit RenderTargets(std::unique_ptr<RenderTargetsImpl> impl) noexcept;
    std::unique_ptr<RenderTargetsImpl> impl_;
};

/// Normals of a mesh's vertices: the mean of the adjacent triangles' normals, weighted by area.
class MeshNormals {
  public:
    /// Refuses what checkMesh() refuses.
    [[nodiscard]] VOXTACT_API static Result<MeshNormals> create(const Renderer& renderer, const MeshView& data);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<MeshNormals> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                const MeshView& data);
    VOXTACT_API MeshNormals(MeshNormals&&) noexcept;
    VOXTACT_API MeshNormals& operator=(MeshNormals&&) noexcept;
    VOXTACT_API ~MeshNormals();

    /// Like Mesh::cmdUpload().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Like Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    /// Records the normals of a deformed mesh, in addition to Mesh::cmdUpdate(). The command buffer holds the data, 12
    /// bytes per vertex; allocates no device memory. O(vertices + triangles) on the host. Refuses what checkMesh()
    /// refuses, and another number of vertices.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer
    ///   expects             uploaded normals; waits for earlier commands that use the normals
    ///   leaves              the normals readable by vertex input, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         none is lost
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const MeshView& data);
    [[nodiscard]] MeshNormalsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit MeshNormals(std::unique_ptr<MeshNormalsImpl> impl) noexcept;
    std::unique_ptr<MeshNormalsImpl> impl_;
};

/// Returns the mesh with separate vertices on both sides of edges where two triangles meet at more than `degrees`
/// (0..180). MeshNormals of the result are sharp at these edges and smooth elsewhere. Triangles keep their order, and
/// detectors count the same. `name` and `notes` are empty. Refuses what checkMesh() refuses, also for the result, and
/// angles outside the range. O(n log n).
[[nodiscard]] VOXTACT_API Result<MeshData> splitAtCreases(const MeshView& mesh, double degrees = 40);

/// Lets the renderer read the bricks of a volume (VolumeOptions::bricks) and skip transparent ones. Copies nothing and
/// follows edits of the volume, which must outlive it.
class RenderBricks {
  public:
    /// Refuses a volume without bricks.
    [[nodiscard]] VOXTACT_API static Result<RenderBricks> create(const Renderer& renderer, const Volume& volume);
    VOXTACT_API RenderBricks(RenderBricks&&) noexcept;
    VOXTACT_API RenderBricks& operator=(RenderBricks&&) noexcept;
    VOXTACT_API ~RenderBricks();

    [[nodiscard]] RenderBricksImpl& impl() const noexcept { return *impl_; }

  private:
    explicit RenderBricks(std::unique_ptr<RenderBricksImpl> impl) noexcept;
    std::unique_ptr<RenderBricksImpl> impl_;
};

/// The triangles that Paint::Triangles paints: one bit per triangle, on the device.
class PaintedTriangles {
  public:
    /// Selects triangles by index, in any order, such as those of a BatchAnswer. Refuses indices not below
    /// `meshTriangles`, a mesh without triangles, and bits beyond the device's maxStorageBufferRange. Returns
    /// Unsupported without the feature geometryShader, which gl_PrimitiveID needs.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles>
    create(const Renderer& renderer, std::uint32_t meshTriangles, std::span<const std::uint32_t> triangles);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                     std::uint32_t meshTriangles,
                                                                     std::span<const std::uint32_t> triangles);
    /// Wraps a device buffer of bits, in uints, lowest first: Results::triangleMask() of a batch with one pair. Each
    /// picture shows the current contents. The buffer has usage STORAGE_BUFFER and must outlive this object. Refuses a
    /// null buffer, an offset that is not a multiple of 256, fewer bytes than a uint, and what create() refuses.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles> wrap(const Renderer& renderer, const BufferRange& mask);
    VOXTACT_API PaintedTriangles(PaintedTriangles&&) noexcept;
    VOXTACT_API PaintedTriangles& operator=(PaintedTriangles&&) noexcept;
    VOXTACT_API ~PaintedTriangles();

    /// Like Mesh::cmdUpload(). Refuses a wrapped mask.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Like Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    [[nodiscard]] PaintedTrianglesImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PaintedTriangles(std::unique_ptr<PaintedTrianglesImpl> impl) noexcept;
    std::unique_ptr<PaintedTrianglesImpl> impl_;
};

/// Colours of a mesh's vertices, such as the distance of each point from a target, on the device. Interpolation within
/// triangles is linear and perspective-correct. Subdivide long triangles: colours between distant vertices say little.
class PaintedVertices {
  public:
    /// Sets one colour per vertex, in the order of MeshView::positions, stored with 8 bits per channel. Refuses an
    /// empty list, components outside [0, 1], and colours beyond the device's maxStorageBufferRange, at 4 bytes each.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> create(const Renderer& renderer,
                                                                    std::span<const Colour> colours);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                    std::span<const Colour> colours);
    /// Like PaintedTriangles::wrap(), for a buffer of one uint per vertex. Red is in the lowest 8 bits, then green and
    /// blue, each from 0 to 255 (packUnorm4x8 of GLSL). Does not need geometryShader.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> wrap(const Renderer& renderer, const BufferRange& colours);
    VOXTACT_API PaintedVertices(PaintedVertices&&) noexcept;
    VOXTACT_API PaintedVertices& operator=(PaintedVertices&&) noexcept;
    VOXTACT_API ~PaintedVertices();

    /// Like Mesh::cmdUpload(). Refuses wrapped colours.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Like Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    [[nodiscard]] PaintedVerticesImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PaintedVertices(std::unique_ptr<PaintedVerticesImpl> impl) noexcept;
    std::unique_ptr<PaintedVerticesImpl> impl_;
};

} // namespace voxtact
