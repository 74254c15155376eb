// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"
#include "voxtact/data.h"

#include <optional>
#include <variant>

/// The scene on the device. Each object is either uploaded from host memory or wrapped around the caller's own Vulkan
/// objects, which are then never freed, written or transitioned.
///
/// create() makes the device object and fills a staging buffer; wrap() uses objects of the caller's. cmdPrepare()
/// records for any number of both what they need before their first use, and retire() frees the staging buffers when
/// that submission is complete. cmdUpload() and releaseStaging() are the same for one object; upload() does all of it
/// on the caller's queue, and waits.
///
/// Every cmdUpload():
///   call it             outside a render pass, on a queue with graphics (or with compute and transfer)
///   expects             nothing; the object's former contents are discarded, and those of create() are there again
///   leaves              the object readable by vertex input and by any shader stage, in every later command
///   queries             an active occlusion query is not affected
///   bound state         none is lost
///
/// Lifetime: an object must outlive the command buffers that use it, and end before the device.
/// Thread-safety: const functions are safe from any thread; all others need the caller's own lock.
namespace voxtact {

struct VolumeImpl;
struct TransferFunctionImpl;
struct MeshImpl;
struct PoseBufferImpl;
struct LabelMapImpl;

/// An image of the caller's.
struct WrappedVolume {
    VkImageView view = VK_NULL_HANDLE;     ///< 3D, one mip level, component r sampled
    VkFormat format = VK_FORMAT_UNDEFINED; ///< R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT or R32_SFLOAT
    /// While commands execute: SHADER_READ_ONLY_OPTIMAL, READ_ONLY_OPTIMAL or GENERAL.
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    Grid grid{}; ///< where its voxels are
    /// value = slope * stored + intercept, where stored is the integer behind a UNORM or SNORM texel, or the float.
    double slope = 1;
    double intercept = 0; ///< in the image's units
    /// All values that the voxels on the image's faces take, where the caller knows: lets Boundary::Auto clamp. Refused
    /// where they are no range.
    std::optional<ValueRange> boundaryValues;
    /// As in VolumeOptions: the projection certified needs them. Not to be used before the first
    /// Volume::cmdUpdateBricks(), of the whole grid.
    bool bricks = false;
};

/// What a volume is made with in addition to its voxels.
struct VolumeOptions {
    const char* name = nullptr; ///< appears on the Vulkan objects; may be null
    /// Keeps the range of values of every brick of 8^3 cells on the device, which passes that skip what is transparent
    /// need. 16 bytes per brick, and about a seventh more for boxes of 2^3, 4^3, ... bricks; refused where they are
    /// more than the device's maxStorageBufferRange.
    bool bricks = false;
    /// Allows cmdSet(), cmdWrite() and cmdCopy(); keeps room on the device for the texels of one slice or of a MiB,
    /// what is more, and 64 KiB for rows. Refused where a slice has more than the device's maxStorageBufferRange.
    bool editable = false;
};

/// A 3D image on the device.
class Volume {
  public:
    /// Refuses what checkVolume() refuses, and a volume beyond the device's limits (which limit, how large).
    [[nodiscard]] VOXTACT_API static Result<Volume> create(const Context& context, const VolumeView& data,
                                                           const VolumeOptions& options = {});
    /// Uses an image of the caller's, which must outlive this. Refuses a null view, a format or layout that is none of
    /// those in WrappedVolume, a slope that is 0, what checkGrid() refuses, and a grid beyond the device's limits.
    [[nodiscard]] VOXTACT_API static Result<Volume> wrap(const Context& context, const WrappedVolume& wrapped);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<Volume> upload(const Context& context, const QueueAccess& queue,
                                                           const VolumeView& data, const VolumeOptions& options = {});
    VOXTACT_API Volume(Volume&&) noexcept;
    VOXTACT_API Volume& operator=(Volume&&) noexcept;
    VOXTACT_API ~Volume();

    /// With VolumeOptions::bricks also fills the bricks: the queue needs compute, and the bound state that is lost is
    /// that of cmdUpdateBricks().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Brings the bricks up to date after the caller changed voxels of a wrapped image; `changed` holds all of them.
    /// Refuses a box that leaves the grid, and a volume without bricks.
    ///   call it             outside a render pass, on a queue with compute
    ///   expects             the image in the wrapped layout; earlier commands that wrote it are waited for
    ///   leaves              the bricks readable by every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         lost: compute pipeline, descriptor sets of the compute bind point, push constants
    VOXTACT_API Result<void> cmdUpdateBricks(VkCommandBuffer commandBuffer, const VoxelBox& changed);

