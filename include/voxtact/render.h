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

/// Pictures (target voxtact::render): a translucent volume by ray casting, and an opaque mesh in it at the right depth.
/// Volume and Mesh are those that the detector uses: one upload serves both.
///
/// Ray casting: a triangle that fills the picture, and for each pixel the part of its ray that is in the volume's box,
/// from the inverse of the camera's matrix. The faces of the box are never rasterised, so the eye may be inside it, and
/// orthographic and perspective cameras are one case. Samples are a step apart along the ray, in millimetres. Between
/// two samples colour and opacity come from a table that holds the integral over all scalars between the two
/// (pre-integrated classification: Engel, Kraus and Ertl, "High-Quality Pre-Integrated Volume Rendering Using
/// Hardware-Accelerated Pixel Shading", 2001), so that a thin shell in the transfer function is not missed between two
/// samples. A ray ends where its opacity reaches 0.99.
///
/// Clipping planes take a part of the volume away. Where one of them, or the volume's own border, cuts through what is
/// visible, the gradient says nothing about the cut: such a face is shaded with its plane's normal.
///
/// What a detector decides about the mesh can be painted on it (MeshPaint). A fragment of the mesh is a pixel that it
/// covers: each that is seen is decided by the detector's own shader text, from the same numbers.
///
/// Colours are in the space of the picture: nothing is converted. For an sRGB picture in a UNORM image they are sRGB.
///
/// Lifetime: everything must outlive the command buffers that use it. What a Renderer made may outlive it.
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
    TransferFunctionDesc opacity{};            ///< the same as the detector's; at most 1024 entries
    std::span<const ColourPoint> colours = {}; ///< ascending values; constant outside; none: white
    /// The length of material that `opacity` is for, mm: a ray has absorbed that much after so long a way. Opacities
    /// above 0.999 count as 0.999.
    double opacityUnit = 1;
    double step = 0.5; ///< mm from one sample of a ray to the next; half a voxel is a good one
};

/// What a Renderer is made for.
struct RendererDesc {
    VkFormat colorFormat = VK_FORMAT_R8G8B8A8_UNORM; ///< of the pictures; a colour attachment. There is no depth image
};

/// The most that a number of Lighting may be.
inline constexpr double kMaxLight = 1e6;

/// How light falls: from the eye and from its side, on both sides of a surface (Blinn-Phong). `ambient`, `diffuse`,
/// `specular`, `shininess` and `side` are from 0 to kMaxLight.
struct Lighting {
    bool volume = true;    ///< by the gradient, from central differences; false: the colours as they are
    bool mesh = true;      ///< the same for meshes
    double ambient = 0.25; ///< light from everywhere
    double diffuse = 0.75; ///< of the light at the eye
    double specular = 0.2; ///< how bright glints are
    double shininess = 30; ///< how small they are
    /// What a second light adds where a surface faces it; its glint is this part of `specular`.
    double side = 0;
    Vec3 sideFrom{-0.55, 0.6, 0.6}; ///< where it is: to the picture's right, up, and towards the eye; of any length
    /// 0..1: how dark a place of the volume is that is shut in. What is between it and `reach` mm, half-way
    /// between its normal and the way to the eye, shuts in; faces of a cut are open.
    double occlusion = 0;
    double reach = 8; ///< mm
    /// Where the border of the volume, a clipping plane or the near plane cuts through what is visible: light falls on
    /// the plane, all of it from the eye and without gloss, for two voxels of the longest spacing behind it, and goes
    /// over to the gradient in two more. false: the gradient at once, which is noise on such a face.
    bool faces = true;
};
/// The light of that name. `soft`: from the eye and from above its left, darker where a place is shut in, by what is
/// within a part of the volume's diagonal; `eye`: Lighting's defaults; `none`: colours as they are. Nothing for
/// another.
[[nodiscard]] VOXTACT_API std::optional<Lighting> lightingNamed(std::string_view name, const Grid& grid) noexcept;

