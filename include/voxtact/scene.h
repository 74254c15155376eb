// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"
#include "voxtact/data.h"

#include <optional>
#include <variant>

/// The scene on the device: objects uploaded from host memory, or wrapped around the caller's Vulkan objects. voxtact
/// never frees, writes or transitions wrapped Vulkan objects.
///
/// create() makes the device object and fills a staging buffer; wrap() uses the caller's Vulkan objects. cmdPrepare()
/// records all work that objects need before their first use. Once its submission has completed, retire() frees the
/// staging buffers. cmdUpload() and releaseStaging() do the same for one object. upload() runs all steps on the
/// caller's queue and waits.
///
/// Every cmdUpload():
///   call it             outside a render pass, on a queue with graphics (or with compute and transfer)
///   expects             nothing; discards the object's contents and restores those of create()
///   leaves              the object readable by vertex input and by any shader stage, in every later command
///   queries             an active occlusion query is not affected
///   bound state         none is lost
///
/// Edits are Volume::cmdSet(), cmdWrite() and cmdCopy(), TransferFunction::cmdUpdate(), and Mesh::cmdUpdate(),
/// cmdCopy() and cmdRefit(). They allocate no device memory and take effect in command-buffer order: earlier commands
/// use the old contents, later commands the new ones. Host data, such as valueRange(), domain() and facts(), change at
/// recording. Record edits in the order of execution, and re-record older commands before submitting them after an
/// edit.
///
/// Lifetime: an object must outlive the command buffers that use it, and end before the device. Wrapped Vulkan objects
/// must outlive their wrapper.
/// Thread-safety: const functions are safe from any thread; all others need the caller's own lock.
namespace voxtact {

struct VolumeImpl;
struct TransferFunctionImpl;
struct MeshImpl;
struct PoseBufferImpl;
struct LabelMapImpl;

/// An image that the caller owns.
struct WrappedVolume {
    VkImageView view = VK_NULL_HANDLE;     ///< 3D, one mip level, component r sampled
    VkFormat format = VK_FORMAT_UNDEFINED; ///< R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT or R32_SFLOAT
    /// While commands execute: SHADER_READ_ONLY_OPTIMAL, READ_ONLY_OPTIMAL or GENERAL.
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    Grid grid{}; ///< position of the voxels
    /// value = slope * stored + intercept; slope is not 0. `stored`: the integer of a UNORM or SNORM texel, or the
    /// float.
    double slope = 1;
    double intercept = 0; ///< in the image's units
    /// Range of all voxels on the image's faces, if known: lets Boundary::Auto clamp. Refused unless lo <= hi.
    std::optional<ValueRange> boundaryValues;
    /// Like VolumeOptions::bricks. Requires Volume::cmdUpdateBricks() of the whole grid before the first use.
    bool bricks = false;
};

/// Options of an uploaded volume.
struct VolumeOptions {
    const char* name = nullptr; ///< appears on the Vulkan objects; may be null
    /// Keeps the value range of each brick of 8^3 cells on the device. The projection `certified` and RenderBricks need
    /// bricks to skip transparent ones. 16 bytes per brick, plus about a seventh for boxes of 2^3, 4^3, ... bricks.
    /// Refused if the bricks exceed the device's maxStorageBufferRange.
    bool bricks = false;
    /// Allows cmdSet(), cmdWrite() and cmdCopy(). Takes device memory for the texels of one slice or 1 MiB, whichever
    /// is larger, and 64 KiB for rows. Refused if a slice exceeds the device's maxStorageBufferRange.
    bool editable = false;
};

/// A 3D image on the device.
class Volume {
  public:
    /// Refuses what checkVolume() refuses, and a volume beyond the device's limits (the error names limit and size).
    [[nodiscard]] VOXTACT_API static Result<Volume> create(const Context& context, const VolumeView& data,
                                                           const VolumeOptions& options = {});
    /// Uses the caller's image. Refuses a null view, a format, layout or slope that WrappedVolume excludes, and a grid
    /// that checkGrid() refuses or that exceeds the device's limits.
    [[nodiscard]] VOXTACT_API static Result<Volume> wrap(const Context& context, const WrappedVolume& wrapped);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<Volume> upload(const Context& context, const QueueAccess& queue,
                                                           const VolumeView& data, const VolumeOptions& options = {});
    VOXTACT_API Volume(Volume&&) noexcept;
    VOXTACT_API Volume& operator=(Volume&&) noexcept;
    VOXTACT_API ~Volume();

