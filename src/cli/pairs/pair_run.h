// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/label_words.h"
#include "cli/options/open_session.h"
#include "cli/options/shard.h"
#include "cli/options/shared_options.h"
#include "cli/output/output.h"
#include "cli/pairs/enclosed.h"
#include "cli/pairs/extra_outputs.h"
#include "cli/pairs/pair_jobs.h"
#include "cli/pairs/pose_source.h"
#include "device/engine/pair_pipeline.h"
#include "voxtact/area.h"
#include "voxtact/data.h"
#include "voxtact/distance.h"
#include "voxtact/motion.h"
#include "voxtact/overlap.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// The subcommands that ask one question about pairs of a mesh at a pose and a volume: their options, inputs and rows.
namespace voxtact::app {

enum class Question { Touch, Count, Distance, Area, Overlap };
/// The subcommand: "touch", "count", "distance", "area", "overlap".
[[nodiscard]] const char* toString(Question question) noexcept;

constexpr std::uint32_t kDefaultBatch = 1024;
/// Enough to keep a device busy while the host records; more only costs memory.
constexpr std::uint32_t kSubmissionsInFlight = 3;

/// Options of `touch` alone.
struct TouchOptions {
    std::optional<double> margin; ///< mm
    std::optional<PoseTolerance> uncertainty;
};

/// Options of `distance`, `area` and `overlap`.
struct MeasureOptions {
    double tolerance = 0;                                     ///< mm, mm^2 or mm^3
    double maximum = std::numeric_limits<double>::infinity(); ///< mm
    std::filesystem::path witness;                            ///< output file; empty: none
    std::filesystem::path triangles;                          ///< output file; empty: none
    std::vector<LabelWord> labels;                            ///< a row each; empty: one row a pair
    bool anyOpacity = false;                                  ///< the whole label, opaque or not
    std::vector<double> bands;                                ///< limits of values, ascending: a row a band
    bool fillHoles = false;                                   ///< of meshes
};

struct PairOptions {
    explicit PairOptions(Question asked) : question(asked) {}

    Question question;
    std::vector<std::string> volumes; ///< as given; the jobs have each once
    MeshOptions meshes;
    PairJobs jobs; ///< set by resolveOptions()
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    LabelOptions labels;
    std::string engine; ///< host, device; empty: not given
    MethodOptions method;
    DeviceChoice device;
    OutputOptions output;
    Shard shard;
    TouchOptions touch;
    ExtraOptions extra; ///< of `count`
    MeasureOptions measure;
    bool progress = true;
    bool resample = false;
    bool timing = false;
    bool stats = false;
    bool summary = false;
    bool solid = false; ///< the inside of the mesh, too
    std::optional<std::uint32_t> batch;
    std::uint32_t threads = 0; ///< 0: one for each processor

    [[nodiscard]] bool measures() const { return question >= Question::Distance; }
    /// True if a row is a label of a pair.
    [[nodiscard]] bool byLabel() const { return !measure.labels.empty(); }
    [[nodiscard]] std::uint32_t maxPairs() const { return batch.value_or(kDefaultBatch); }
    /// True if the index of the pose does not identify a pair.
    [[nodiscard]] bool hasSeveralJobs() const { return jobs.jobs.size() > 1; }
};

/// Inputs, read before a device is opened.
struct PairInputs {
    std::vector<MeshData> meshes;
    std::vector<Box> bounds; ///< of the meshes, object space
    std::vector<ControlPoint> points;
    std::optional<PoseSource> poses; ///< of every job
    std::optional<Mat4> clip_from_world;
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
    std::vector<std::int32_t> measured; ///< numbers of MeasureOptions::labels; each once
    std::vector<char> isResampled;      ///< of each volume, once it has been read

    /// Number of pairs of all jobs; empty while standard input is open.
    [[nodiscard]] std::optional<std::uint64_t> pairs(const PairJobs& jobs) const;
};

/// Bounds of a distance, an area or a volume, rounded outward to the digits that are printed.
struct Measured {
    std::int32_t label = 0; ///< with PairOptions::byLabel()
    double lower = 0;       ///< mm, mm^2 or mm^3
    double upper = 0;
    Containment inside{};   ///< of `overlap`
    Bounds solid{};         ///< of `overlap`: volume of the mesh
    std::uint32_t band = 0; ///< with MeasureOptions::bands
};

/// The answer for one pair.
struct Row {
    std::uint32_t job = 0;
    std::uint64_t pose = 0; ///< number in its file
    device::TimedAnswer timed;
    KeptExtra extra;
    std::optional<WitnessPoint> witness; ///< of `touch`
    std::vector<Measured> measured{};    ///< of the questions that measure: one, or one a label or band
};

/// A contact of a pair.
struct KeptContact {
    Contact contact;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// A pair's world box, for a file of contacts.
struct KeptBounds {
    Box box;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// The witness points of a pair's distance.
struct KeptClosest {
    WitnessPoints closest;
    double upper = 0; ///< mm
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// Decides what the options leave open: afterwards there are a projection and jobs. Refuses options that exclude each
/// other.
[[nodiscard]] Result<void> resolveOptions(PairOptions& options);

/// Returns true if a method and filter support the projection certified.
[[nodiscard]] bool canBeCertified(const MethodOptions& method);

/// Returns true if the host engine answers.
[[nodiscard]] bool isForHost(const PairOptions& options);

/// Reads meshes, poses, camera, control points and labels; volumes are read one at a time, later.
[[nodiscard]] Result<PairInputs> readPairInputs(const PairOptions& options);

/// The label map on the grid of a volume, where a row is a label and the map is on a part of that grid; none where the
/// map serves as it is. Refuses other grids where a row is a label.
[[nodiscard]] Result<std::optional<LabelData>> measuredLabels(const PairOptions& options, const PairInputs& inputs,
                                                              const Grid& volume);

/// Sampling of a volume.
struct VolumeSettings {
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;
    std::vector<ControlPoint> points;
    View view;
    OpaqueVoxels opaque;
};

/// `values`: smallest and largest voxel. Notes values outside the domain, and a volume without an opaque voxel.
[[nodiscard]] VolumeSettings settingsFor(const PairOptions& options, const PairInputs& inputs, std::uint32_t volume,
                                         const VolumeData& data, const ValueRange& values);

/// Refuses a viewport beyond `max`, the limit of `who`.
[[nodiscard]] Result<void> checkViewport(const VkExtent2D& size, const VkExtent2D& max, const std::string& who);

/// Bytes for the outputs of all batches in flight.
constexpr std::uint64_t kMaxOutputBytes = std::uint64_t{256} << 20U;

/// Triangles of the largest mesh.
[[nodiscard]] std::uint64_t maxTriangles(const PairInputs& inputs);
/// Returns the number of pairs per batch or submission: --batch, or fewer if their outputs would take too much memory.
/// `copies` of them are in flight.
[[nodiscard]] std::uint32_t pairsPerBatch(const PairOptions& options, const PairInputs& inputs, std::uint32_t copies);

/// The name of a label; its number where it has none.
[[nodiscard]] std::string labelName(const PairInputs& inputs, std::int32_t label);

/// Runs a subcommand of this kind.
[[nodiscard]] Outcome runPairs(PairOptions options);

} // namespace voxtact::app
