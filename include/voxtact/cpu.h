// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/area.h"
#include "voxtact/clearance.h"
#include "voxtact/data.h"
#include "voxtact/motion.h"
#include "voxtact/plan.h"
#include "voxtact/results.h"

#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The host engine (target voxtact::cpu): the same questions answered without a device, by the same pixels and the
/// same arithmetic as the counting method `compute` with `exact` filtering (shaders/exact.h). Nothing here needs
/// Vulkan. Everything that is skipped (clusters of triangles, triangles, spans) is skipped only where it provably has
/// no survivor, so that skipping never changes a count.
///
/// Lifetime: an object must outlive the calls that use it; nothing of what it was made from is kept.
/// Thread-safety: const functions are safe from any thread.
namespace voxtact::cpu {

struct VolumeImpl;
struct TransferFunctionImpl;
struct MeshImpl;
struct DetectorImpl;
struct AreaMeterImpl;
struct ClearanceMeterImpl;
struct ClearanceTrackerImpl;
struct MotionCheckerImpl;
struct PlannerImpl;

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

    /// Edits: the next detect() sees them. None may run on the volume meanwhile. Either all of an edit is done or,
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
    /// mesh that is made afresh; what is faster is that triangles stay in their clusters, whose boxes are fitted to
    /// them: where neighbours go far apart, a mesh made afresh is faster to ask. O(vertices + triangles). Refuses
    /// another number of coordinates and what checkMesh() refuses; the mesh is then as it was.
    [[nodiscard]] VOXTACT_API Result<void> update(std::span<const float> positions);
    [[nodiscard]] const MeshImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Mesh(std::unique_ptr<MeshImpl> impl) noexcept;
    std::unique_ptr<MeshImpl> impl_;
};

/// One mesh at some poses against one volume under one transfer function.
struct BatchItem {
    const Mesh* mesh = nullptr;                         ///< must be given, as all but the labels; read by detect() only
    const Volume* volume = nullptr;                     ///< what is touched
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
inline constexpr std::uint32_t kMostThreads = 4096;

/// What a Detector of the host is made for.
struct DetectorDesc {
    std::uint32_t threads = 0;          ///< 0: one for each processor; at most kMostThreads
    Boundary boundary = Boundary::Auto; ///< Auto is the range test: the host has nothing to gain from clamping
    bool stopAtFirst = false;           ///< the count is then 0 or 1, and its exactness LowerBound
    /// dominant-axis sets its triangles up one by one: a good deal slower than a view for meshes of small triangles.
    Projection projection = Projection::View;
    Outputs outputs{};                                       ///< with stopAtFirst: refused
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel; ///< dominant-axis: along a voxel's side; 1 to 16
    double resolution = kDefaultResolution;                  ///< conservative, voxels; 2^-12 to 1
    std::uint32_t mostContacts = 1U << 20U;                  ///< a list of contacts is cut beyond that many
};

/// Keeps its threads from call to call. Where the last two calls were done sooner than another thread is woken, one
/// that has no more to do begins on the caller's thread alone. Thread-safety: one detect() at a time.
class Detector {
  public:
    /// Starts its threads. Refuses numbers outside the ranges of DetectorDesc, and outputs with stopAtFirst.
    [[nodiscard]] VOXTACT_API static Result<Detector> create(const DetectorDesc& desc = {});
    VOXTACT_API Detector(Detector&&) noexcept;
    VOXTACT_API Detector& operator=(Detector&&) noexcept;
    VOXTACT_API ~Detector();