    /// Records the copy to the device; see "Every cmdUpload()". With VolumeOptions::bricks, also fills the bricks:
    /// needs a queue with compute and loses the bound state of cmdUpdateBricks().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Updates the bricks after the caller changed voxels of a wrapped image, all of them within `changed`. Refuses a
    /// box outside the grid, and a volume without bricks.
    ///   call it             outside a render pass, on a queue with compute
    ///   expects             the image in the wrapped layout; waits for earlier commands that wrote the image
    ///   leaves              the bricks readable by every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         lost: compute pipeline, descriptor sets of the compute bind point, push constants
    VOXTACT_API Result<void> cmdUpdateBricks(VkCommandBuffer commandBuffer, const VoxelBox& changed);

    /// Edits need VolumeOptions::editable, and update the bricks. After an edit that reaches the image's faces,
    /// Boundary::Auto uses the range test.
    ///   call it             outside a render pass, on a queue with graphics or compute; a Ball, or with bricks: with
    ///                       compute
    ///   expects             an uploaded volume; waits for earlier commands that use the volume
    ///   leaves              the volume readable by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         a Ball, or with bricks: lost as by cmdUpdateBricks(); otherwise none
    ///
    /// Sets the voxels of a region to a value in the image's units, rounded to the nearest float for float voxels.
    /// Fills a box by copies. Clips a Ball to the grid; the host selects its voxels like cpu::Volume::set(), and one
    /// dispatch per MiB of the bounding box sets them. Refuses what cpu::Volume::set() refuses, such as values that are
    /// NaN, infinite, out of the type's range or, for integers, not whole.
    VOXTACT_API Result<void> cmdSet(VkCommandBuffer commandBuffer, const VoxelRegion& region, double value);
    /// Writes the voxels of a box: scalars of the volume's type, as in VolumeView. The command buffer holds the data;
    /// use cmdCopy() for large edits. Refuses what checkVolume() refuses.
    VOXTACT_API Result<void> cmdWrite(VkCommandBuffer commandBuffer, const VoxelBox& box,
                                      std::span<const std::byte> voxels);
    /// Copies the voxels of a box from the caller's buffer, with usage TRANSFER_SRC. The texels have the order of
    /// VolumeView and the type of format(): int16 as uint16 with the sign bit flipped. Floats must be finite; values
    /// are not checked. `offset`: bytes, a multiple of 4. Waits for earlier commands that wrote the buffer.
    VOXTACT_API Result<void> cmdCopy(VkCommandBuffer commandBuffer, const VoxelBox& box, VkBuffer source,
                                     VkDeviceSize offset);

    /// Returns the position of the voxels.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;
    /// Returns the smallest and largest voxel in the image's units; after edits, a range that contains all voxels.
    /// Empty for a wrapped volume, and after cmdCopy().
    [[nodiscard]] VOXTACT_API std::optional<ValueRange> valueRange() const noexcept;
    /// Returns the device image for the caller's passes: 3D, in SHADER_READ_ONLY_OPTIMAL or the wrapped layout.
    [[nodiscard]] VOXTACT_API VkImageView view() const noexcept;
    /// Returns the image's format: R16_UNORM with the sign bit flipped for int16 voxels.
    [[nodiscard]] VOXTACT_API VkFormat format() const noexcept;

    [[nodiscard]] VolumeImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Volume(std::unique_ptr<VolumeImpl> impl) noexcept;
    std::unique_ptr<VolumeImpl> impl_;
};

/// A table that the caller owns. Filter::Hardware needs a format that the device filters linearly; voxtact cannot check
/// the format.
struct WrappedTransferFunction {
    VkImageView view = VK_NULL_HANDLE;                               ///< 1D, opacity in component r
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; ///< while commands execute
    ValueRange domain{};                                             ///< values that the table covers; lo < hi
    /// Optional: the same table in host memory. Lets Boundary::Auto prove that clamping is allowed. Required by the
    /// projection `certified`, which interpolates linearly between entries.
    std::span<const float> table;
};

/// Scalar -> opacity, on the device.
class TransferFunction {
  public:
    /// Refuses what sampleTable() refuses, and a table beyond the device's limits. `name` appears on Vulkan objects.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction>
    create(const Context& context, const TransferFunctionDesc& desc, const char* name = nullptr);
    /// Uses the caller's table. Refuses a null view, a layout that shaders cannot sample, and an empty domain.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> wrap(const Context& context,
                                                                   const WrappedTransferFunction& wrapped);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> upload(const Context& context, const QueueAccess& queue,
                                                                     const TransferFunctionDesc& desc,
                                                                     const char* name = nullptr);
    VOXTACT_API TransferFunction(TransferFunction&&) noexcept;
    VOXTACT_API TransferFunction& operator=(TransferFunction&&) noexcept;
    VOXTACT_API ~TransferFunction();

