// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/plan.h"
#include "voxtact/questions.h"

#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The host engine (target voxtact::cpu): answers all questions without a device or Vulkan, with the same pixels and
/// arithmetic as the counting method `compute` with `exact` filtering (src/exact/exact.h). Culling (of clusters,
/// triangles and spans) removes only parts that provably have no passing fragment, so it never changes a count.
///
/// Lifetime: an object must outlive the calls that use it. Objects keep no references to the data that created them.
/// Thread-safety: const functions are safe from any thread.
namespace voxtact::cpu {

struct VolumeImpl;
struct TransferFunctionImpl;
struct MeshImpl;
struct DistanceTrackerImpl;
struct HostEngineImpl;

/// A 3D image on the host, with the smallest and largest value of each brick of 8^3 voxels.
class Volume {
  public:
    /// Copies the voxels. Refuses volumes that checkVolume() refuses, and more than 2^23 voxels per side, the range of
    /// float coordinates (LimitExceeded).
    [[nodiscard]] VOXTACT_API static Result<Volume> create(const VolumeView& data);
    VOXTACT_API Volume(Volume&&) noexcept;
    VOXTACT_API Volume& operator=(Volume&&) noexcept;
    VOXTACT_API ~Volume();
    /// Returns the position of the voxels.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;

    /// Edits: the next call uses the edit. No call may use the volume during an edit. A refused edit changes nothing.
    ///
    /// Sets the voxels of a region to a value in the image's own units. Refuses regions that voxelBounds() refuses, and
    /// a value that the voxel type cannot represent: NaN, infinite, out of range or, for integers, not whole. For
    /// floats, rounds to the nearest. Accepts a region without voxels.
    [[nodiscard]] VOXTACT_API Result<void> set(const VoxelRegion& region, double value);
    /// Replaces the voxels of a box by scalars of the volume's type, x fastest, then y, then z, without padding, with
    /// any alignment. Refuses a box outside the grid, a wrong number of bytes, and NaN or infinite voxels.
    [[nodiscard]] VOXTACT_API Result<void> write(const VoxelBox& box, std::span<const std::byte> voxels);
    /// Copies the current voxels of a box, in the layout of write(). Refuses a box outside the grid, and a span of
    /// another size (InvalidArgument).
    [[nodiscard]] VOXTACT_API Result<void> read(const VoxelBox& box, std::span<std::byte> voxels) const;

    [[nodiscard]] const VolumeImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Volume(std::unique_ptr<VolumeImpl> impl) noexcept;
    std::unique_ptr<VolumeImpl> impl_;
};

/// Scalar -> opacity.
class TransferFunction {
  public:
    /// Refuses descriptions that sampleTable() refuses.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> create(const TransferFunctionDesc& desc);
    VOXTACT_API TransferFunction(TransferFunction&&) noexcept;
    VOXTACT_API TransferFunction& operator=(TransferFunction&&) noexcept;
    VOXTACT_API ~TransferFunction();
    [[nodiscard]] const TransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept;
    std::unique_ptr<TransferFunctionImpl> impl_;
};

/// A triangle mesh, with its triangles in clusters. Triangles keep their indices.
class Mesh {
  public:
    /// Refuses meshes that checkMesh() refuses.
    [[nodiscard]] VOXTACT_API static Result<Mesh> create(const MeshView& data);
    VOXTACT_API Mesh(Mesh&&) noexcept;
    VOXTACT_API Mesh& operator=(Mesh&&) noexcept;
    VOXTACT_API ~Mesh();
    /// Returns the facts that checkMesh() computed.
    [[nodiscard]] VOXTACT_API const MeshFacts& facts() const noexcept;

