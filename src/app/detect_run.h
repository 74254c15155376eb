// SPDX-License-Identifier: MIT
#pragma once

#include "app/output.h"
#include "app/pair_pipeline.h"
#include "app/session.h"
#include "app/shared_options.h"
#include "voxtact/labels.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// What the parts of `voxtact detect` share: its options, what is read for it, and the two engines that answer.
namespace voxtact::app {

constexpr std::uint32_t kDefaultBatch = 1024;
constexpr std::uint32_t kDefaultMostContacts = 1U << 20U;

/// What is asked for beside the counts.
struct ExtraOptions {
    std::filesystem::path triangles; ///< files to write; empty: not asked for
    std::filesystem::path contacts;
    std::filesystem::path labels; ///< a label map to read
    std::filesystem::path labelNames;
    bool bounds = false;
    std::optional<double> maxDepth;
    std::optional<std::uint32_t> mostContacts;

    [[nodiscard]] Outputs outputs() const;
    [[nodiscard]] std::uint32_t contactRoom() const { return mostContacts.value_or(kDefaultMostContacts); }
};

struct DetectOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    MethodOptions method;
    DeviceChoice device;
    OutputOptions output;
    ExtraOptions extra;
    bool progress = false;
    bool timing = false;
    std::uint32_t batch = kDefaultBatch;
};

/// What is read before there is a device.
struct DetectInputs {
    std::vector<MeshData> meshes;
    std::vector<Box> bounds; ///< of the meshes, object space
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses;
    std::optional<Mat4> clip_from_world;
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
};

struct Row {
    std::uint32_t volume = 0;
    TimedAnswer timed;
    std::uint64_t triangles = 0; ///< touched ones
    std::uint64_t contacts = 0;  ///< found, kept or not
    double depth = 0;            ///< of the deepest contact that was kept, mm
    std::optional<Box> bounds;
    std::vector<LabelCount> labels;
};

struct DetectRun {
    std::vector<Row> rows;
    std::vector<TouchedTriangle> triangles; ///< `pair` is the number of the row
    std::vector<Contact> contacts;          ///< the same; at most ExtraOptions::contactRoom()
    std::uint64_t contactsFound = 0;
    double wallMilliseconds = 0;
    std::string device;
    std::string driver;
    std::vector<std::string> notes; ///< to be said once all has gone well: an error is one line
};

/// Decides what the options leave open: afterwards there is a projection. Refuses options that do not go together.
[[nodiscard]] Result<void> resolveOptions(DetectOptions& options);

/// Whether a method and filter can answer in the projection conservative.
[[nodiscard]] bool canBeConservative(const MethodOptions& method);

/// Meshes, poses, camera, control points and labels; volumes are read one at a time, later.
[[nodiscard]] Result<DetectInputs> readDetectInputs(const DetectOptions& options);

/// What a volume is looked at with.
struct VolumeSettings {
    ValueRange domain;
    std::vector<ControlPoint> points;
    View view;
};

/// `values`: smallest and largest voxel. Says so where some lie outside the domain.
[[nodiscard]] VolumeSettings settingsFor(const DetectOptions& options, const DetectInputs& inputs, std::uint32_t volume,
                                         const VolumeData& data, const ValueRange& values);

/// All pairs by a method of the session's device.
[[nodiscard]] Result<void> detectOnDevice(const DetectOptions& options, const DetectInputs& inputs,
                                          const Session& session, CountingMethod method, DetectRun& run);
/// All pairs by the host engine. No Vulkan.
[[nodiscard]] Result<void> detectOnHost(const DetectOptions& options, const DetectInputs& inputs, DetectRun& run);

/// Refuses a viewport beyond `most`, which is what `who` can do.
[[nodiscard]] Result<void> checkViewport(const VkExtent2D& size, const VkExtent2D& most, const std::string& who);

/// Bytes for the answers beside the counts of all batches in flight.
constexpr std::uint64_t kMostOutputBytes = std::uint64_t{256} << 20U;

/// Of the largest mesh.
[[nodiscard]] std::uint64_t mostTriangles(const DetectInputs& inputs);
/// Pairs of a batch or submission: as many as --batch says, or fewer where the answers beside the counts would take
/// too much memory. `copies` of them are in flight.
[[nodiscard]] std::uint32_t pairsPerBatch(const DetectOptions& options, const DetectInputs& inputs,
                                          std::uint32_t copies);

/// Writes the table of the rows and the files of triangles and contacts: all of them, or none.
[[nodiscard]] Result<void> writeDetectOutputs(const DetectOptions& options, const DetectInputs& inputs,
                                              const DetectRun& run);

/// The table of the rows. It refers to the arguments.
[[nodiscard]] Table makeDetectTable(const DetectOptions& options, const DetectInputs& inputs, const DetectRun& run);

/// The name of a label; its number where it has none.
[[nodiscard]] std::string labelName(const DetectInputs& inputs, std::int32_t label);

} // namespace voxtact::app