    /// Answers for every pair, with CountingMethod::Cpu. gpuMilliseconds is 0. Refuses what the Vulkan detector
    /// refuses: null objects, bad poses, a singular camera, a viewport of 0 or beyond kMaxViewport (dominant-axis: a
    /// volume that needs one), a threshold outside [0,1].
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> detect(const Batch& batch);
    /// How many threads detect() runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit Detector(std::unique_ptr<DetectorImpl> impl) noexcept;
    std::unique_ptr<DetectorImpl> impl_;
};

/// What an AreaMeter is made for.
struct AreaDesc {
    std::uint32_t threads = 0;                ///< 0: one for each processor; at most kMostThreads
    double tolerance = kDefaultAreaTolerance; ///< mm^2, from 1e-9 on: how near to each other the bounds are brought
    double resolution = kDefaultResolution;   ///< of the touch, as in DetectorDesc
    /// A pair, or a label of one, that takes more is left with the bounds it has; at least 1. Each step takes half a
    /// kilobyte of a thread's memory at most, while its pair is measured.
    std::uint64_t mostSteps = 1U << 18U;
};

/// Measures how much of meshes is in what is opaque, in mm^2. What it answers depends on nothing but the pair and its
/// desc: not on the threads, not on what else is in a batch, and not on which other labels are asked for. Keeps its
/// threads from call to call, and what it makes of the last volumes and transfer functions. Thread-safety: one call at
/// a time.
class AreaMeter {
  public:
    /// Starts its threads. Refuses numbers outside the ranges of AreaDesc.
    [[nodiscard]] VOXTACT_API static Result<AreaMeter> create(const AreaDesc& desc = {});
    VOXTACT_API AreaMeter(AreaMeter&&) noexcept;
    VOXTACT_API AreaMeter& operator=(AreaMeter&&) noexcept;
    VOXTACT_API ~AreaMeter();

    /// The contact area of every pair. Labels and view are not looked at. Refuses what Detector::detect() refuses.
    [[nodiscard]] VOXTACT_API Result<AreaAnswer> measure(const Batch& batch);
    /// The same, and what each triangle has of it. The tolerance is of the pair's area; no triangle's bounds are
    /// farther apart than the pair's. All of a batch is in memory until it is done, some 100 bytes for each triangle
    /// that touches: ask for many poses in parts.
    [[nodiscard]] VOXTACT_API Result<TriangleAreaAnswer> measureTriangles(const Batch& batch);
    /// The contact area of every pair in each label's part of what is opaque; of labels that a map does not have it is
    /// 0. Every item needs labels, on the grid of its volume. Refuses what measure() refuses, other grids
    /// (Unsupported), and more than kMostMeasuredLabels labels (LimitExceeded).
    [[nodiscard]] VOXTACT_API Result<LabelAreaAnswer> measureLabels(const Batch& batch,
                                                                    std::span<const std::int32_t> labels);
    /// How many threads it runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit AreaMeter(std::unique_ptr<AreaMeterImpl> impl) noexcept;
    std::unique_ptr<AreaMeterImpl> impl_;
};

/// What a ClearanceMeter is made for.
struct ClearanceDesc {
    std::uint32_t threads = 0;            ///< 0: one for each processor; at most kMostThreads
    double tolerance = kDefaultTolerance; ///< mm, from 1e-6 on: how near to each other the bounds are brought
    double maximum = std::numeric_limits<double>::infinity(); ///< mm, above 0: what is farther is not measured
    double resolution = kDefaultResolution;                   ///< of the touch, as in DetectorDesc
    std::uint64_t mostSteps = 1U << 18U; ///< a pair that takes more is left with the bounds it has; at least 1
    bool labelsAtAnyOpacity = false;     ///< measureLabels(): to all of a label, be it opaque or not
};

using voxtact::kMostMeasuredLabels;

/// Measures how near meshes are to what is opaque. What it answers depends on nothing but the pair and its desc: not on
/// the threads, and not on what else is in a batch. Keeps its threads from call to call, and what it makes of the last
/// volumes and transfer functions. Thread-safety: one call at a time.
class ClearanceMeter {
  public:
    /// Starts its threads. Refuses numbers outside the ranges of ClearanceDesc.
    [[nodiscard]] VOXTACT_API static Result<ClearanceMeter> create(const ClearanceDesc& desc = {});
    VOXTACT_API ClearanceMeter(ClearanceMeter&&) noexcept;
    VOXTACT_API ClearanceMeter& operator=(ClearanceMeter&&) noexcept;
    VOXTACT_API ~ClearanceMeter();