    /// Edits in place, of a volume with VolumeOptions::editable. Each takes effect in command-buffer order: what is
    /// recorded before it counts the old voxels, what is recorded after it the new ones. The bricks follow. No device
    /// memory is allocated.
    ///
    /// What the host knows of the volume changes at once, to the safe side: valueRange() also holds the new values, or
    /// is nothing after cmdCopy(); and after an edit that reaches the image's faces Boundary::Auto takes the range test
    /// from then on. Record in the order in which the commands will be executed, and record again whatever was recorded
    /// before such an edit and is to be submitted after it.
    ///   call it             outside a render pass, on a queue with graphics or compute; a Ball, or with bricks: with
    ///                       compute
    ///   expects             a volume that was uploaded; earlier commands that use it are waited for
    ///   leaves              the volume readable by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         a Ball, or with bricks: lost as by cmdUpdateBricks(); otherwise none
    ///
    /// Gives all voxels of a region one value, in the image's units; floats the nearest one. The faces cut a Ball off.
    /// Of a Ball the host decides which voxels it has, as cpu::Volume::set(); one dispatch changes them, or one for
    /// each MiB of the box around it. A box is filled and copied. Refuses what cpu::Volume::set() does: NaN, infinite,
    /// out of the type's range or, for integers, not whole.
    VOXTACT_API Result<void> cmdSet(VkCommandBuffer commandBuffer, const VoxelRegion& region, double value);
    /// Writes the voxels of a box: scalars of the volume's type, as in VolumeView. They are kept in the command buffer
    /// itself, which is for small edits; a large one is a cmdCopy(). Refuses what checkVolume() refuses.
    VOXTACT_API Result<void> cmdWrite(VkCommandBuffer commandBuffer, const VoxelBox& box,
                                      std::span<const std::byte> voxels);
    /// Copies the voxels of a box from a buffer of the caller's with usage TRANSFER_SRC, in the order of VolumeView, as
    /// format() has them: int16 with its sign bit flipped, as uint16. Nothing looks at the values: floats must be
    /// finite. `offset` is in bytes, a multiple of 4. Earlier commands that wrote the buffer are waited for.
    VOXTACT_API Result<void> cmdCopy(VkCommandBuffer commandBuffer, const VoxelBox& box, VkBuffer source,
                                     VkDeviceSize offset);

    /// Where the voxels are.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;
    /// Smallest and largest voxel in the image's units; after edits, a range that holds all. Nothing for a wrapped
    /// volume, and after cmdCopy().
    [[nodiscard]] VOXTACT_API std::optional<ValueRange> valueRange() const noexcept;
    /// The image on the device, for passes of the caller's: 3D, in SHADER_READ_ONLY_OPTIMAL, or as it was wrapped.
    [[nodiscard]] VOXTACT_API VkImageView view() const noexcept;
    /// Its format; int16 voxels are kept as R16_UNORM with their sign bit flipped.
    [[nodiscard]] VOXTACT_API VkFormat format() const noexcept;

    [[nodiscard]] VolumeImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Volume(std::unique_ptr<VolumeImpl> impl) noexcept;
    std::unique_ptr<VolumeImpl> impl_;
};

/// A table of the caller's. Filter::Hardware needs a format that the device filters linearly; nobody can ask the view.
struct WrappedTransferFunction {
    VkImageView view = VK_NULL_HANDLE;                               ///< 1D, opacity in component r
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; ///< while commands execute
    ValueRange domain{};                                             ///< the values that the table covers; lo < hi
    /// The same table on the host, where the caller has it: lets Boundary::Auto prove that it may clamp. The projection
    /// `certified` needs it: the function is then linear between its entries.
    std::span<const float> table;
};

/// Scalar -> opacity, on the device.
class TransferFunction {
  public:
    /// Refuses what sampleTable() refuses, and a table beyond the device's limits. `name` appears on the Vulkan
    /// objects.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction>
    create(const Context& context, const TransferFunctionDesc& desc, const char* name = nullptr);
    /// Uses a table of the caller's, which must outlive this. Refuses a null view, a layout that no shader can
    /// sample, and a domain that is empty.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> wrap(const Context& context,
                                                                   const WrappedTransferFunction& wrapped);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> upload(const Context& context, const QueueAccess& queue,
                                                                     const TransferFunctionDesc& desc,
                                                                     const char* name = nullptr);
    VOXTACT_API TransferFunction(TransferFunction&&) noexcept;
    VOXTACT_API TransferFunction& operator=(TransferFunction&&) noexcept;
    VOXTACT_API ~TransferFunction();

