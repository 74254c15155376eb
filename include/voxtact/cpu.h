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

/// The host engine (target voxtact::cpu): the same questions answered without a device, by the same pixels and the
/// same arithmetic as the counting method `compute` with `exact` filtering (src/exact/exact.h). Nothing here needs
/// Vulkan. Everything that is skipped (clusters of triangles, triangles, spans) is skipped only where it provably has
/// no survivor, so that skipping never changes a count.
///
/// Lifetime: an object must outlive the calls that use it; nothing of what it was made from is kept.
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
    /// Refuses what checkVolume() refuses, and more than 2^23 voxels per side, which floats cannot address
    /// (LimitExceeded). Copies the voxels.
    [[nodiscard]] VOXTACT_API static Result<Volume> create(const VolumeView& data);
    VOXTACT_API Volume(Volume&&) noexcept;
    VOXTACT_API Volume& operator=(Volume&&) noexcept;
    VOXTACT_API ~Volume();
    /// Where the voxels are.
    [[nodiscard]] VOXTACT_API const Grid& grid() const noexcept;

    /// Edits: the next call sees them. None may run on the volume meanwhile. Either all of an edit is done or,
    /// where it is refused, nothing.
    ///
    /// Gives the voxels of a region a value in the image's own units. Refuses what voxelBounds() refuses, and a value
    /// that the voxels' type cannot have: NaN, infinite, out of range or, for integers, not whole. Floats are rounded
    /// to the nearest. A region without voxels is no error.
    [[nodiscard]] VOXTACT_API Result<void> set(const VoxelRegion& region, double value);
    /// Replaces the voxels of a box by scalars of the type that the volume was created with, x fastest, then y, then z,
    /// without padding; any alignment will do. Refuses a box that leaves the grid, the wrong number of bytes, and NaN
    /// or infinite voxels.
    [[nodiscard]] VOXTACT_API Result<void> write(const VoxelBox& box, std::span<const std::byte> voxels);
    /// Copies the voxels of a box as they are now, in the form that write() takes. Refuses a box that leaves the grid,
    /// and memory of another size than the box has (InvalidArgument).
    [[nodiscard]] VOXTACT_API Result<void> read(const VoxelBox& box, std::span<std::byte> voxels) const;

    [[nodiscard]] const VolumeImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Volume(std::unique_ptr<VolumeImpl> impl) noexcept;
    std::unique_ptr<VolumeImpl> impl_;
};

/// Scalar -> opacity.
class TransferFunction {
  public:
    /// Refuses what sampleTable() refuses.
    [[nodiscard]] VOXTACT_API static Result<TransferFunction> create(const TransferFunctionDesc& desc);
    VOXTACT_API TransferFunction(TransferFunction&&) noexcept;
    VOXTACT_API TransferFunction& operator=(TransferFunction&&) noexcept;
    VOXTACT_API ~TransferFunction();
    [[nodiscard]] const TransferFunctionImpl& impl() const noexcept { return *impl_; }

  private:
    explicit TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept;
    std::unique_ptr<TransferFunctionImpl> impl_;
};

/// A triangle mesh, with its triangles in clusters. Triangles keep their numbers.
class Mesh {
  public:
    /// Refuses what checkMesh() refuses.
    [[nodiscard]] VOXTACT_API static Result<Mesh> create(const MeshView& data);
    VOXTACT_API Mesh(Mesh&&) noexcept;
    VOXTACT_API Mesh& operator=(Mesh&&) noexcept;
    VOXTACT_API ~Mesh();
    /// What checkMesh() found.
    [[nodiscard]] VOXTACT_API const MeshFacts& facts() const noexcept;

    /// Bends it: vertices come elsewhere, three coordinates each in the order of MeshView::positions, and triangles
    /// stay between them. The next call sees it; none may use the mesh meanwhile. Counts and outputs are those of a
    /// mesh that is newly made; what is faster is that triangles stay in their clusters, whose boxes are fitted to
    /// them: where neighbours go far apart, a new mesh is faster to ask. O(vertices + triangles). Refuses
    /// another number of coordinates and what checkMesh() refuses; the mesh is then as it was.
    [[nodiscard]] VOXTACT_API Result<void> update(std::span<const double> positions);
    [[nodiscard]] const MeshImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Mesh(std::unique_ptr<MeshImpl> impl) noexcept;
    std::unique_ptr<MeshImpl> impl_;
};