    /// Moves the vertices: three coordinates each, in the order of MeshView::positions. The triangles stay. The next
    /// call uses the new shape; no call may use the mesh during an update. Answers are the same as for a new mesh. An
    /// update only refits the boxes of the clusters, and is faster than a new mesh. If neighbouring triangles move far
    /// apart, queries of a new mesh are faster. O(vertices + triangles). Refuses another number of coordinates and
    /// shapes that checkMesh() refuses; the mesh then stays unchanged.
    [[nodiscard]] VOXTACT_API Result<void> update(std::span<const double> positions);
    [[nodiscard]] const MeshImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Mesh(std::unique_ptr<MeshImpl> impl) noexcept;
    std::unique_ptr<MeshImpl> impl_;
};

/// One mesh at some poses against one volume under one transfer function.
struct BatchItem {
    const Mesh* mesh = nullptr;                         ///< required, like all but the labels; read during a call only
    const Volume* volume = nullptr;                     ///< the image
    const TransferFunction* transferFunction = nullptr; ///< defines the opaque region
    std::span<const Mat4> world_from_object{};          ///< affine
    const LabelData* labels = nullptr;                  ///< for label questions, and the outputs labels and contacts
};

/// The pairs of one call: the items in order, each with its poses in order.
struct Batch {
    std::span<const BatchItem> items{};   ///< any number; the answers have the same order
    View view{};                          ///< at most kMaxViewport pixels per side; only for projections with a camera
    double threshold = kDefaultThreshold; ///< 0..1
    /// Cancels the call from any thread: once the flag is true, the call soon returns ErrorCode::Cancelled. Threads
    /// read the flag between cells and iterations, and stop once they read true, even if it is reset. If the flag is
    /// true at the start, the call does nothing. May be null.
    const std::atomic<bool>* cancel = nullptr;
};

/// Maximum number of pixels along a side of a View.
inline constexpr std::uint32_t kMaxViewport = 16384;

/// Maximum number of threads of one object.
inline constexpr std::uint32_t kMaxThreads = 4096;

/// Options of a DistanceTracker.
struct TrackerDesc {
    /// mm, above 0: search radius; larger distances are not measured.
    double maximum = std::numeric_limits<double>::infinity();
    double resolution = kDefaultResolution; ///< voxels: as Touch::resolution
    std::uint64_t maxSteps = 512;           ///< iteration limit per search; then returns the current bounds; at least 1
};

/// Tracks a mesh that moves little from call to call, as in haptics. At every pose, returns whether the mesh touches,
/// usually without a search. A mesh that moved by less than its last known distance is free. The new bounds follow from
/// the earlier ones: the distance changes by at most the largest displacement of a mesh point. A search covers only a
/// few more moves like the last one, so its cost depends on the speed. Earlier calls never affect a certified yes. They
/// may affect the width of the bounds, and whether a pose is free or undecided.
///
/// Runs on the calling thread. The first call with a volume, transfer function or threshold prepares it, which takes
/// milliseconds; so does the first call after an edit. Thread-safety: one call at a time.
class DistanceTracker {
  public:
    /// Refuses numbers outside the ranges of TrackerDesc.
    [[nodiscard]] VOXTACT_API static Result<DistanceTracker> create(const TrackerDesc& desc = {});
    VOXTACT_API DistanceTracker(DistanceTracker&&) noexcept;
    VOXTACT_API DistanceTracker& operator=(DistanceTracker&&) noexcept;
    VOXTACT_API ~DistanceTracker();

    /// Tracks one mesh at one pose; ignores labels. Searches after an edit, or if the mesh, volume, transfer function
    /// or threshold differs from the previous call. Refuses items that HostEngine::ask() refuses, and any number of
    /// poses but 1.
    [[nodiscard]] VOXTACT_API Result<TrackedDistance> track(const BatchItem& item,
                                                            double threshold = kDefaultThreshold);