/// The side `normal` points to is away: points p of world space with dot(normal, p) > offset.
struct ClipPlane {
    Vec3 normal{};     ///< of any length; it scales `offset`
    double offset = 0; ///< mm along the normal, where that is of length 1
};
/// Planes that a Scene may have.
inline constexpr std::size_t kMaxClipPlanes = 6;
/// What takes a side of a volume away. `left`, `right`, `back`, `front`, `top` and `bottom`: that side of a plane at
/// `at` mm of the world's x, y or z; `near`: what is nearer to the eye than `at` mm before the volume's middle. Without
/// `at` the plane goes through the middle. `towardsEye`, of unit length, matters to `near` alone. Nothing for another
/// name.
[[nodiscard]] VOXTACT_API std::optional<ClipPlane> clipSide(std::string_view side, std::optional<double> at,
                                                            const Grid& grid, const Vec3& towardsEye) noexcept;

class RenderTransferFunction;
class RenderTargets;
class MeshNormals;
class RenderBricks;
class PaintedTriangles;
class PaintedVertices;

/// What a mesh shows of what is known about it.
enum class Paint : std::uint32_t {
    Plain,     ///< nothing: all of it has Scene::meshColour
    Contacts,  ///< its survivors
    Discarded, ///< its discarded fragments, and its survivors by their opacity: from dark gray at the threshold to
               ///< white
    Triangles, ///< chosen triangles
    Vertices,  ///< a colour of its own for each vertex, and in between what lies between
};

/// How a mesh is painted. Light falls on the paint as on the mesh. Where the mesh hides itself, the nearest fragment is
/// the one that is seen.
///
/// With Contacts and Discarded a fragment survives where Detector, by a method of the rasteriser in Projection::View
/// with Filter::Hardware, counts it: for a View of Scene::clip_from_world and of Target::extent. (Boundary::Clamp may
/// differ where it is asked for; Auto does not.)
struct MeshPaint {
    Paint what = Paint::Plain;                          ///< what is painted
    const TransferFunction* transferFunction = nullptr; ///< the detector's; for Contacts and Discarded
    double threshold = kDefaultThreshold;               ///< the same; 0..1
    const PaintedTriangles* triangles = nullptr;        ///< for Triangles; of Scene::mesh
    const PaintedVertices* vertices = nullptr;          ///< for Vertices; of Scene::mesh, see SceneMesh::normals
    Colour contactColour{1, 0.23, 0.08};                ///< of survivors and chosen triangles; the rest: meshColour
    Colour discardedColour{0.16, 0.36, 0.88};           ///< for Discarded, of what does not survive
    /// 0..1: how much of what is painted is seen through the volume before it: survivors and chosen triangles; with
    /// Discarded and Vertices all of the mesh. 0: it is as deep in the volume as the rest. 1: nothing of the volume is
    /// before it.
    double through = 0;
};

/// A mesh at a pose, and how it looks.
struct SceneMesh {
    const Mesh* mesh = nullptr; ///< what is drawn
    /// Optional, of `mesh`: smooth; without, each triangle is flat. Of a wrapped mesh: of at least
    /// WrappedMesh::vertexCount vertices, or three per triangle where it has no indices.
    const MeshNormals* normals = nullptr;
    Mat4 world_from_object = identity(); ///< of the mesh; affine, not singular
    Colour meshColour{0.75, 0.78, 0.82}; ///< where nothing is painted
    MeshPaint paint{};                   ///< what of it has another colour
    bool clipped = false;                ///< by Scene::clipPlanes, as the volume is
};
/// A SceneMesh::meshColour for each of several meshes: apart from each other, from tissue, and from the colours of
/// contacts. The first is that of a SceneMesh; after six they begin again.
[[nodiscard]] VOXTACT_API Colour meshColour(std::size_t number) noexcept;
/// A MeshPaint::through that shows what is painted: 0.8, and 1 of Discarded, where all of the mesh is painted.
[[nodiscard]] VOXTACT_API double throughFor(Paint paint) noexcept;

/// What is to be seen: a volume, and meshes in it. It is its first mesh itself; without one, `mesh` is null.
struct Scene : SceneMesh {
    const Volume* volume = nullptr;                           ///< must be given
    const RenderTransferFunction* transferFunction = nullptr; ///< must be given
    const RenderBricks* bricks = nullptr;                     ///< optional, of `volume`: what is transparent is skipped
    std::span<const SceneMesh> others = {};     ///< further meshes, or the same at further poses; none is null
    std::span<const ClipPlane> clipPlanes = {}; ///< at most kMaxClipPlanes: what any of them takes away is away
    /// Orthographic or perspective; not singular. The near plane may be at depth 0 or 1, the far one at infinity.
    Mat4 clip_from_world{};
    Colour background{}; ///< behind everything
    Lighting lighting{}; ///< of the volume and of all meshes
    /// The first sample of each ray is moved by a part of the step that is a hash of the pixel: noise instead of bands,
    /// the same in every picture of one size.
    bool jitter = true;
};