/// One mesh at some poses against one volume under one transfer function.
struct BatchItem {
    const Mesh* mesh = nullptr;     ///< must be given, as all but the labels; read during a call only
    const Volume* volume = nullptr; ///< what is touched
    const TransferFunction* transferFunction = nullptr; ///< what of it is opaque
    std::span<const Mat4> world_from_object{};          ///< affine
    const LabelData* labels = nullptr;                  ///< for the outputs contacts (optional) and labels
};

/// The pairs of one call: the items in order, each with its poses in order.
struct Batch {
    std::span<const BatchItem> items{};   ///< any number; answers are in their order
    View view{};                          ///< at most kMaxViewport pixels per side; only for projections with a camera
    double threshold = kDefaultThreshold; ///< 0..1
    /// Ends a call early, from any thread: once it is true, the call soon returns ErrorCode::Cancelled, with all of its
    /// threads at rest. They look at it between cells and steps of a search; what one of them has seen is not taken
    /// back by a flag that is false again. Where it is true when the call begins, nothing is done at all. May be null.
    const std::atomic<bool>* cancel = nullptr;
};

/// Pixels along a side of a View, at most.
inline constexpr std::uint32_t kMaxViewport = 16384;

/// Threads that one object may have, at most.
inline constexpr std::uint32_t kMaxThreads = 4096;

/// What a DistanceTracker is made for.
struct TrackerDesc {
    /// mm, above 0: farther than this is never looked.
    double maximum = std::numeric_limits<double>::infinity();
    double resolution = kDefaultResolution; ///< of the touch, as Touch::resolution
    std::uint64_t maxSteps = 512;           ///< of one search, at least 1: then the bounds are what they are
};

/// Follows a mesh that moves by little from call to call, as under a hand: says at every pose whether it touches, and
/// mostly without a look. When the mesh has moved by no more than it was known to be clear, it is free, and the bounds
/// follow from those before: the clearance changes by no more than the farthest that a point of the mesh has moved.
/// When it is looked, then so far only as some more moves like the last one go: what an answer costs follows the
/// speed. What is said of a touch for certain never depends on the calls before: the width of the bounds does, and
/// whether a pose is known to be free that is else *possible*.
///
/// Works on the calling thread. The first call with a volume, a transfer function or a threshold, and after an edit,
/// prepares them and takes milliseconds. Thread-safety: one call at a time.
class DistanceTracker {
  public:
    /// Refuses numbers outside the ranges of TrackerDesc.
    [[nodiscard]] VOXTACT_API static Result<DistanceTracker> create(const TrackerDesc& desc = {});
    VOXTACT_API DistanceTracker(DistanceTracker&&) noexcept;
    VOXTACT_API DistanceTracker& operator=(DistanceTracker&&) noexcept;
    VOXTACT_API ~DistanceTracker();

    /// Of one mesh at one pose; labels are not examined. Another mesh, volume, transfer function or threshold than in
    /// the call before, and an edit, are no error: it then looks. Refuses what HostEngine::ask() refuses, and any
    /// number of poses but 1.
    [[nodiscard]] VOXTACT_API Result<TrackedDistance> track(const BatchItem& item,
                                                            double threshold = kDefaultThreshold);

  private:
    explicit DistanceTracker(std::unique_ptr<DistanceTrackerImpl> impl) noexcept;
    std::unique_ptr<DistanceTrackerImpl> impl_;
};

/// What must not be touched: what is opaque, what is opaque and has some labels, or all that has them.
struct PlanObstacle {
    const Volume* volume = nullptr;                     ///< must be given
    const TransferFunction* transferFunction = nullptr; ///< what of it is opaque; null: labels at any opacity
    double threshold = kDefaultThreshold;               ///< 0..1
    const LabelData* labels = nullptr;                  ///< on the volume's grid; null: all that is opaque
    std::vector<std::int32_t> avoid{};                  ///< these labels
    std::string name{};                                 ///< in messages; empty: "obstacle" and its number
};

/// Where paths may begin: along each direction from the target, the outermost point of something.
struct EntrySurface {
    std::uint32_t entries = 1002;                       ///< directions: the least 10 n^2 + 2 that is no fewer
    const Volume* volume = nullptr;                     ///< with a transfer function: of what is opaque in it
    const TransferFunction* transferFunction = nullptr; ///< see volume
    double threshold = kDefaultThreshold;               ///< 0..1
    const LabelData* labels = nullptr;                  ///< instead of a volume: of a label
    std::int32_t label = 0;                             ///< that one
    double radius = 0; ///< mm, instead of both: of a ball around the target; above kNearestEntry
    /// Paths may begin where the image ends within what is opaque, or within the label, too. There it is the image that
    /// was cut, as a scan of a head is at the neck, and nobody knows what lies before the entry.
    bool borderEntries = false;
};

