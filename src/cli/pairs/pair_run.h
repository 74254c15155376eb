// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/given_settings.h"
#include "cli/options/open_session.h"
#include "cli/options/shard.h"
#include "cli/options/shared_options.h"
#include "cli/output/output.h"
#include "cli/pairs/enclosed.h"
#include "cli/pairs/extra_outputs.h"
#include "cli/pairs/pair_jobs.h"
#include "cli/pairs/pose_source.h"
#include "device/engine/pair_pipeline.h"
#include "voxtact/data.h"
#include "voxtact/named_questions.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Options, inputs and rows of the pair subcommands. A pair is a mesh at a pose and a volume.
namespace voxtact::app {

constexpr std::uint32_t kDefaultBatch = 1024;
/// Batches in flight: keeps a device busy while the host records; more would only cost memory.
constexpr std::uint32_t kSubmissionsInFlight = 3;

/// Options of `touch` alone.
struct TouchOptions {
    std::optional<double> margin; ///< mm
    std::optional<PoseTolerance> uncertainty;
    bool solid = false; ///< the inside of the mesh, too
};

/// Options of the measuring questions.
struct MeasureOptions {
    GivenSettings settings;
    std::filesystem::path witness{};   ///< output file; empty: none
    std::filesystem::path triangles{}; ///< output file; empty: none
    bool fillHoles = false;            ///< of meshes
};

struct PairOptions {
    explicit PairOptions(const NamedQuestion& asked) : question(asked), measure{.settings = {.question = asked.name}} {}

    NamedQuestion question;
    std::vector<std::string> volumes; ///< as given; the jobs list each once
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
    std::optional<std::uint32_t> batch;
    std::uint32_t threads = 0; ///< 0: one per processor

    [[nodiscard]] bool isTouch() const { return question.name == "touch"; }
    [[nodiscard]] bool isCount() const { return question.name == "count"; }
    /// Returns true if each row is a label of a pair.
    [[nodiscard]] bool byLabel() const { return !measure.settings.labels.empty(); }
    /// Returns true if the inside of the meshes counts.
    [[nodiscard]] bool isSolid() const {
        return question.needsSolid || touch.solid || measure.settings.number("solid") == 1;
    }
    [[nodiscard]] std::uint32_t maxPairs() const { return batch.value_or(kDefaultBatch); }
    /// Returns true if the pose index does not identify a pair.
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
    std::vector<std::int32_t> measured; ///< numbers of GivenSettings::labels; each once
    std::vector<char> isResampled;      ///< of each volume, once it has been read

    /// Number of pairs of all jobs; empty while standard input is open.
    [[nodiscard]] std::optional<std::uint64_t> pairs(const PairJobs& jobs) const;
};

/// A row of an answer's table: a pair, or one of its labels or bands.
struct Measured {
    std::shared_ptr<const AnswerTable> table;
    std::size_t row = 0;
    Bounds bounds; ///< as printed
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

/// A row with the witness points of a pair.
struct KeptClosest {
    Measured measured;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// Completes the options: sets projection and jobs. Refuses options that exclude each other.
[[nodiscard]] Result<void> resolveOptions(PairOptions& options);

/// Returns true if a method and filter support the projection certified.
[[nodiscard]] bool canBeCertified(const MethodOptions& method);

/// Returns true if the host engine answers.
[[nodiscard]] bool isForHost(const PairOptions& options);

/// Reads meshes, poses, camera, control points and labels; volumes are read one at a time, later.
[[nodiscard]] Result<PairInputs> readPairInputs(const PairOptions& options);

/// Returns the label map on the grid of a volume, if rows are labels and the map covers a part of that grid; empty if
/// the map fits unchanged. Refuses other grids if rows are labels.
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

/// Returns the number of triangles of the largest mesh.
[[nodiscard]] std::uint64_t maxTriangles(const PairInputs& inputs);
/// Returns the number of pairs per batch or submission: --batch, or fewer if their outputs would take too much memory.
/// `copies` of them are in flight.
[[nodiscard]] std::uint32_t pairsPerBatch(const PairOptions& options, const PairInputs& inputs, std::uint32_t copies);

/// Returns the name of a label, or its number if it has none.
[[nodiscard]] std::string labelName(const PairInputs& inputs, std::int32_t label);

/// Runs a pair subcommand.
[[nodiscard]] Outcome runPairs(PairOptions options);

} // namespace voxtact::app