/// Where the picture goes.
struct Target {
    VkImageView view = VK_NULL_HANDLE; ///< of RendererDesc::colorFormat, one sample, usage COLOR_ATTACHMENT
    VkExtent2D extent{};               ///< of the picture, from the image's corner; at most that of `targets`
    VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL; ///< or GENERAL; while the commands execute
    RenderTargets* targets = nullptr;                                ///< must be given; of this Renderer
    /// The part of the picture that is made; without an extent all of it. Pixels outside are left as they are, and
    /// those inside are the same as in the whole: a picture that takes long can be made in pieces.
    VkRect2D area{};
    /// A pool of timestamps, or null. Three are written, from firstTimestamp on: when the work before the picture is
    /// done, when the mesh is, and when the volume is. The caller has reset them, and the queue's family has
    /// timestamps.
    VkQueryPool timestamps = VK_NULL_HANDLE;
    std::uint32_t firstTimestamp = 0; ///< number of the first query in `timestamps`
};

/// Makes pictures in one colour format.
class Renderer {
  public:
    /// Unsupported where the device cannot render to the format, its pixels are integers, or the device lacks another
    /// format that the renderer needs.
    [[nodiscard]] VOXTACT_API static Result<Renderer> create(const Context& context, const RendererDesc& desc = {});
    VOXTACT_API Renderer(Renderer&&) noexcept;
    VOXTACT_API Renderer& operator=(Renderer&&) noexcept;
    VOXTACT_API ~Renderer();

    /// Records a picture: no allocation, no submission, no wait. All pixels of the extent, or of Target::area, are
    /// written, with alpha 1.
    ///
    ///   call it          outside a render pass, in a primary command buffer, on a queue with graphics
    ///   expects          volume, bricks, transfer functions, mesh, normals and painted triangles readable as
    ///                    cmdUpload() leaves them, wrapped ones in the layout that was given and made visible to
    ///                    VERTEX_INPUT / FRAGMENT_SHADER by the caller; the target's image in Target::layout, ready for
    ///                    COLOR_ATTACHMENT_OUTPUT / COLOR_ATTACHMENT_WRITE; what is in the area is discarded
    ///   leaves           the image in the same layout, written at COLOR_ATTACHMENT_OUTPUT / COLOR_ATTACHMENT_WRITE:
    ///                    the next reader waits for that
    ///   targets          an earlier use of the same RenderTargets in this queue is waited for
    ///   queries          no occlusion query may be active
    ///   bound state lost graphics pipeline, descriptor sets 0..3 of the graphics bind point, vertex bindings 0 and 1,
    ///                    index buffer, push constants, dynamic viewport and scissor
    ///
    /// On error nothing was recorded. Refuses a singular camera or pose, colours outside 0..1, objects that do not
    /// belong together, a step that gives a ray through the volume more than 65536 samples, a paint without what it
    /// needs, a clipping plane whose normal is zero, more than kMaxClipPlanes of them, and an area that is not in the
    /// picture.
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

/// The blocking convenience: renders into an image of its own (R8G8B8A8_UNORM), submits on the caller's queue, waits,
/// and reads the picture. Keeps its images for the next picture of the same size.
/// Thread-safety: none; one thread at a time.
class BlockingRenderer {
  public:
    /// `queue` needs graphics.
    [[nodiscard]] VOXTACT_API static Result<BlockingRenderer> create(const Context& context, const QueueAccess& queue);
    VOXTACT_API BlockingRenderer(BlockingRenderer&&) noexcept;
    VOXTACT_API BlockingRenderer& operator=(BlockingRenderer&&) noexcept;
    VOXTACT_API ~BlockingRenderer();

    /// How far a picture is: rows that are done, and all. False: no more is drawn, and render() returns Cancelled.
    using Progress = std::function<bool(std::uint32_t done, std::uint32_t rows)>;