    /// Records the copy to the device; see "Every cmdUpload()". Restores the domain() of create().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Records a new table of the same size, for any domain. Refuses what sampleTable() refuses, another size, and a
    /// wrapped table.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer
    ///   expects             nothing, not even an upload; waits for earlier commands that read the table
    ///   leaves              the table readable by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         none is lost
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, const TransferFunctionDesc& desc);

    /// Returns the values that the last recorded table covers.
    [[nodiscard]] VOXTACT_API ValueRange domain() const noexcept;
    [[nodiscard]] VOXTACT_API std::uint32_t tableSize() const noexcept; ///< 0: wrapped without a host table

    [[nodiscard]] TransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept;
    std::unique_ptr<TransferFunctionImpl> impl_;
};

/// Buffers that the caller owns. A vertex is three floats in object space, at the start of a stride. Unlike vertices
/// from host memory, wrapped ones lose precision far from the origin.
struct WrappedMesh {
    VkBuffer vertices = VK_NULL_HANDLE; ///< usage VERTEX_BUFFER
    VkDeviceSize vertexOffset = 0;      ///< bytes, of the first position; a multiple of 4
    /// Bytes; at least 12, a multiple of 4. Above the device's maxVertexInputBindingStride, pictures and rasterising
    /// methods in `view` and `two-view` return LimitExceeded; `compute` and `dominant-axis` have no such limit.
    std::uint32_t vertexStride = 12;
    std::uint32_t vertexCount = 0;                ///< vertices in the buffer
    VkBuffer indices = VK_NULL_HANDLE;            ///< usage INDEX_BUFFER; null: three consecutive vertices per triangle
    VkDeviceSize indexOffset = 0;                 ///< bytes
    VkIndexType indexType = VK_INDEX_TYPE_UINT32; ///< UINT16 or UINT32
    std::uint32_t triangleCount = 0;              ///< triangles to draw
    /// The buffers also have usage STORAGE_BUFFER, which the method `compute` and the projection `dominant-axis` need.
    /// If 16-bit indices then end at an offset that is not a multiple of 4, two more bytes must follow.
    bool storage = false;
    /// Like MeshOptions::clusters; needs `storage`. Keeps clusters and a copy of the indices on the device, 17 bytes
    /// per triangle. Requires cmdUpload() before the first use, and cmdRefit() after later changes of the buffers.
    bool clusters = false;
    /// Optional, for clusters: the triangles in host memory, in the same order, to group near ones. The vertices may
    /// have moved since. Empty: 64 consecutive triangles form a cluster.
    MeshView shape{};
};

/// Options of an uploaded mesh.
struct MeshOptions {
    const char* name = nullptr; ///< appears on the Vulkan objects; may be null
    /// Keeps clusters of near triangles on the device, 4 to 5 bytes per triangle, for culling in the projection
    /// `certified`. create() then sorts the triangles, O(n log n).
    bool clusters = false;
    /// Allows cmdUpdate() and cmdCopy(). Keeps the triangles in host memory, 12 bytes each, 16 with clusters.
    bool editable = false;
    /// Like WrappedMesh::vertexStride, on the device. Above 12: for cmdCopy() from buffers with the same stride.
    std::uint32_t vertexStride = 12;
};

