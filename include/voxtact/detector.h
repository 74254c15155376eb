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
    /// Allows BatchItem::poses: adds the pass that creates their pairs. With staged Results, this pass also creates the
    /// pairs of 256 or more host poses; they are bit-identical. Unsupported on a device without doubles that round like
    /// the host's (shaderFloat64, shaderSignedZeroInfNanPreserveFloat64, shaderRoundingModeRTEFloat64).
    bool devicePoses = false;
};

/// Options of a detector that counts the fragments of a rasterisation.
struct RasterDesc {
    CountingMethod method = CountingMethod::Query;           ///< how fragments are counted; Cpu is refused: see cpu.h
    Projection projection = Projection::View;                ///< how meshes become fragments; Certified is refused
    Filter filter = Filter::Hardware;                        ///< how the image is sampled
    Boundary boundary = Boundary::Auto;                      ///< treatment of points outside the image
    Outputs outputs{};                                       ///< like CertifiedDesc::outputs
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel; ///< dominant-axis: along a voxel's side; 1 to 16
    /// dominant-axis: every pixel that a triangle touches gives a fragment, by VK_EXT_conservative_rasterization. The
    /// fragment's texture coordinate is that of the pixel's centre in the triangle's plane, up to one pixel outside the
    /// triangle. InvalidArgument for other projections and for the method compute.
    bool overestimate = false;
    /// Like CertifiedDesc::devicePoses. The queue needs compute in addition to graphics.
    bool devicePoses = false;
};

/// Options of a Detector, fixed for its life: each combination has its own pipelines.
using DetectorDesc = std::variant<CertifiedDesc, RasterDesc>;

/// One mesh at some poses against one volume under one transfer function.
struct BatchItem {
    const Mesh* mesh = nullptr;                         ///< required; must outlive the command buffer, like all objects
    const Volume* volume = nullptr;                     ///< required
    const TransferFunction* transferFunction = nullptr; ///< required: opacity of the volume's values
    std::span<const Mat4> world_from_object{};          ///< one affine pose per pair; read during recording only
    const LabelMap* labels = nullptr;                   ///< for the outputs contacts (optional) and labels
    /// Poses on the device instead of world_from_object; needs a detector with devicePoses. A pose that is not finite,
    /// or whose last row is not 0 0 0 1, has the count 0 and the exactness Refused. If certified, it is undecided.
    const PoseBuffer* poses = nullptr;
    std::optional<std::uint32_t> poseCount = std::nullopt; ///< number of `poses`, from the first; empty: all

    /// Returns the number of pairs.
    [[nodiscard]] VOXTACT_API std::size_t pairs() const noexcept;
};

/// The pairs of one submission: the items in order, each with its poses in order.
struct Batch {
    std::span<const BatchItem> items{};   ///< any number; the results have the same order
    View view{};                          ///< ignored by projections without a camera
    double threshold = kDefaultThreshold; ///< 0..1
};

/// Default capacity of the list of contacts.
inline constexpr std::uint32_t kDefaultContactRoom = 1U << 16U;

/// Capacity for the outputs of a detector, over all pairs of a batch: at least 1 for each of its outputs, ignored for
/// other outputs. The bounds have a capacity of maxPairs.
struct OutputRoom {
    std::uint64_t triangles = 0;                  ///< sum of the triangles of the pairs' meshes
    std::uint64_t labels = 0;                     ///< sum of the labels of the pairs' label maps
    std::uint32_t contacts = kDefaultContactRoom; ///< a longer list is cut
};

/// A range of a device buffer.
struct BufferRange {
    VkBuffer buffer = VK_NULL_HANDLE; ///< null: no range
    VkDeviceSize offset = 0;          ///< bytes
    VkDeviceSize size = 0;            ///< bytes
};