    /// The clearance of every pair. Labels and view are not looked at. Refuses what Detector::detect() refuses.
    [[nodiscard]] VOXTACT_API Result<ClearanceAnswer> measure(const Batch& batch);
    /// The clearance of every pair to each label's part of what is opaque, or to all of the label
    /// (ClearanceDesc::labelsAtAnyOpacity): a label fills the closed boxes of its voxels, so that a face between two
    /// labels belongs to both. Where it touches, `lo` is 0 and `hi` within the tolerance, mostly a millionth. Every
    /// item needs labels, on the grid of its volume; labels that a map does not have are infinitely far. Refuses what
    /// measure() refuses, other grids (Unsupported), and more than kMostMeasuredLabels labels (LimitExceeded).
    [[nodiscard]] VOXTACT_API Result<LabelClearanceAnswer> measureLabels(const Batch& batch,
                                                                         std::span<const std::int32_t> labels);
    /// Whether something opaque is within `margin` mm of the surface, for every pair: `hit` where it certainly is,
    /// `possible` where rounding does not let it be said. The count is 0 or 1. A margin of 0 is the touch itself,
    /// answered as by a Detector with stopAtFirst and Projection::Conservative. Refuses what measure() refuses, and a
    /// margin that is negative or not finite.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> within(const Batch& batch, double margin);
    /// How many threads it runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit ClearanceMeter(std::unique_ptr<ClearanceMeterImpl> impl) noexcept;
    std::unique_ptr<ClearanceMeterImpl> impl_;
};

/// What a ClearanceTracker is made for.
struct TrackerDesc {
    /// mm, above 0: farther than this is never looked.
    double maximum = std::numeric_limits<double>::infinity();
    double resolution = kDefaultResolution; ///< of the touch, as in DetectorDesc
    std::uint64_t mostSteps = 512;          ///< of one search, at least 1: then the bounds are what they are
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
class ClearanceTracker {
  public:
    /// Refuses numbers outside the ranges of TrackerDesc.
    [[nodiscard]] VOXTACT_API static Result<ClearanceTracker> create(const TrackerDesc& desc = {});
    VOXTACT_API ClearanceTracker(ClearanceTracker&&) noexcept;
    VOXTACT_API ClearanceTracker& operator=(ClearanceTracker&&) noexcept;
    VOXTACT_API ~ClearanceTracker();

    /// Of one mesh at one pose; labels are not looked at. Another mesh, volume, transfer function or threshold than in
    /// the call before, and an edit, are no error: it then looks. Refuses what Detector::detect() refuses, and any
    /// number of poses but 1.
    [[nodiscard]] VOXTACT_API Result<TrackedClearance> track(const BatchItem& item,
                                                             double threshold = kDefaultThreshold);

  private:
    explicit ClearanceTracker(std::unique_ptr<ClearanceTrackerImpl> impl) noexcept;
    std::unique_ptr<ClearanceTrackerImpl> impl_;
};

/// What a MotionChecker is made for.
struct MotionDesc {
    std::uint32_t threads = 0;                          ///< 0: one for each processor; at most kMostThreads
    Interpolation interpolation = Interpolation::Screw; ///< of the poses in between
    /// mm, from 1e-6 on: how far the mesh moves at most between the end of what is free and a touch.
    double resolution = kDefaultMotionResolution;
    double touchResolution = kDefaultResolution; ///< of the touch, as DetectorDesc::resolution
    std::uint64_t mostSteps = 1U << 20U;         ///< a segment that takes more is left with what is known; at least 1
};

/// The shapes of a mesh that bends, one for each pose of an item: its vertices, as Mesh::update() takes them.
using ShapesOfPoses = std::span<const std::span<const float>>;

/// Says whether meshes touch on the way from pose to pose. What it answers depends on nothing but the segment and its
/// desc. Keeps its threads from call to call, and what it makes of the last volumes and transfer functions.
/// Thread-safety: one call at a time.
class MotionChecker {
  public:
    /// Starts its threads. Refuses numbers outside the ranges of MotionDesc.
    [[nodiscard]] VOXTACT_API static Result<MotionChecker> create(const MotionDesc& desc = {});
    VOXTACT_API MotionChecker(MotionChecker&&) noexcept;
    VOXTACT_API MotionChecker& operator=(MotionChecker&&) noexcept;
    VOXTACT_API ~MotionChecker();