    /// Records the copy to the device; see above for what it expects and leaves. domain() is that of create() again.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Records a new table, of the same size, for the same or another domain. It takes effect in command-buffer order;
    /// no device memory is allocated. Refuses what sampleTable() refuses, another size, and a wrapped table.
    ///
    /// domain() changes at once. What is recorded later counts with the new domain, what was recorded before with the
    /// old one: record in the order in which the commands will be executed, and record again whatever was recorded
    /// before this and is to be submitted after it.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer
    ///   expects             nothing: a table that was never uploaded is filled as well. Earlier commands that read it
    ///                       are waited for
    ///   leaves              the table readable by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         none is lost
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const TransferFunctionDesc& desc);

    /// The values that the table covers, as recorded last.
    [[nodiscard]] VOXTACT_API ValueRange domain() const noexcept;
    [[nodiscard]] VOXTACT_API std::uint32_t tableSize() const noexcept; ///< 0 for a wrapped one without a host table

    [[nodiscard]] TransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept;
    std::unique_ptr<TransferFunctionImpl> impl_;
};

/// Buffers of the caller's. Vertices are three floats each at the start of a stride, in object space: where they are
/// far from the origin, floats lose what only vertices on the host keep.
struct WrappedMesh {
    VkBuffer vertices = VK_NULL_HANDLE; ///< usage VERTEX_BUFFER
    VkDeviceSize vertexOffset = 0;      ///< bytes, of the first position; a multiple of 4
    /// Bytes; at least 12, a multiple of 4. Drawing it (by a rasteriser's method in `view` or `two-view`, or in a
    /// picture) is LimitExceeded beyond the device's maxVertexInputBindingStride; `compute` and `dominant-axis` take
    /// any.
    std::uint32_t vertexStride = 12;
    std::uint32_t vertexCount = 0;                ///< vertices in the buffer
    VkBuffer indices = VK_NULL_HANDLE;            ///< usage INDEX_BUFFER; null: every three vertices are a triangle
    VkDeviceSize indexOffset = 0;                 ///< bytes
    VkIndexType indexType = VK_INDEX_TYPE_UINT32; ///< UINT16 or UINT32
    std::uint32_t triangleCount = 0;              ///< triangles that are drawn
    /// The buffers also have usage STORAGE_BUFFER, which the counting method `compute` and the projection
    /// `dominant-axis` need. 16-bit indices must then be followed by two more bytes where they end in the middle of
    /// four.
    bool storage = false;
    /// As in MeshOptions; needs `storage`. Clusters and a copy of the indices are kept on the device, 17 bytes a
    /// triangle. Not to be used before the first cmdUpload(); what changes the buffers later is followed by a
    /// cmdRefit().
    bool clusters = false;
    /// For clusters, where the caller has them: the triangles on the host, in the same order. They are only examined
    /// to find which are near each other: vertices may have gone elsewhere. Empty: 64 triangles that follow each other
    /// are a cluster.
    MeshView shape{};
};

/// How a mesh is made.
struct MeshOptions {
    const char* name = nullptr; ///< appears on the Vulkan objects; may be null
    /// Also creates and keeps clusters of near triangles, 4 to 5 bytes per triangle, for the projection
    /// `certified` to skip those that cannot touch. create() then sorts the triangles, O(n log n).
    bool clusters = false;
    /// Allows cmdUpdate() and cmdCopy(); keeps the triangles on the host, 12 bytes each, 16 with clusters.
    bool editable = false;
    /// Bytes from one vertex to the next on the device; as in WrappedMesh. More than 12 are for cmdCopy(), from buffers
    /// whose vertices are as far apart.
    std::uint32_t vertexStride = 12;
};