/// Capacity and options of Results, fixed for their life.
struct ResultsDesc {
    std::uint32_t maxPairs = 1;    ///< maximum pairs per batch
    bool readBack = true;          ///< keeps a host-visible copy for cmdReadBack() and read()
    bool timestamps = false;       ///< cmdDetect() writes timestamps around its work, for gpuMilliseconds()
    std::uint32_t queueFamily = 0; ///< with timestamps: family of the executing queue; refused if the family has none
    OutputRoom room{};             ///< capacity for the detector's outputs
    /// Certified detectors: maximum clusters of 64 triangles, once per pair, in a dispatch; 16 to 262144. A larger
    /// batch takes more dispatches. Each cluster takes 721 bytes of device memory. 0: 2048 to 16384 by maxPairs; more
    /// if maxComputeWorkGroupCount allows it and the queues take at most a 128th of the memory. Limited by
    /// maxComputeWorkGroupCount (16384 per 65535 along x) and maxStorageBufferRange. Reduce it if the driver resets the
    /// GPU during long dispatches.
    ///
    /// A dispatch tests at most 2^16 bricks and cells of large triangles per cluster, and 3.5e9 in total. It contains
    /// all work of a cluster for one pair. If the host does not know the vertices (wrapped mesh, Mesh::cmdCopy()),
    /// only the number of clusters is bounded. Huge triangles of such a mesh beyond the device's own bound are
    /// undecided (docs/engine.md, Dispatch size limits). No other answer depends on this number.
    std::uint32_t clustersAtOnce = 0;
    /// Passes the host's poses through mapped memory of the Results, 248 bytes per pair, instead of the command buffer.
    /// Recording thousands of pairs is then much faster if the driver is slow to write command buffers (NVIDIA's), and
    /// faster still with devicePoses. In exchange, record a batch only after the submission of the previous batch has
    /// completed, and do not submit that batch again. A ring has Results for each frame in flight. Irrelevant for poses
    /// on the device.
    bool staged = false;
    /// Caller's range for the PairResults, at least maxPairs * sizeof(PairResult) bytes of a buffer with the usage
    /// STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST. The offset is a multiple of 8 and of
    /// minStorageBufferOffsetAlignment. The buffer outlives the Results and the commands recorded with them; the rest
    /// of the buffer is not touched. A ring needs resultBytes() per frame. Null: the Results have their own buffer.
    BufferRange into{};
};

/// Returns the bytes from the PairResults of one frame of a ring to the next frame, for ResultsDesc::into: a multiple
/// of 256, a valid descriptor offset on every device.
[[nodiscard]] constexpr VkDeviceSize resultBytes(std::uint32_t maxPairs) noexcept {
    constexpr VkDeviceSize kAlignment = 256;
    return (VkDeviceSize{maxPairs} * sizeof(PairResult) + kAlignment - 1) / kAlignment * kAlignment;
}

/// Answers of one batch in flight: a device buffer of PairResult, and working memory. A second cmdDetect() on the same
/// queue waits for the first one and replaces its answers. On another queue, order the two by a semaphore or fence.
/// With ResultsDesc::staged, record the second one after the first one has completed.
/// Thread-safety: none; one thread at a time.
class Results {
  public:
    /// Allocates the buffers for batches of a detector. Other detectors of its Context may also use the Results if both
    /// are certified or both are not, and `detector` has their outputs. Refuses zero pairs, more pairs than the
    /// device's limits allow (LimitExceeded, with the limit), and a capacity of 0 for an output of the detector.
    /// Refuses timestamps on a queue family without them, and an `into` that is too small or misaligned.
    [[nodiscard]] VOXTACT_API static Result<Results> create(const Detector& detector, const ResultsDesc& desc);
    VOXTACT_API Results(Results&&) noexcept;
    VOXTACT_API Results& operator=(Results&&) noexcept;
    VOXTACT_API ~Results();