/// A triangle mesh on the device.
class Mesh {
  public:
    /// Creates a mesh. Refuses meshes that checkMesh() refuses, and strides that MeshOptions excludes.
    [[nodiscard]] VOXTACT_API static Result<Mesh> create(const Context& context, const MeshView& data,
                                                         const MeshOptions& options = {});
    /// Uses the caller's buffers. Vertices must be finite and indices in range; the contents are not checked. Refuses
    /// null vertices, strides and offsets that WrappedMesh excludes, and no triangles. With clusters, also refuses
    /// buffers without `storage` or beyond the device's maxStorageBufferRange, and a `shape` that checkMesh() refuses
    /// or that has another number of triangles.
    [[nodiscard]] VOXTACT_API static Result<Mesh> wrap(const Context& context, const WrappedMesh& wrapped);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<Mesh> upload(const Context& context, const QueueAccess& queue,
                                                         const MeshView& data, const MeshOptions& options = {});
    VOXTACT_API Mesh(Mesh&&) noexcept;
    VOXTACT_API Mesh& operator=(Mesh&&) noexcept;
    VOXTACT_API ~Mesh();

    /// Records the copy to the device; see "Every cmdUpload()". For a wrapped mesh with clusters, records the clusters'
    /// upload and a refit, with the table of cmdRefit().
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Deforms the mesh: moves vertices and keeps the triangles. Requires MeshOptions::editable. Answers equal those of
    /// a new mesh, bit for bit. Triangles stay in their clusters, and the device refits the clusters' boxes. If
    /// neighbours move far apart, a new mesh is faster to query. The split of batches into dispatches also changes at
    /// recording.
    ///   call it             outside a render pass, on any queue with graphics, compute or transfer; with clusters, on
    ///                       one with compute
    ///   expects             an uploaded mesh; waits for earlier commands that use the mesh
    ///   leaves              the mesh readable by vertex input and by any shader stage, in every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         with clusters: lost as by Volume::cmdUpdateBricks(); otherwise none
    ///
    /// Replaces the vertices from host memory, three coordinates each, in the order of MeshView::positions. The command
    /// buffer holds the data, `vertexStride` bytes per vertex: frames in flight share nothing. O(vertices + triangles).
    /// Refuses another number of coordinates, and what checkMesh() refuses; the mesh then stays unchanged.
    VOXTACT_API Result<void> cmdUpdate(VkCommandBuffer commandBuffer, std::span<const double> positions);
    /// Copies the vertices from the caller's buffer, with usage TRANSFER_SRC: three floats each in object space, at
    /// MeshOptions::vertexStride. Copies whole strides, but only 12 bytes of the last vertex. `offset`: bytes, a
    /// multiple of 4. Waits for earlier commands that wrote the buffer. Vertices must be finite: a non-finite vertex,
    /// which is not detected, invalidates the answers for its triangles. Far from the origin, floats lose precision:
    /// only vertices from host memory are stored relative to the mesh's centre. O(1) on the host.
    VOXTACT_API Result<void> cmdCopy(VkCommandBuffer commandBuffer, VkBuffer source, VkDeviceSize offset);

    /// Refits the clusters of a wrapped mesh after the caller changed vertices or indices. Refuses a mesh that is not
    /// wrapped or has no clusters.
    ///   call it             outside a render pass, on a queue with compute
    ///   expects             a mesh whose cmdUpload() was recorded; waits for earlier commands that wrote the caller's
    ///                       buffers or use the clusters
    ///   leaves              the clusters and the caller's buffers readable by vertex input and by any shader stage, in
    ///                       every later command
    ///   queries             an active occlusion query is not affected
    ///   bound state         lost as by Volume::cmdUpdateBricks()
    VOXTACT_API Result<void> cmdRefit(VkCommandBuffer commandBuffer);

    /// Returns the number of triangles.
    [[nodiscard]] VOXTACT_API std::uint32_t triangles() const noexcept;
    /// Returns the facts of the last recorded vertices. Empty for a wrapped mesh, and from cmdCopy() to the next
    /// cmdUpdate().
    [[nodiscard]] VOXTACT_API std::optional<MeshFacts> facts() const noexcept;

    [[nodiscard]] MeshImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Mesh(std::unique_ptr<MeshImpl> impl) noexcept;
    std::unique_ptr<MeshImpl> impl_;
};

/// Poses in the caller's buffer, written by a shader or through mapped memory: `world_from_object`, 16 floats each,
/// column-major, like a mat4 of std430. The last row must be 0 0 0 1.
struct WrappedPoses {
    VkBuffer buffer = VK_NULL_HANDLE; ///< usage STORAGE_BUFFER
    VkDeviceSize offset = 0;          ///< bytes, of the first pose; a multiple of 4
    VkDeviceSize stride = 64;         ///< bytes from one pose to the next; at least 64, a multiple of 4
    std::uint32_t count = 0;          ///< poses in the buffer, at least 1
    /// Upper bound of the scale of all poses; positive; 1: rigid motion. Limits the work of a dispatch of the
    /// projection `certified`, and affects no answer.
    double maxScale = 1;
};

