// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/chunk_options.h"
#include "app/detect/detect_jobs.h"
#include "app/detect/extra_outputs.h"
#include "app/detect/pose_source.h"
#include "app/options/label_words.h"
#include "app/options/open_session.h"
#include "app/options/shared_options.h"
#include "app/output/output.h"
#include "device/pair_pipeline.h"
#include "voxtact/area.h"
#include "voxtact/clearance.h"
#include "voxtact/data.h"
#include "voxtact/motion.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// What the parts of `voxtact detect` share: its options, what is read for it, and a row of what comes out.
namespace voxtact::app {

constexpr std::uint32_t kDefaultBatch = 1024;
/// Enough to keep a device busy while the host records; more only costs memory.
constexpr std::uint32_t kSubmissionsInFlight = 3;

/// What is asked for about distances, and about areas.
struct DistanceOptions {
    std::optional<double> margin; ///< mm
    std::optional<PoseTolerance> poseTolerance;
    bool clearance = false;
    std::optional<double> tolerance; ///< mm
    std::optional<double> maximum;   ///< mm
    std::filesystem::path closest;   ///< a file to write; empty: not asked for
    std::filesystem::path labels;    ///< another
    bool area = false;
    std::optional<double> areaTolerance; ///< mm^2
    std::filesystem::path labelAreas;    ///< a file to write
    std::filesystem::path triangleAreas; ///< a file to write
    std::vector<LabelWord> to;           ///< of `labels` and `labelAreas`; empty: all but 0
    bool toAnyOpacity = false;           ///< all of a label, not what is opaque of it

    /// With `clearance`.
    [[nodiscard]] ClearanceSearch search() const {
        ClearanceSearch asked;
        asked.tolerance = tolerance.value_or(asked.tolerance);
        asked.maximum = maximum.value_or(asked.maximum);
        return asked;
    }
    [[nodiscard]] bool any() const { return clearance || area || isMargin(); }
    /// With `area`: mm^2.
    [[nodiscard]] double areaGoal() const { return areaTolerance.value_or(kDefaultAreaTolerance); }
    /// Whether label by label is measured.
    [[nodiscard]] bool byLabel() const { return !labels.empty() || !labelAreas.empty(); }
    /// Whether it is one question, such as a device answers.
    [[nodiscard]] bool isOne() const {
        return !area && static_cast<int>(clearance) + static_cast<int>(margin.has_value()) +
                                static_cast<int>(poseTolerance.has_value()) ==
                            1;
    }
    /// Whether what is asked is not if a pose touches, but if it or something near does.
    [[nodiscard]] bool isMargin() const { return margin.has_value() || poseTolerance.has_value(); }
};

struct DetectOptions {
    std::vector<std::string> volumes; ///< as given; the jobs have each once
    MeshOptions meshes;
    std::filesystem::path jobsPath;
    PairJobs jobs; ///< set by resolveOptions()
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    MethodOptions method;
    DeviceChoice device;
    OutputOptions output;
    ChunkOptions chunks;
    ExtraOptions extra;
    DistanceOptions distance;
    std::string answer; ///< count, yes-no; empty: not said, count
    bool progress = true;
    bool timing = false;
    bool stats = false;
    std::optional<std::uint32_t> batch;
    std::uint32_t threads = 0; ///< 0: one for each processor

    /// A margin is kept, or it is not: that stops at the first proof, as yes-no does.
    [[nodiscard]] bool yesNo() const { return answer == "yes-no" || distance.isMargin(); }
    [[nodiscard]] std::uint32_t mostPairs() const { return batch.value_or(kDefaultBatch); }
    /// Whether the numbers of pose and triangle alone do not say which mesh and volume are meant.
    [[nodiscard]] bool hasSeveralJobs() const { return jobs.jobs.size() > 1; }
};

/// What is read before there is a device.
struct DetectInputs {
    std::vector<MeshData> meshes;
    std::vector<Box> bounds; ///< of the meshes, object space
    std::vector<ControlPoint> points;
    std::vector<PoseSource> poses;
    std::optional<Mat4> clip_from_world;
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
    std::vector<std::int32_t> measured; ///< what --label-clearance and --label-area are about; each once

    /// Of all jobs; nothing where standard input has not told yet.
    [[nodiscard]] std::optional<std::uint64_t> pairs(const PairJobs& jobs) const;
};

/// The answer for one pair.
struct Row {
    std::uint32_t job = 0;
    std::uint64_t pose = 0; ///< number in its file
    device::TimedAnswer timed;
    KeptExtra extra;
    std::optional<PairClearance> clearance; ///< with --clearance
    std::optional<PairArea> area;           ///< with --area
};

/// A contact, and whose it is.
struct KeptContact {
    Contact contact;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// A pair's world box, where a file of contacts is to have it.
struct KeptBounds {
    Box box;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// Decides what the options leave open: afterwards there are a projection and jobs. Refuses options that do not go
/// together.
[[nodiscard]] Result<void> resolveOptions(DetectOptions& options);

/// Whether a method and filter can answer in the projection conservative.
[[nodiscard]] bool canBeConservative(const MethodOptions& method);

/// Meshes, poses, camera, control points and labels; volumes are read one at a time, later.
[[nodiscard]] Result<DetectInputs> readDetectInputs(const DetectOptions& options);

/// Refuses a volume on another grid than the label map, where it is measured label by label.
[[nodiscard]] Result<void> checkMeasuredGrid(const DetectOptions& options, const DetectInputs& inputs,
                                             const Grid& volume);

/// What a volume is looked at with.
struct VolumeSettings {
    ValueRange domain;
    std::vector<ControlPoint> points;
    View view;
};

/// `values`: smallest and largest voxel. Says so where some lie outside the domain, and where nothing is opaque.
[[nodiscard]] VolumeSettings settingsFor(const DetectOptions& options, const DetectInputs& inputs, std::uint32_t volume,
                                         const VolumeData& data, const ValueRange& values);

/// Refuses a viewport beyond `most`, which is what `who` can do.
[[nodiscard]] Result<void> checkViewport(const VkExtent2D& size, const VkExtent2D& most, const std::string& who);

/// Bytes for the answers in addition to the counts of all batches in flight.
constexpr std::uint64_t kMostOutputBytes = std::uint64_t{256} << 20U;

/// Of the largest mesh.
[[nodiscard]] std::uint64_t mostTriangles(const DetectInputs& inputs);
/// Pairs of a batch or submission: as many as --batch says, or fewer where the answers in addition to the counts would
/// take too much memory. `copies` of them are in flight.
[[nodiscard]] std::uint32_t pairsPerBatch(const DetectOptions& options, const DetectInputs& inputs,
                                          std::uint32_t copies);

/// The name of a label; its number where it has none.
[[nodiscard]] std::string labelName(const DetectInputs& inputs, std::int32_t label);

} // namespace voxtact::app