/// A triangle mesh on the device.
class Mesh {
  public:
    /// Refuses what checkMesh() refuses, and a stride that MeshOptions does not allow.
    [[nodiscard]] VOXTACT_API static Result<Mesh> create(const Context& context, const MeshView& data,
                                                         const MeshOptions& options = {});
    /// Uses buffers of the caller's, which must outlive this. Their contents are not examined: vertices must be finite
    /// and indices in range. Refuses null vertices, strides and offsets that WrappedMesh does not allow, no triangles,
    /// and with clusters: buffers without `storage`, more than the device's maxStorageBufferRange of them, a `shape`
    /// that checkMesh() refuses or that has another number of triangles.
    [[nodiscard]] VOXTACT_API static Result<Mesh> wrap(const Context& context, const WrappedMesh& wrapped);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<Mesh> upload(const Context& context, const QueueAccess& queue,
                                                         const MeshView& data, const MeshOptions& options = {});
    VOXTACT_API Mesh(Mesh&&) noexcept;
    VOXTACT_API Mesh& operator=(Mesh&&) noexcept;
    VOXTACT_API ~Mesh();

    /// Records the copy to the device; see above for what it expects and leaves. Of a wrapped mesh with clusters: what
    /// is kept of these, and a cmdRefit(); what that one says holds then.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Bends a mesh with MeshOptions::editable: vertices come elsewhere, and triangles stay between them. Each takes
    /// effect in command-buffer order: what is recorded before it counts and shows the old shape, what is recorded
    /// after it the new one. Answers are bit for bit those of a mesh that is newly made; triangles stay in their
    /// clusters, whose boxes are fitted to them on the device. Where neighbours go far apart, a new mesh is
    /// faster to ask. No device memory is allocated.
    ///
    /// What the host knows of the mesh changes at once, facts() and how batches are cut into dispatches: record in the
    /// order in which the commands will be executed, and record again whatever was recorded before this and is to be
    /// submitted after it.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer; one with compute
    ///                       where the mesh has clusters
    ///   expects             a mesh that was uploaded; earlier commands that use it are waited for
    ///   leaves              the mesh readable by vertex input and by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         with clusters: lost as by Volume::cmdUpdateBricks(); otherwise none
    ///
    /// New vertices from host memory, three coordinates each in the order of MeshView::positions. They are kept in the
    /// command buffer itself, `vertexStride` bytes each, so that frames in flight share nothing. facts() are theirs.
    /// O(vertices + triangles). Refuses another number of coordinates and what checkMesh() refuses; the mesh is then as
    /// it was.
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, std::span<const double> positions);
    /// Copies the vertices from a buffer of the caller's with usage TRANSFER_SRC: three floats each, and from one to
    /// the next MeshOptions::vertexStride bytes, all of which are copied, but for the last vertex, of which 12 are.
    /// `offset` is in bytes, a multiple of 4. Earlier commands that wrote the buffer are waited for. Nothing looks at
    /// the values: they must be finite, else answers say nothing about the triangles that have others. They are object
    /// space, which floats must hold: only vertices that the host gives are kept relative to a centre of their own.
    /// facts() are nothing from then on, until the next cmdUpdate(). O(1) on the host.
    VOXTACT_API Result<void> cmdCopy(VkCommandBuffer commandBuffer, VkBuffer source, VkDeviceSize offset);

    /// Fits the clusters of a wrapped mesh to what its buffers hold after the caller changed vertices or indices. It
    /// takes effect in command-buffer order. No device memory is allocated. Refuses a mesh that is not wrapped or has
    /// no clusters.
    ///   call it             outside a render pass, on a queue with compute
    ///   expects             a mesh whose cmdUpload() was recorded; earlier commands that wrote the caller's buffers or
    ///                       use the clusters are waited for
    ///   leaves              the clusters and the caller's buffers readable by vertex input and by any shader stage, in
    ///                       every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         lost as by Volume::cmdUpdateBricks()
    VOXTACT_API Result<void> cmdRefit(VkCommandBuffer commandBuffer);

    /// How many there are.
    [[nodiscard]] VOXTACT_API std::uint32_t triangles() const noexcept;
    /// Of the vertices as they were recorded last. Nothing for a wrapped mesh, and after cmdCopy().
    [[nodiscard]] VOXTACT_API std::optional<MeshFacts> facts() const noexcept;

    [[nodiscard]] MeshImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Mesh(std::unique_ptr<MeshImpl> impl) noexcept;
    std::unique_ptr<MeshImpl> impl_;
};