    /// Refuses what RenderTargets::create() and Renderer::cmdRender() refuse.
    [[nodiscard]] VOXTACT_API Result<Picture> render(const Scene& scene, VkExtent2D extent);
    /// The same picture, but in bands of rows, a submission each, of about a fifth of a second: `progress` is called
    /// after each, on this thread, and may end it there. It must not throw. After Cancelled the next picture may be
    /// asked for at once.
    [[nodiscard]] VOXTACT_API Result<Picture> render(const Scene& scene, VkExtent2D extent, const Progress& progress);
    /// The renderer that records, to make the objects of a Scene with; it lives as long as this object.
    [[nodiscard]] VOXTACT_API const Renderer& renderer() const noexcept;

  private:
    struct State;
    explicit BlockingRenderer(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Scalar -> opacity and colour, on the device: the table that pre-integrated classification reads, with as many
/// columns and rows as the opacity has entries.
class RenderTransferFunction {
  public:
    /// Refuses what sampleTable() refuses, for opacity and colours, and a step or opacity unit that is not positive and
    /// finite.
    [[nodiscard]] VOXTACT_API static Result<RenderTransferFunction> create(const Renderer& renderer,
                                                                           const RenderTransferFunctionDesc& desc);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<RenderTransferFunction>
    upload(const Renderer& renderer, const QueueAccess& queue, const RenderTransferFunctionDesc& desc);
    VOXTACT_API RenderTransferFunction(RenderTransferFunction&&) noexcept;
    VOXTACT_API RenderTransferFunction& operator=(RenderTransferFunction&&) noexcept;
    VOXTACT_API ~RenderTransferFunction();

    /// Makes the table.
    ///   call it       outside a render pass, on a queue with compute
    ///   expects       nothing; earlier commands that read the table are waited for
    ///   leaves        the table readable by any shader stage, in every later command
    ///   queries       an active occlusion query is not affected
    ///   bound state   lost: compute pipeline, descriptor sets of the compute bind point, push constants
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// The same for a new function with as many entries. No device memory is allocated. It takes effect in
    /// command-buffer order but for domain and step, which change at once: record in the order in which the commands
    /// will be executed.
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const RenderTransferFunctionDesc& desc);

    /// Whether some entry of the table has an opacity above 0: without, the volume is not to be seen.
    [[nodiscard]] VOXTACT_API bool visible() const noexcept;

    /// For upload().
    void releaseStaging() noexcept {}
    [[nodiscard]] RenderTransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit RenderTransferFunction(std::unique_ptr<RenderTransferFunctionImpl> impl) noexcept;
    std::unique_ptr<RenderTransferFunctionImpl> impl_;
};

/// The images between the passes of one picture in flight. Thread-safety: none; one recording at a time.
class RenderTargets {
  public:
    /// Refuses an extent of zero, or beyond Context::maxViewport().
    [[nodiscard]] VOXTACT_API static Result<RenderTargets> create(const Renderer& renderer, VkExtent2D extent);
    VOXTACT_API RenderTargets(RenderTargets&&) noexcept;
    VOXTACT_API RenderTargets& operator=(RenderTargets&&) noexcept;
    VOXTACT_API ~RenderTargets();

    /// The largest picture that they are good for.
    [[nodiscard]] VOXTACT_API VkExtent2D extent() const noexcept;
    [[nodiscard]] RenderTargetsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit RenderTargets(std::unique_ptr<RenderTargetsImpl> impl) noexcept;
    std::unique_ptr<RenderTargetsImpl> impl_;
};

/// The normals of a mesh's vertices, in addition to its positions: the mean of the triangles round a vertex, weighted
/// by area.
class MeshNormals {
  public:
    /// Refuses what checkMesh() refuses.
    [[nodiscard]] VOXTACT_API static Result<MeshNormals> create(const Renderer& renderer, const MeshView& data);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<MeshNormals> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                const MeshView& data);
    VOXTACT_API MeshNormals(MeshNormals&&) noexcept;
    VOXTACT_API MeshNormals& operator=(MeshNormals&&) noexcept;
    VOXTACT_API ~MeshNormals();

    /// As Mesh::cmdUpload().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// As Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    /// Records the normals of another shape of the mesh, in addition to Mesh::cmdUpdate(): `data` has as many vertices.
    /// They are kept in the command buffer itself, 12 bytes each; no device memory is allocated. O(vertices +
    /// triangles) on the host. Refuses what checkMesh() refuses, and another number of vertices.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer
    ///   expects             normals that were uploaded; earlier commands that use them are waited for
    ///   leaves              the normals readable by vertex input, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         none is lost
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const MeshView& data);
    [[nodiscard]] MeshNormalsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit MeshNormals(std::unique_ptr<MeshNormalsImpl> impl) noexcept;
    std::unique_ptr<MeshNormalsImpl> impl_;
};