  private:
    explicit DistanceTracker(std::unique_ptr<DistanceTrackerImpl> impl) noexcept;
    std::unique_ptr<DistanceTrackerImpl> impl_;
};

/// A region to avoid: the opaque region, its part with some labels, or whole labels.
struct PlanObstacle {
    const Volume* volume = nullptr;                     ///< required
    const TransferFunction* transferFunction = nullptr; ///< defines the opaque region; null: labels at any opacity
    double threshold = kDefaultThreshold;               ///< 0..1
    const LabelData* labels = nullptr;                  ///< on the volume's grid; null: the whole opaque region
    std::vector<std::int32_t> avoid{};                  ///< labels to avoid
    std::string name{};                                 ///< used in messages; empty: "obstacle" and its index
};

/// Surface on which paths may begin: the outermost point of a region along each direction from the target.
struct EntrySurface {
    std::uint32_t entries = 1002;                       ///< directions; rounded up to 10 n^2 + 2
    const Volume* volume = nullptr;                     ///< with a transfer function: its opaque region
    const TransferFunction* transferFunction = nullptr; ///< of `volume`
    double threshold = kDefaultThreshold;               ///< 0..1
    const LabelData* labels = nullptr;                  ///< instead of a volume: a label
    std::int32_t label = 0;                             ///< label value in `labels`
    double radius = 0; ///< mm, instead of both: radius of a ball around the target; above kNearestEntry
    /// Paths may also begin where the image's border cuts the opaque region or the label, such as the neck in a scan of
    /// a head. The anatomy in front of such an entry is unknown.
    bool borderEntries = false;
};

/// An instrument given as a mesh. Only its surface counts.
struct PlanMesh {
    const Mesh* mesh = nullptr; ///< required
    Vec3 tip{};                 ///< object space: moves to the target
    Vec3 axis{0, 0, 1}; ///< object space: from the tip to the handle; aligned with the path by the smallest rotation
};

/// Which straight paths to a target keep clear of obstacles?
struct Plan {
    Vec3 target{};                             ///< world mm
    EntrySurface surface{};                    ///< where paths begin
    std::span<const PlanObstacle> obstacles{}; ///< at least one
    Needle needle{};                           ///< the instrument
    std::optional<PlanMesh> mesh{};            ///< instead of the needle; triangles are then not certified
    double margin = 0;                         ///< mm: minimum distance from the obstacles
    std::optional<double> longest{};           ///< mm: maximum length of a path
    std::optional<double> steepest{};          ///< degrees, up to 90: maximum angle to the normal of the surface
    bool triangleDistances = false;            ///< needle only: computes EntryTriangle::clearance; doubles the time
    double tolerance = kDefaultPlanTolerance;  ///< mm, at least 1e-6: stop when upper - lower is at most this
    double maximum = kDefaultPlanMaximum;      ///< mm, above 0: larger distances are not measured
    std::uint64_t maxSteps = 1U << 18U;        ///< iteration limit per path, then the current bounds; at least 1
    const std::atomic<bool>* cancel = nullptr; ///< as Batch::cancel
};

/// Answers questions on the host. Between calls, keeps its threads and the structures built for the last volumes and
/// transfer functions. Answers depend neither on the number of threads nor on the rest of the batch. Calls that take
/// less time than waking a thread run on the caller's thread alone. Thread-safety: one call at a time.
class HostEngine {
  public:
    /// Starts the threads; 0: one per processor. Refuses more than kMaxThreads.
    [[nodiscard]] VOXTACT_API static Result<HostEngine> create(std::uint32_t threads = 0);
    VOXTACT_API HostEngine(HostEngine&&) noexcept;
    VOXTACT_API HostEngine& operator=(HostEngine&&) noexcept;
    VOXTACT_API ~HostEngine();

    /// All overloads refuse numbers outside the ranges of the question, null objects, invalid poses, and a threshold
    /// outside [0,1]. Questions with labels refuse items without a label map or with one on another grid (Unsupported),
    /// and more labels than kMaxMeasuredLabels (LimitExceeded).
    [[nodiscard]] VOXTACT_API Result<TouchAnswer> ask(const Touch& question, const Batch& batch);
    /// Counts with CountingMethod::Cpu; gpuMilliseconds is 0. Refuses a singular camera, a viewport of 0 or beyond
    /// kMaxViewport (dominant-axis: a volume that needs such a viewport), and outputs with stopAtFirst. For meshes of
    /// small triangles, dominant-axis is much slower than a view.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> ask(const Count& question, const Batch& batch);
    /// Bounds each pair's distance. Labels need a label map in each item.
    [[nodiscard]] VOXTACT_API Result<DistanceAnswer> ask(const Distance& question, const Batch& batch);
    /// Bounds the opaque area of each pair's mesh. Labels need a label map in each item.
    [[nodiscard]] VOXTACT_API Result<AreaAnswer> ask(const Area& question, const Batch& batch);
    /// Also refuses a mesh with holes, band limits that do not ascend, and more than kMaxBandLimits limits.
    [[nodiscard]] VOXTACT_API Result<OverlapAnswer> ask(const Overlap& question, const Batch& batch);
    /// Also refuses poses that poseBetween() refuses and shapes that Mesh::update() refuses. The number of shapes must
    /// equal that of the items or their poses.
    [[nodiscard]] VOXTACT_API Result<MotionAnswer> ask(const Motion& question, const Batch& batch);
    /// Refuses a target that is not finite, an axis of length 0, and a plan without an entry surface in any direction.
    [[nodiscard]] VOXTACT_API Result<PlanAnswer> ask(const Plan& question);

    /// Returns the number of threads.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit HostEngine(std::unique_ptr<HostEngineImpl> impl) noexcept;
    std::unique_ptr<HostEngineImpl> impl_;
};

} // namespace voxtact::cpu