/// Poses in a buffer of the caller's, where a shader of theirs has written them, or the host into mapped memory:
/// `world_from_object`, 16 floats each, column-major, which is a mat4 of std430. The last row must be 0 0 0 1.
struct WrappedPoses {
    VkBuffer buffer = VK_NULL_HANDLE; ///< usage STORAGE_BUFFER
    VkDeviceSize offset = 0;          ///< bytes, of the first one; a multiple of 4
    VkDeviceSize stride = 64;         ///< bytes from one to the next; at least 64, a multiple of 4
    std::uint32_t count = 0;          ///< poses in the buffer, at least 1
    /// Upper bound of the scaling by any pose; 1 is a rigid motion. Positive. It bounds the work of
    /// a dispatch of the projection `certified`, and no answer depends on it.
    double maxScale = 1;
};

/// Poses on the device, for BatchItem::poses. What the host does with a pose is then done by a dispatch, with the same
/// arithmetic, so that answers are those of the same floats in BatchItem::world_from_object, bit for bit; and recording
/// a batch of 100,000 poses takes no longer for the poses than one of a single pose.
/// Thread-safety: const members from any thread.
class PoseBuffer {
  public:
    /// Uses a buffer of the caller's, which must outlive this. Its contents are not examined. Refuses a null buffer,
    /// no poses, an offset and a stride that WrappedPoses does not allow, more than the device's maxStorageBufferRange,
    /// and a maxScale that is not a positive number.
    [[nodiscard]] VOXTACT_API static Result<PoseBuffer> wrap(const Context& context, const WrappedPoses& wrapped,
                                                             const char* name = nullptr);
    VOXTACT_API PoseBuffer(PoseBuffer&&) noexcept;
    VOXTACT_API PoseBuffer& operator=(PoseBuffer&&) noexcept;
    VOXTACT_API ~PoseBuffer();

    /// How many there are.
    [[nodiscard]] VOXTACT_API std::uint32_t count() const noexcept;

    [[nodiscard]] PoseBufferImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PoseBuffer(std::unique_ptr<PoseBufferImpl> impl) noexcept;
    std::unique_ptr<PoseBufferImpl> impl_;
};

/// A label map on the device, on its own grid: a 3D image of R16_UINT that holds numbers of labels.
class LabelMap {
  public:
    /// Refuses what checkGrid() refuses, a wrong number of indices, indices and values that makeLabels() would not
    /// make, and a map beyond the device's limits (which limit, how large).
    [[nodiscard]] VOXTACT_API static Result<LabelMap> create(const Context& context, const LabelData& data,
                                                             const char* name = nullptr);
    /// create(), cmdUpload() and releaseStaging() in one: submits on `queue` and waits. Blocks.
    [[nodiscard]] VOXTACT_API static Result<LabelMap> upload(const Context& context, const QueueAccess& queue,
                                                             const LabelData& data, const char* name = nullptr);
    VOXTACT_API LabelMap(LabelMap&&) noexcept;
    VOXTACT_API LabelMap& operator=(LabelMap&&) noexcept;
    VOXTACT_API ~LabelMap();

    /// Records the copy to the device; see above for what it expects and leaves.
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Where its voxels are; need not be the volume's grid.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;
    /// The labels, by their numbers.
    [[nodiscard]] VOXTACT_API std::span<const std::int32_t> values() const noexcept;

    [[nodiscard]] LabelMapImpl& impl() const noexcept { return *impl_; }

  private:
    explicit LabelMap(std::unique_ptr<LabelMapImpl> impl) noexcept;
    std::unique_ptr<LabelMapImpl> impl_;
};

/// An object of the scene; not null.
using Resource = std::variant<Volume*, TransferFunction*, Mesh*, LabelMap*>;

/// Records what the resources need before their first use: the uploads of created ones, the bricks of wrapped volumes,
/// the clusters of wrapped meshes. Skips resources that need nothing, or whose upload was recorded. Refuses a null
/// pointer; on error the resources before it are recorded.
///   call it             outside a render pass, on a queue with graphics; one with compute for bricks, and for clusters
///                       of wrapped meshes
///   expects             wrapped objects as their structs say; earlier commands that wrote them are waited for
///   leaves              the resources readable by vertex input and by any shader stage, in every later command
///   queries             an active occlusion query is not affected
///   bound state         with bricks or clusters: lost as by Volume::cmdUpdateBricks(); otherwise none
[[nodiscard]] VOXTACT_API Result<void> cmdPrepare(VkCommandBuffer commandBuffer, std::span<const Resource> resources);
/// Frees the staging buffers. The submission of cmdPrepare() must be complete.
VOXTACT_API void retire(std::span<const Resource> resources) noexcept;

} // namespace voxtact