    /// Returns the capacity in pairs.
    [[nodiscard]] VOXTACT_API std::uint32_t maxPairs() const noexcept;
    /// Returns the number of pairs of the last recorded batch.
    [[nodiscard]] VOXTACT_API std::uint32_t pairs() const noexcept;
    /// Returns the range of maxPairs PairResults, for the next pass: ResultsDesc::into, or a whole buffer with the
    /// usage STORAGE_BUFFER | TRANSFER_SRC | TRANSFER_DST.
    [[nodiscard]] VOXTACT_API BufferRange pairResults() const noexcept;
    /// Returns the buffer of pairResults().
    [[nodiscard]] VOXTACT_API VkBuffer buffer() const noexcept;

    /// The following functions return the ranges of the outputs, for the next pass. Ranges of outputs that the detector
    /// of the last recorded batch lacks hold nothing useful. All are in one buffer with the usage STORAGE_BUFFER |
    /// TRANSFER_SRC | TRANSFER_DST, become visible to readers with pairResults(), and have the size of their capacity.
    /// Offsets are multiples of 256. Pairs follow each other in order.
    ///
    /// Returns one uint per triangle of each pair: its passing fragments.
    [[nodiscard]] VOXTACT_API BufferRange triangleCounts() const noexcept;
    /// Returns one bit per triangle of each pair, lowest bit first: 1 if it has passing fragments. Each pair begins
    /// with a new uint.
    [[nodiscard]] VOXTACT_API BufferRange triangleMask() const noexcept;
    /// Returns four uints (number of contacts, low and high word; capacity; 0), then the list of ContactResult
    /// (device_results.h), up to the capacity.
    [[nodiscard]] VOXTACT_API BufferRange contacts() const noexcept;
    /// Returns six uints per pair; all 0 without a passing fragment. uintBitsToFloat(VOXTACT_BOUND_BITS(word)) of
    /// device_results.h decodes -lo.x, -lo.y, -lo.z, hi.x, hi.y and hi.z of the box, world mm.
    [[nodiscard]] VOXTACT_API BufferRange bounds() const noexcept;
    /// Returns one uint per label of each pair's label map, by index: its passing fragments, modulo 2^32.
    [[nodiscard]] VOXTACT_API BufferRange labelCounts() const noexcept;

    /// Records a copy of the results and outputs to host memory. Call it after cmdDetect(), outside a render pass.
    ///   expects  the results as cmdDetect() leaves them
    ///   leaves   the host copy readable once the submission is complete
    ///   queries  not affected; bound state: none is lost
    VOXTACT_API Result<void> cmdReadBack(VkCommandBuffer commandBuffer);
    /// Returns the host copy of a completed submission; NotReady if the copy visibly has not executed. Valid until the
    /// next cmdReadBack() executes, or the Results are destroyed.
    [[nodiscard]] VOXTACT_API Result<std::span<const PairResult>> read();
    /// Unpacks the outputs of the last recorded batch: all of a BatchAnswer except its pairs and times. Outputs that
    /// the detector lacks are empty. Like read(), expects a completed submission.
    [[nodiscard]] VOXTACT_API Result<void> readOutputs(BatchAnswer& answer);
    /// Returns true if the detector of the last recorded batch has CertifiedDesc::counters.
    [[nodiscard]] VOXTACT_API bool counted() const noexcept;
    /// Returns the counters of the certified passes of a completed submission; NotReady unless counted().
    [[nodiscard]] VOXTACT_API Result<CertifiedCounters> counters();
    /// Returns the device time of cmdDetect()'s commands after a completed submission, with `timestamps`; else
    /// NotReady. 0 if the clock ran backwards.
    [[nodiscard]] VOXTACT_API Result<double> gpuMilliseconds();

    [[nodiscard]] ResultsImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Results(std::unique_ptr<ResultsImpl> impl) noexcept;
    std::unique_ptr<ResultsImpl> impl_;
};