    /// The segments between consecutive poses of each item: one fewer than it has poses. Labels and view are not looked
    /// at. Refuses what Detector::detect() and poseBetween() refuse.
    [[nodiscard]] VOXTACT_API Result<MotionAnswer> check(const Batch& batch);
    /// The same of meshes that bend on the way: `shapes` has those of each item. From pose to pose, while the mesh
    /// moves as poseBetween() says, with the centre of the item's own mesh, its vertices go as shapeBetween() says.
    /// What is free is so for vertices between floats, too; what touches is the shape at that parameter. The items' own
    /// shapes are not looked at but for that centre. Refuses what check() does, another number of items or of shapes,
    /// and shapes that Mesh::update() would refuse.
    [[nodiscard]] VOXTACT_API Result<MotionAnswer> checkBending(const Batch& batch,
                                                                std::span<const ShapesOfPoses> shapes);
    /// Whether a mesh touches at some pose that is off by no more than the tolerance, for every pair: `hit` where it
    /// certainly does, neither that nor `possible` where it does at none of them. The count is 0 or 1. Refuses what
    /// Detector::detect() refuses, and numbers outside the ranges of PoseTolerance.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> around(const Batch& batch, const PoseTolerance& tolerance);
    /// How many threads it runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit MotionChecker(std::unique_ptr<MotionCheckerImpl> impl) noexcept;
    std::unique_ptr<MotionCheckerImpl> impl_;
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

/// What is to be planned.
struct PlanTask {
    Vec3 target{};                             ///< world mm
    EntrySurface surface{};                    ///< where paths begin
    std::span<const PlanObstacle> obstacles{}; ///< at least one
    Needle needle{};                           ///< the instrument
    std::optional<PlanMesh> mesh{};            ///< instead of the needle. Triangles are then not certified
    double margin = 0;                         ///< mm, that is to be kept
    std::optional<double> longest{};           ///< mm, of paths
    std::optional<double> steepest{};          ///< degrees between a path and the normal of the surface, to 90
    bool triangleClearances = false;           ///< of a needle: EntryTriangle::clearance, for about as long again
    const std::atomic<bool>* cancel = nullptr; ///< as Batch::cancel
};

/// What a Planner is made for.
struct PlannerDesc {
    std::uint32_t threads = 0;                ///< 0: one for each processor; at most kMostThreads
    double tolerance = kDefaultPlanTolerance; ///< mm, from 1e-6 on: how near to each other the bounds are brought
    double maximum = kDefaultPlanMaximum;     ///< mm, above 0: what is farther from a path is not measured
    std::uint64_t mostSteps = 1U << 18U;      ///< a path that takes more is left with the bounds it has; at least 1
};

/// Looks for straight paths to a target that keep clear of obstacles. What it answers depends on nothing but the task
/// and its desc. Thread-safety: one call at a time.
class Planner {
  public:
    /// Starts its threads. Refuses numbers outside the ranges of PlannerDesc.
    [[nodiscard]] VOXTACT_API static Result<Planner> create(const PlannerDesc& desc = {});
    VOXTACT_API Planner(Planner&&) noexcept;
    VOXTACT_API Planner& operator=(Planner&&) noexcept;
    VOXTACT_API ~Planner();

    /// Of all directions of the task. Refuses a target that is not finite, null objects, label maps on other grids
    /// (Unsupported), numbers outside of their ranges, an axis of no length, and a task all of whose directions see no
    /// surface.
    [[nodiscard]] VOXTACT_API Result<PlanAnswer> plan(const PlanTask& task);
    /// How many threads it runs on.
    [[nodiscard]] VOXTACT_API std::uint32_t threads() const noexcept;

  private:
    explicit Planner(std::unique_ptr<PlannerImpl> impl) noexcept;
    std::unique_ptr<PlannerImpl> impl_;
};

} // namespace voxtact::cpu
