// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/device_results.h"
#include "voxtact/results.h"
#include "voxtact/scene.h"

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace voxtact {

class Detector;
struct DetectorImpl;
struct ResultsImpl;

/// Certified answers, with rounding included: the projection certified by the method compute. Uses no camera and no
/// filter. The volumes need bricks.
struct CertifiedDesc {
    double resolution = kDefaultResolution; ///< voxels; 2^-12 to 1
    Outputs outputs{};                      ///< in addition to the counts; ResultsDesc::room is their capacity
    bool stopAtFirst = false;               ///< early exit, without outputs: the count is 0 or 1, a lower bound
    bool counters = false; ///< counts the work of the passes for Results::counters(); costs some atomics per triangle
    /// Batches may have BatchItem::poses. Adds the pass that makes pairs of them. In staged Results it also makes the
    /// pairs of 256 poses of the host or more; the pairs are the same, bit for bit. Unsupported on a device without
    /// doubles that round like the host's (shaderFloat64, shaderSignedZeroInfNanPreserveFloat64,
    /// shaderRoundingModeRTEFloat64).
    bool devicePoses = false;
};

/// Counts of the fragments of a rasterisation.
struct RasterDesc {
    CountingMethod method = CountingMethod::Query;           ///< how fragments are counted; Cpu is refused: see cpu.h
    Projection projection = Projection::View;                ///< how meshes become fragments; Certified is refused
    Filter filter = Filter::Hardware;                        ///< how the image is sampled
    Boundary boundary = Boundary::Auto;                      ///< treatment of points outside the image
    Outputs outputs{};                                       ///< like CertifiedDesc::outputs
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel; ///< dominant-axis: along a voxel's side; 1 to 16
    /// dominant-axis: every pixel that a triangle touches gives a fragment, by VK_EXT_conservative_rasterization. Its
    /// texture coordinate is that of the pixel's centre in the triangle's plane, up to a pixel outside the triangle.
    /// InvalidArgument for other projections and for the method compute.
    bool overestimate = false;
    /// Like CertifiedDesc::devicePoses. The queue needs compute in addition to graphics.
    bool devicePoses = false;
};

/// Options of a Detector, fixed for its life: each combination has its own pipelines.
using DetectorDesc = std::variant<CertifiedDesc, RasterDesc>;

/// One mesh at some poses against one volume under one transfer function.
struct BatchItem {
    const Mesh* mesh = nullptr;     ///< must be given, as all but the labels; outlives the command buffer
    const Volume* volume = nullptr; ///< what is touched
    const TransferFunction* transferFunction = nullptr; ///< what of it is opaque
    std::span<const Mat4> world_from_object{};          ///< a pose a pair; affine. Read while recording only
    /// For the outputs contacts (optional) and labels.
    const LabelMap* labels = nullptr;
    /// Poses on the device, instead of world_from_object, which is then empty; for detectors with devicePoses. A pose
    /// that is not finite, or whose last row is not 0 0 0 1, is not examined: its count is 0, its exactness Refused,
    /// and by the projection `certified` it is *possible*.
    const PoseBuffer* poses = nullptr;
    std::optional<std::uint32_t> poseCount = std::nullopt; ///< number of poses, from the first; nothing: all

    /// How many pairs it is.
    [[nodiscard]] VOXTACT_API std::size_t pairs() const noexcept;
};

/// The pairs of one submission: the items in order, each with its poses in order.
struct Batch {
    std::span<const BatchItem> items{};   ///< any number; results are in their order
    View view{};                          ///< not examined by projections without a camera
    double threshold = kDefaultThreshold; ///< 0..1
};

/// Contacts that a list has room for, where nothing else is asked for.
inline constexpr std::uint32_t kDefaultContactRoom = 1U << 16U;

/// Capacity for the outputs of a detector, over all pairs of a batch. Ignored for outputs that it does not have; at
/// least 1 for those that it has. The bounds have a capacity of maxPairs.
struct OutputRoom {
    std::uint64_t triangles = 0; ///< for the output triangles: the sum over the pairs of those of their meshes
    std::uint64_t labels = 0;    ///< for the output labels: the sum over the pairs of those of their label maps
    std::uint32_t contacts = kDefaultContactRoom; ///< for the output contacts; a longer list is cut
};

/// A part of a device buffer: where a descriptor of it begins, and how many bytes it has. The buffer is null where
/// there is nothing.
struct BufferRange {
    VkBuffer buffer = VK_NULL_HANDLE; ///< null: there is nothing
    VkDeviceSize offset = 0;          ///< bytes
    VkDeviceSize size = 0;            ///< bytes
};

/// How large Results are, and what they keep. Fixed for their life.
struct ResultsDesc {
    std::uint32_t maxPairs = 1; ///< pairs of the largest batch
    bool readBack = true;       ///< a host-visible copy is kept, for cmdReadBack() and read()
    bool timestamps = false;    ///< cmdDetect() writes a timestamp before and after its work, read by gpuMilliseconds()
    std::uint32_t queueFamily = 0; ///< with timestamps: of the queue that will execute; refused where it has none
    OutputRoom room{};             ///< capacity for the detector's outputs
    /// Certified detectors: maximum clusters of 64 triangles, once per pair, in a dispatch; 16 to 262144. A larger
    /// batch takes more dispatches. A dispatch tests at most 2^16 bricks and cells of large triangles per cluster, and
    /// 3.5e9 in total; but it never cuts a cluster of one pair, and of a mesh of which the host knows no vertex
    /// (wrapped, or after Mesh::cmdCopy()) only the clusters are bounded. If such a mesh has more huge triangles than
    /// the device's own bound allows (docs/engine.md, What bounds a dispatch), the rest of them is left undecided: the
    /// answer is then possible. No other answer depends on it. Choose it so that the driver does not take the GPU for
    /// stuck; each cluster takes 721 bytes of device memory. 0: by maxPairs, 2048 to 16384, or more if the device's
    /// maxComputeWorkGroupCount allows it and the queues take at most a 128th of its memory. In any case fewer where
    /// its maxComputeWorkGroupCount (16384 for each 65535 along x) or maxStorageBufferRange has no room for them.
    std::uint32_t clustersAtOnce = 0;
    /// What the host makes of poses goes through mapped memory of the Results, 248 bytes per pair, instead of the
    /// command buffer. Recording a batch of thousands of pairs then takes a fraction of the time with drivers that are
    /// slow to write into command buffers, as NVIDIA's is; by a detector with devicePoses it is the poses themselves,
    /// which is several times faster still. In exchange a batch may be recorded only when the submission of the one
    /// before it has completed, which is then not submitted again; a ring has Results for each frame in flight. Poses
    /// on the device need none of it.
    bool staged = false;
    /// Where the PairResults go: a part of a buffer of the caller's, of at least maxPairs * sizeof(PairResult) bytes,
    /// with the usage STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST. The offset is a multiple of 8 and of the device's
    /// minStorageBufferOffsetAlignment. It outlives the Results and what was recorded with them; what else lies in the
    /// buffer is left alone. A ring needs such a part for each frame, from one to the next resultBytes(). Null: the
    /// Results have a buffer of their own.
    BufferRange into{};
};

/// From the PairResults of one frame of a ring to those of the next, where ResultsDesc::into is given: those of so many
/// pairs, rounded up to 256 bytes, which every device takes for the offset of a descriptor.
[[nodiscard]] constexpr VkDeviceSize resultBytes(std::uint32_t maxPairs) noexcept {
    constexpr VkDeviceSize kAlignment = 256;
    return (VkDeviceSize{maxPairs} * sizeof(PairResult) + kAlignment - 1) / kAlignment * kAlignment;
}

/// Where the answers of one batch in flight go: a device buffer of PairResult, and what counting needs in addition to
/// it. One batch at a time. A second cmdDetect() in the same queue waits for the first one and replaces its answers; in
/// another queue it must not run before the first one has completed, which a semaphore or a fence of yours ensures.
/// With ResultsDesc::staged it must not even be recorded before: its poses replace the first one's.
/// Thread-safety: none; one thread at a time.
class Results {
  public:
    /// Allocates the buffers for batches of a detector, or of others of its Context: both certified or both not, and
    /// without outputs that it lacks. Refuses zero pairs, more pairs than the device's limits allow, including the
    /// queues of a certified detector (LimitExceeded: which limit, how large), a capacity of 0 for an output of the
    /// detector, timestamps on a queue family that has none, and an `into` that is too small or begins where no
    /// descriptor may.
    [[nodiscard]] VOXTACT_API static Result<Results> create(const Detector& detector, const ResultsDesc& desc);
    VOXTACT_API Results(Results&&) noexcept;
    VOXTACT_API Results& operator=(Results&&) noexcept;
    VOXTACT_API ~Results();

    /// Pairs that there is room for.
    [[nodiscard]] VOXTACT_API std::uint32_t maxPairs() const noexcept;
    /// Pairs of the batch recorded last.
    [[nodiscard]] VOXTACT_API std::uint32_t pairs() const noexcept;
    /// maxPairs PairResults, for the next pass on the device: ResultsDesc::into, or all of a buffer with the usage
    /// STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST.
    [[nodiscard]] VOXTACT_API BufferRange pairResults() const noexcept;
    /// The buffer of pairResults(), which begin at its offset.
    [[nodiscard]] VOXTACT_API VkBuffer buffer() const noexcept;

    /// The outputs in addition to the counts on the device, for the next pass: what the detector of the batch recorded
    /// last was made for; the other parts hold nothing of use. All are of one buffer with the usage STORAGE_BUFFER |
    /// TRANSFER_SRC | TRANSFER_DST, ready for readers when pairResults() are, and each is as large as there was room
    /// for. Offsets are multiples of 256. Pairs follow each other in their order.
    ///
    /// triangleCounts(): a uint for each triangle of each pair, its survivors. Those of a pair begin after as many as
    /// the pairs before it have triangles.
    [[nodiscard]] VOXTACT_API BufferRange triangleCounts() const noexcept;
    /// A bit for each triangle of each pair, in uints, lowest first: whether it has survivors. Each pair begins with a
    /// uint of its own.
    [[nodiscard]] VOXTACT_API BufferRange triangleMask() const noexcept;
    /// Four uints: contacts that were found, low and high word; the room; 0. Then the list, of ContactResult in
    /// device_results.h: as many as were found, or as there is room for.
    [[nodiscard]] VOXTACT_API BufferRange contacts() const noexcept;
    /// Six uints for each pair; all 0 where it has no survivor. Decoded by uintBitsToFloat(VOXTACT_BOUND_BITS(word)),
    /// of device_results.h, they are -lo.x, -lo.y, -lo.z, hi.x, hi.y and hi.z of its box; world, mm.
    [[nodiscard]] VOXTACT_API BufferRange bounds() const noexcept;
    /// A uint for each label of the label map of each pair, by number: its survivors, modulo 2^32. Those of a pair
    /// begin after as many as the pairs before it have labels.
    [[nodiscard]] VOXTACT_API BufferRange labelCounts() const noexcept;

    /// Records a copy of the results to host memory, the outputs among them. Call it after cmdDetect(), outside a
    /// render pass.
    ///   expects  the results as cmdDetect() leaves them
    ///   leaves   the host copy readable once the submission is complete
    ///   queries  not affected; bound state: none is lost
    VOXTACT_API Result<void> cmdReadBack(VkCommandBuffer commandBuffer);
    /// The host copy, of a submission that the caller knows to be complete; NotReady where it can be seen not to be.
    /// Valid until the next cmdReadBack() executes, or the Results end.
    [[nodiscard]] VOXTACT_API Result<std::span<const PairResult>> read();
    /// Unpacks the host copy of the outputs of the batch recorded last: everything of a BatchAnswer but its pairs and
    /// times. What its detector was not made for is left empty. The same is expected as by read().
    [[nodiscard]] VOXTACT_API Result<void> readOutputs(BatchAnswer& answer);
    /// Whether the batch recorded last is of a detector with CertifiedDesc::counters.
    [[nodiscard]] VOXTACT_API bool counted() const noexcept;
    /// What the passes did, of a detector with CertifiedDesc::counters. The same is expected as by read(); NotReady
    /// where they are not counted().
    [[nodiscard]] VOXTACT_API Result<CertifiedCounters> counters();
    /// Device time between the start and the end of cmdDetect()'s commands, when `timestamps` was asked for and the
    /// submission is complete; 0 where the clock went backwards. NotReady otherwise.
    [[nodiscard]] VOXTACT_API Result<double> gpuMilliseconds();

    [[nodiscard]] ResultsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Results(std::unique_ptr<ResultsImpl> impl) noexcept;
    std::unique_ptr<ResultsImpl> impl_;
};

/// Results for frames in flight: frame n uses slot n modulo the number of frames, so that frame n is recorded while
/// the ones before it are still on the device, and read when the caller knows that it has completed. Nothing waits.
/// Thread-safety: none; one thread at a time.
class ResultRing {
  public:
    /// `frames`: how many may be in flight, 1 to 4096. Otherwise refuses what Results::create() refuses. With
    /// ResultsDesc::into, the results of `frame` begin resultBytes(maxPairs) * (frame modulo frames) after its offset.
    [[nodiscard]] VOXTACT_API static Result<ResultRing> create(const Detector& detector, std::uint32_t frames,
                                                               const ResultsDesc& desc);

    /// Slots, one for each frame in flight.
    [[nodiscard]] std::uint32_t frames() const noexcept { return static_cast<std::uint32_t>(slots_.size()); }
    /// Claims the slot of `frame` for recording; nothing can be read of it until a detection and its read-back are
    /// recorded. The caller knows that frame `frame - frames()` has completed. Frames ascend; claiming one that is
    /// older than its slot's is refused.
    [[nodiscard]] VOXTACT_API Result<Results*> begin(std::uint64_t frame);
    /// The slot of a completed frame, to read whatever its Results have: counters, times. NotReady when it
    /// was never used, or has been taken by a later frame. Lives as long as the ring does, and is the next frame's from
    /// the begin() of that on.
    [[nodiscard]] VOXTACT_API Result<Results*> results(std::uint64_t frame);
    /// Results::read() of the slot of a completed frame.
    [[nodiscard]] VOXTACT_API Result<std::span<const PairResult>> read(std::uint64_t frame);
    /// The same for Results::readOutputs().
    [[nodiscard]] VOXTACT_API Result<void> readOutputs(std::uint64_t frame, BatchAnswer& answer);

  private:
    struct Slot {
        Results results;
        std::uint64_t frame = 0;
        bool used = false;
    };
    std::vector<Slot> slots_;
};

/// Decides which pairs collide. See the manual, "The method".
/// Thread-safety: cmdDetect is const and safe from any thread with different command buffers and Results.
class Detector {
  public:
    /// Unsupported, with the missing feature or limit named, if the device cannot run it. The outputs need five bound
    /// descriptor sets (maxBoundDescriptorSets).
    [[nodiscard]] VOXTACT_API static Result<Detector> certified(const Context& context, const CertifiedDesc& desc = {});
    /// Like certified(). With the methods of the rasteriser the outputs also need fragmentStoresAndAtomics and
    /// geometryShader.
    [[nodiscard]] VOXTACT_API static Result<Detector> raster(const Context& context, const RasterDesc& desc);
    /// certified() or raster(), by the alternative.
    [[nodiscard]] VOXTACT_API static Result<Detector> create(const Context& context, const DetectorDesc& desc);
    VOXTACT_API Detector(Detector&&) noexcept;
    VOXTACT_API Detector& operator=(Detector&&) noexcept;
    VOXTACT_API ~Detector();

    /// Records the detection of a batch: no allocation of device memory, no submission, no wait, no map. The poses
    /// are recorded into the command buffer, so it may be submitted again without its Results being overwritten by
    /// the host in between; with ResultsDesc::staged they are in the Results, and it may not. Those of a PoseBuffer are
    /// read when it executes: recorded once, it may be submitted again and again, each time for the poses that are
    /// there then.
    ///
    ///   call it          outside a render pass, in a primary command buffer, on a queue with graphics, or, for
    ///                    the method compute, on one with compute, with or without graphics
    ///   expects          volume, transfer function and mesh readable as cmdUpload() leaves them, wrapped ones in the
    ///                    layout that was given and made visible to VERTEX_INPUT / FRAGMENT_SHADER (for the projection
    ///                    dominant-axis: to VERTEX_SHADER / FRAGMENT_SHADER, for the method compute: to
    ///                    COMPUTE_SHADER) by the caller; a buffer of poses made visible to COMPUTE_SHADER; an earlier
    ///                    use of the same Results in this queue may be in flight: the reads that cmdReadBack() and
    ///                    compute or fragment shaders make of pairResults() are waited for
    ///   leaves           Results::pairResults() available and visible to TRANSFER read, and to shader reads in all
    ///                    stages
    ///   queries          no occlusion query may be active
    ///   bound state      lost: graphics pipeline, descriptor sets 0..2 of the graphics bind point (0..3 with
    ///                    dominant-axis, 0..4 with outputs), push constants, vertex binding 0, index buffer, dynamic
    ///                    viewport and scissor; for the method compute instead, and with devicePoses as well: compute
    ///                    pipeline, descriptor sets 0..3 of the compute bind point (0..4 with outputs), push
    ///                    constants
    ///
    /// Refuses Results of a detector that is not certified like this one, or lacks one of its outputs. With outputs,
    /// batches are refused that the Results have no room for (the list of contacts is cut instead), and with the output
    /// labels, items without a label map. The Results keep what readOutputs() needs of the batch.
    ///
    /// On error nothing useful was recorded, and the command buffer must not be submitted.
    VOXTACT_API Result<void> cmdDetect(VkCommandBuffer commandBuffer, const Batch& batch, Results& results) const;

    /// Returns the options that it was made with.
    [[nodiscard]] VOXTACT_API const DetectorDesc& desc() const noexcept;
    /// Which variant Boundary::Auto takes for an item at a threshold: Range or Clamp.
    [[nodiscard]] VOXTACT_API Boundary boundaryFor(const BatchItem& item, double threshold) const noexcept;

    [[nodiscard]] DetectorImpl& impl() const noexcept { return *impl_; }

  private:
    friend class BlockingDetector;
    [[nodiscard]] static Result<Detector> create(ContextImpl& context, const DetectorDesc& desc);
    explicit Detector(std::unique_ptr<DetectorImpl> impl) noexcept;
    std::unique_ptr<DetectorImpl> impl_;
};

/// The blocking convenience: records a batch, submits it on the caller's queue, waits, and reads the answers. Keeps
/// its command buffer, fence and Results for the next call and makes larger ones when a batch needs them. On a GPU that
/// has doubles, a method that computes makes the pairs of 256 poses of the host or more on the device, as with
/// CertifiedDesc::devicePoses. Thread-safety: none; one thread at a time.
class BlockingDetector {
  public:
    /// The queue's family must be able to draw, or, for the method compute, to compute. A CertifiedDesc or RasterDesc
    /// converts. A list of contacts is cut beyond `mostContacts`.
    [[nodiscard]] VOXTACT_API static Result<BlockingDetector> create(const Context& context, const DetectorDesc& desc,
                                                                     const QueueAccess& queue,
                                                                     std::uint32_t mostContacts = kDefaultContactRoom);
    VOXTACT_API BlockingDetector(BlockingDetector&&) noexcept;
    VOXTACT_API BlockingDetector& operator=(BlockingDetector&&) noexcept;
    VOXTACT_API ~BlockingDetector();

    /// Answers for every pair of the batch. Blocks. Refuses what Detector::cmdDetect() refuses. After an error nothing
    /// of the failed batch is in flight, and the next call works, unless the device is lost.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> detect(const Batch& batch);
    /// The detector that records; it lives as long as this object.
    [[nodiscard]] VOXTACT_API const Detector& detector() const noexcept;

  private:
    struct State;
    explicit BlockingDetector(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// What selfTest() found for one counting method.
struct SelfTestVerdict {
    CountingMethod method;  ///< which
    bool available = false; ///< whether the device can do it
    bool trusted = false;   ///< available, and every count was as it must be
    std::string text;       ///< what was counted and compared, or what is wrong
};

/// Renders a known number of fragments by each of `methods` (empty: all that the Context knows) on this driver: a full
/// viewport in an opaque volume, in a transparent one, and in a half-opaque one. Where the method's default filter is
/// Exact, also does each operation that exactness rests on (floats, conversions, 32- and 64-bit integers, additions in
/// a work group, texels) on 10^5 inputs, and compares with the host bit for bit. Blocks; some ten milliseconds, and the
/// making of pipelines. A method that the driver fails is not trusted, with the error or the operation as its text;
/// only a lost device fails the call.
[[nodiscard]] VOXTACT_API Result<std::vector<SelfTestVerdict>>
selfTest(const Context& context, const QueueAccess& queue, std::span<const CountingMethod> methods = {});

} // namespace voxtact