/// Results for frames in flight: frame n uses slot n modulo frames(). Record frame n while earlier frames execute, and
/// read it once it has completed. No function waits.
/// Thread-safety: none; one thread at a time.
class ResultRing {
  public:
    /// Creates `frames` slots, 1 to 4096. Refuses options that Results::create() refuses. With ResultsDesc::into, the
    /// results of a frame begin resultBytes(maxPairs) * (frame modulo frames) bytes after `into.offset`.
    [[nodiscard]] VOXTACT_API static Result<ResultRing> create(const Detector& detector, std::uint32_t frames,
                                                               const ResultsDesc& desc);

    /// Returns the number of slots.
    [[nodiscard]] std::uint32_t frames() const noexcept { return static_cast<std::uint32_t>(slots_.size()); }
    /// Claims the slot of `frame` for recording. Expects that frame `frame - frames()` has completed. The slot is
    /// readable after a recorded detection and read-back. Frames ascend; refuses a frame older than the frame of its
    /// slot.
    [[nodiscard]] VOXTACT_API Result<Results*> begin(std::uint64_t frame);
    /// Returns the slot of a completed frame, for its counters and times. NotReady if a later frame has claimed the
    /// slot, or no frame has. Valid until the ring is destroyed; belongs to the next frame from its begin() on.
    [[nodiscard]] VOXTACT_API Result<Results*> results(std::uint64_t frame);
    /// Calls Results::read() of the slot of a completed frame.
    [[nodiscard]] VOXTACT_API Result<std::span<const PairResult>> read(std::uint64_t frame);
    /// Calls Results::readOutputs() of the slot of a completed frame.
    [[nodiscard]] VOXTACT_API Result<void> readOutputs(std::uint64_t frame, BatchAnswer& answer);

  private:
    struct Slot {
        Results results;
        std::uint64_t frame = 0;
        bool used = false;
    };
    std::vector<Slot> slots_;
};

/// Decides which pairs collide. Thread-safety: cmdDetect() is safe from any thread with different command buffers and
/// Results.
class Detector {
  public:
    /// Creates a certified detector. Fails with Unsupported if the device cannot run the detector; the error names the
    /// missing feature or limit. The outputs need five bound descriptor sets (maxBoundDescriptorSets).
    [[nodiscard]] VOXTACT_API static Result<Detector> certified(const Context& context, const CertifiedDesc& desc = {});
    /// Creates a detector that counts fragments. Fails like certified(). With a rasterising method, the outputs also
    /// need fragmentStoresAndAtomics and geometryShader.
    [[nodiscard]] VOXTACT_API static Result<Detector> raster(const Context& context, const RasterDesc& desc);
    /// Calls certified() or raster().
    [[nodiscard]] VOXTACT_API static Result<Detector> create(const Context& context, const DetectorDesc& desc);
    VOXTACT_API Detector(Detector&&) noexcept;
    VOXTACT_API Detector& operator=(Detector&&) noexcept;
    VOXTACT_API ~Detector();

    /// Records the detection of a batch. Allocates no device memory, submits nothing, waits for nothing, maps nothing.
    /// The command buffer contains the poses and may be submitted again, except with ResultsDesc::staged. A PoseBuffer
    /// is read at execution: each submission uses its current poses.
    ///
    ///   call it          outside a render pass, in a primary command buffer, on a queue with graphics, or, for
    ///                    the method compute, on one with compute, with or without graphics
    ///   expects          volume, transfer function and mesh readable as cmdUpload() leaves them; wrapped objects in
    ///                    the given layout and visible to VERTEX_INPUT / FRAGMENT_SHADER (for the projection
    ///                    dominant-axis: to VERTEX_SHADER / FRAGMENT_SHADER, for the method compute: to
    ///                    COMPUTE_SHADER); a buffer of poses visible to COMPUTE_SHADER. An earlier use of the
    ///                    same Results in this queue may be in flight: the commands wait for its reads of
    ///                    pairResults(), by cmdReadBack() and by compute and fragment shaders
    ///   leaves           Results::pairResults() available and visible to TRANSFER read, and to shader reads in all
    ///                    stages
    ///   queries          no occlusion query may be active
    ///   bound state      lost: graphics pipeline, descriptor sets 0..2 of the graphics bind point (0..3 with
    ///                    dominant-axis, 0..4 with outputs), push constants, vertex binding 0, index buffer, dynamic
    ///                    viewport and scissor. The method compute loses instead, and devicePoses also: compute
    ///                    pipeline, descriptor sets 0..3 of the compute bind point (0..4 with outputs), push
    ///                    constants
    ///
    /// Refuses Results whose detector is of another kind or lacks an output, and batches beyond their capacity (except
    /// the list of contacts, which is cut). With the output labels, refuses items without a label map. After an error,
    /// do not submit the command buffer.
    VOXTACT_API Result<void> cmdDetect(VkCommandBuffer commandBuffer, const Batch& batch, Results& results) const;