/// Poses on the device, for BatchItem::poses. A dispatch processes them with the host's arithmetic: answers equal those
/// of the same floats in BatchItem::world_from_object, bit for bit. The number of poses does not affect the time to
/// record them.
class PoseBuffer {
  public:
    /// Uses the caller's buffer; the contents are not checked. Refuses a null buffer, members that WrappedPoses
    /// excludes, and poses beyond the device's maxStorageBufferRange.
    [[nodiscard]] VOXTACT_API static Result<PoseBuffer> wrap(const Context& context, const WrappedPoses& wrapped,
                                                             const char* name = nullptr);
    VOXTACT_API PoseBuffer(PoseBuffer&&) noexcept;
    VOXTACT_API PoseBuffer& operator=(PoseBuffer&&) noexcept;
    VOXTACT_API ~PoseBuffer();

    /// Returns the number of poses.
    [[nodiscard]] VOXTACT_API std::uint32_t count() const noexcept;

    [[nodiscard]] PoseBufferImpl& impl() const noexcept { return *impl_; }

  private:
    explicit PoseBuffer(std::unique_ptr<PoseBufferImpl> impl) noexcept;
    std::unique_ptr<PoseBufferImpl> impl_;
};

/// A label map on the device, on its own grid: a 3D image in R16_UINT of indices into values().
class LabelMap {
  public:
    /// Refuses what checkGrid() refuses, a wrong number of indices, and indices and values that makeLabels() never
    /// returns. Also refuses a map beyond the device's limits (the error names limit and size).
    [[nodiscard]] VOXTACT_API static Result<LabelMap> create(const Context& context, const LabelData& data,
                                                             const char* name = nullptr);
    /// Calls create(), cmdUpload() and releaseStaging(): submits on `queue` and waits.
    [[nodiscard]] VOXTACT_API static Result<LabelMap> upload(const Context& context, const QueueAccess& queue,
                                                             const LabelData& data, const char* name = nullptr);
    VOXTACT_API LabelMap(LabelMap&&) noexcept;
    VOXTACT_API LabelMap& operator=(LabelMap&&) noexcept;
    VOXTACT_API ~LabelMap();

    /// Records the copy to the device; see "Every cmdUpload()".
    VOXTACT_API Result<void> cmdUpload(VkCommandBuffer commandBuffer);
    /// Frees the staging buffer. The submission of cmdUpload() must be complete.
    VOXTACT_API void releaseStaging() noexcept;

    /// Returns the position of the voxels; may differ from the volume's grid.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;
    /// Returns the labels, in the order of LabelData::values.
    [[nodiscard]] VOXTACT_API std::span<const std::int32_t> values() const noexcept;

    [[nodiscard]] LabelMapImpl& impl() const noexcept { return *impl_; }

  private:
    explicit LabelMap(std::unique_ptr<LabelMapImpl> impl) noexcept;
    std::unique_ptr<LabelMapImpl> impl_;
};

/// An object of the scene; not null.
using Resource = std::variant<Volume*, TransferFunction*, Mesh*, LabelMap*>;

/// Records all work before the first use of resources: uploads of created ones, bricks of wrapped volumes, clusters of
/// wrapped meshes. Skips resources that need no work, or whose upload was recorded. Refuses a null pointer. After an
/// error, the preceding resources are recorded.
///   call it             outside a render pass, on a queue with graphics; for bricks, and for clusters of wrapped
///                       meshes, on one with compute
///   expects             wrapped objects as their structs require; waits for earlier commands that wrote them
///   leaves              the resources readable by vertex input and by any shader stage, in every later command
///   queries             an active occlusion query is not affected
///   bound state         with bricks or clusters: lost as by Volume::cmdUpdateBricks(); otherwise none
[[nodiscard]] VOXTACT_API Result<void> cmdPrepare(VkCommandBuffer commandBuffer, std::span<const Resource> resources);
/// Frees the staging buffers. The submission of cmdPrepare() must be complete.
VOXTACT_API void retire(std::span<const Resource> resources) noexcept;

} // namespace voxtact