/// An instrument that is a mesh. Its surface alone counts, as everywhere.
struct PlanMesh {
    const Mesh* mesh = nullptr; ///< must be given
    Vec3 tip{};                 ///< object space: comes to the target
    Vec3 axis{0, 0, 1}; ///< object space: from the tip to where the instrument is held; turned to the path by the
                        ///< smallest turn
};

/// Which straight paths to a target keep clear of obstacles?
struct Plan {
    Vec3 target{};                             ///< world mm
    EntrySurface surface{};                    ///< where paths begin
    std::span<const PlanObstacle> obstacles{}; ///< at least one
    Needle needle{};                           ///< the instrument
    std::optional<PlanMesh> mesh{};            ///< instead of the needle. Triangles are then not certified
    double margin = 0;                         ///< mm, that is to be kept
    std::optional<double> longest{};           ///< mm, of paths
    std::optional<double> steepest{};          ///< degrees between a path and the normal of the surface, to 90
    bool triangleDistances = false;            ///< of a needle: EntryTriangle::clearance, for about as long again
    double tolerance = kDefaultPlanTolerance;  ///< mm, from 1e-6 on: the search ends when the bounds are that near
    double maximum = kDefaultPlanMaximum;      ///< mm, above 0: what is farther from a path is not measured
    std::uint64_t maxSteps = 1U << 18U;        ///< a path that takes more is left with the bounds it has; at least 1
    const std::atomic<bool>* cancel = nullptr; ///< as Batch::cancel
};

/// Answers questions on the host. Keeps its threads from call to call, and what it makes of the last volumes and
/// transfer functions. What it answers does not depend on the threads, nor on what else is in a batch. Where the last
/// two calls were done sooner than another thread is woken, one that has no more to do begins on the caller's thread
/// alone. Thread-safety: one call at a time.
class HostEngine {
  public:
    /// Starts its threads. Refuses more than kMaxThreads; 0: one for each processor.
    [[nodiscard]] VOXTACT_API static Result<HostEngine> create(std::uint32_t threads = 0);
    VOXTACT_API HostEngine(HostEngine&&) noexcept;
    VOXTACT_API HostEngine& operator=(HostEngine&&) noexcept;
    VOXTACT_API ~HostEngine();

    /// All refuse numbers of the question outside their ranges, null objects, bad poses, and a threshold outside [0,1];
    /// those that are about labels refuse items without a label map, or with one on another grid (Unsupported), and
    /// more labels than kMaxMeasuredLabels (LimitExceeded).
    [[nodiscard]] VOXTACT_API Result<TouchAnswer> ask(const Touch& question, const Batch& batch);
    /// With CountingMethod::Cpu; gpuMilliseconds is 0. Refuses a singular camera, a viewport of 0 or beyond
    /// kMaxViewport (dominant-axis: a volume that needs one), and outputs with stopAtFirst. dominant-axis sets its
    /// triangles up one by one: a good deal slower than a view for meshes of small triangles.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> ask(const Count& question, const Batch& batch);
    [[nodiscard]] VOXTACT_API Result<DistanceAnswer> ask(const Distance& question, const Batch& batch);
    [[nodiscard]] VOXTACT_API Result<AreaAnswer> ask(const Area& question, const Batch& batch);
    /// Refuses a mesh with holes, too, and limits of bands that do not ascend, or are more than kMaxBandLimits.
    [[nodiscard]] VOXTACT_API Result<OverlapAnswer> ask(const Overlap& question, const Batch& batch);
    /// Refuses what poseBetween() refuses, too, another number of shapes than of items or of their poses, and shapes
    /// that Mesh::update() would refuse.
    [[nodiscard]] VOXTACT_API Result<MotionAnswer> ask(const Motion& question, const Batch& batch);
    /// Refuses a target that is not finite, an axis of no length, and a plan all of whose directions see no surface.
    [[nodiscard]] VOXTACT_API Result<PlanAnswer> ask(const Plan& question);

    /// How many threads it runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit HostEngine(std::unique_ptr<HostEngineImpl> impl) noexcept;
    std::unique_ptr<HostEngineImpl> impl_;
};

} // namespace voxtact::cpu