    /// Returns the options of the detector.
    [[nodiscard]] VOXTACT_API const DetectorDesc& desc() const noexcept;
    /// Returns the variant that Boundary::Auto selects for an item at a threshold: Range or Clamp.
    [[nodiscard]] VOXTACT_API Boundary boundaryFor(const BatchItem& item, double threshold) const noexcept;

    [[nodiscard]] DetectorImpl& impl() const noexcept { return *impl_; }

  private:
    friend class BlockingDetector;
    [[nodiscard]] static Result<Detector> create(ContextImpl& context, const DetectorDesc& desc);
    explicit Detector(std::unique_ptr<DetectorImpl> impl) noexcept;
    std::unique_ptr<DetectorImpl> impl_;
};

/// Records a batch, submits it on the caller's queue, waits, and reads the answers. Keeps its command buffer, fence and
/// Results for the next call, and enlarges the Results when needed. On a GPU with doubles, the method compute creates
/// the pairs of 256 or more host poses on the device, as with CertifiedDesc::devicePoses. Thread-safety: none; one
/// thread at a time.
class BlockingDetector {
  public:
    /// Creates a detector for a queue with graphics or, for the method compute, with compute. Cuts a list of contacts
    /// beyond `maxContacts`.
    [[nodiscard]] VOXTACT_API static Result<BlockingDetector> create(const Context& context, const DetectorDesc& desc,
                                                                     const QueueAccess& queue,
                                                                     std::uint32_t maxContacts = kDefaultContactRoom);
    VOXTACT_API BlockingDetector(BlockingDetector&&) noexcept;
    VOXTACT_API BlockingDetector& operator=(BlockingDetector&&) noexcept;
    VOXTACT_API ~BlockingDetector();

    /// Returns the answers for every pair of the batch. Blocks. Refuses batches that Detector::cmdDetect() refuses.
    /// After an error, nothing of the batch is in flight, and the next call works unless the device is lost.
    [[nodiscard]] VOXTACT_API Result<BatchAnswer> detect(const Batch& batch);
    /// Returns the recording detector, valid as long as this object.
    [[nodiscard]] VOXTACT_API const Detector& detector() const noexcept;

  private:
    struct State;
    explicit BlockingDetector(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Verdict of selfTest() on one counting method.
struct SelfTestVerdict {
    CountingMethod method;  ///< the method
    bool available = false; ///< true if the device supports it
    bool trusted = false;   ///< true if available, and every count was right
    std::string text;       ///< the comparisons, or the failure
};

/// Renders a known number of fragments by each of `methods` (empty: all of the Context): a full viewport in an opaque,
/// a transparent and a half-opaque volume. For methods whose default filter is Exact, also compares each operation that
/// exactness needs (floats, conversions, 32- and 64-bit integers, additions in a work group, texels) with the host, bit
/// for bit, on 10^5 inputs. Blocks for tens of milliseconds, plus the creation of pipelines. A failing method is not
/// trusted; only a lost device fails the call.
[[nodiscard]] VOXTACT_API Result<std::vector<SelfTestVerdict>>
selfTest(const Context& context, const QueueAccess& queue, std::span<const CountingMethod> methods = {});

} // namespace voxtact