/// The same triangles in the same order, but with vertices of their own on either side of an edge at which two meet at
/// more than `degrees` (0..180): MeshNormals of this mesh are smooth elsewhere, and have sharp edges there. `name` and
/// `notes` are empty. Detectors count the same for it. Refuses what checkMesh() refuses, also of the result, and angles
/// outside. O(n log n).
[[nodiscard]] VOXTACT_API Result<MeshData> splitAtCreases(const MeshView& mesh, double degrees = 40);

/// Lets the renderer read the bricks of a volume (VolumeOptions::bricks), to skip those that are transparent. Nothing
/// is copied: edits of the volume are followed. The volume must outlive it.
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

/// Which triangles of a mesh Paint::Triangles paints: a bit for each, on the device.
class PaintedTriangles {
  public:
    /// Triangles by their numbers, in any order, of a mesh that has `meshTriangles`: those of a BatchAnswer, say.
    /// Refuses numbers beyond, a mesh without triangles, and one whose bits are more than the device's
    /// maxStorageBufferRange. Unsupported where the feature geometryShader is not enabled, which gl_PrimitiveID needs.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles>
    create(const Renderer& renderer, std::uint32_t meshTriangles, std::span<const std::uint32_t> triangles);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                     std::uint32_t meshTriangles,
                                                                     std::span<const std::uint32_t> triangles);
    /// Bits that are on the device already, in uints, lowest first: Results::triangleMask(), where the batch has one
    /// pair. Nothing is copied: every picture shows what the buffer holds then. It must outlive this; usage
    /// STORAGE_BUFFER. Refuses a null buffer, an offset that is no multiple of 256, fewer bytes than a uint, and what
    /// create() refuses.
    [[nodiscard]] VOXTACT_API static Result<PaintedTriangles> wrap(const Renderer& renderer, const BufferRange& mask);
    VOXTACT_API PaintedTriangles(PaintedTriangles&&) noexcept;
    VOXTACT_API PaintedTriangles& operator=(PaintedTriangles&&) noexcept;
    VOXTACT_API ~PaintedTriangles();

    /// As Mesh::cmdUpload(). A wrapped mask is refused.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// As Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    [[nodiscard]] PaintedTrianglesImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PaintedTriangles(std::unique_ptr<PaintedTrianglesImpl> impl) noexcept;
    std::unique_ptr<PaintedTrianglesImpl> impl_;
};

/// Colours of a mesh's vertices: a measure of a surface, say, as how far each place of it is from something. Within a
/// triangle they are mixed linearly, in the picture's perspective. Between far vertices a mixture of colours says
/// little: give long triangles more vertices.
class PaintedVertices {
  public:
    /// A colour for each vertex, in the order of MeshView::positions; 0..1, kept in 8 bits a channel. Refuses no
    /// colours at all, components outside [0, 1], and more than the device's maxStorageBufferRange holds, 4 bytes each.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> create(const Renderer& renderer,
                                                                    std::span<const Colour> colours);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> upload(const Renderer& renderer, const QueueAccess& queue,
                                                                    std::span<const Colour> colours);
    /// Colours that are on the device already: a uint for each vertex, red in its lowest 8 bits, then green and blue,
    /// each from 0 to 255 (packUnorm4x8 of GLSL). Nothing is copied: every picture shows what the buffer holds then.
    /// It must outlive this; usage STORAGE_BUFFER. Refuses a null buffer, an offset that is no multiple of 256, fewer
    /// bytes than a uint, and what create() refuses.
    [[nodiscard]] VOXTACT_API static Result<PaintedVertices> wrap(const Renderer& renderer, const BufferRange& colours);
    VOXTACT_API PaintedVertices(PaintedVertices&&) noexcept;
    VOXTACT_API PaintedVertices& operator=(PaintedVertices&&) noexcept;
    VOXTACT_API ~PaintedVertices();

    /// As Mesh::cmdUpload(). Wrapped colours are refused.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// As Mesh::releaseStaging().
    VOXTACT_API void releaseStaging() noexcept;
    [[nodiscard]] PaintedVerticesImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PaintedVertices(std::unique_ptr<PaintedVerticesImpl> impl) noexcept;
    std::unique_ptr<PaintedVerticesImpl> impl_;
};

} // namespace voxtact
