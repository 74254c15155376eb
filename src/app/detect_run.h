// SPDX-License-Identifier: MIT
#pragma once

#include "app/output.h"
#include "app/pair_pipeline.h"
#include "app/session.h"
#include "app/shared_options.h"

#include <optional>
#include <string>
#include <vector>

/// What the parts of `voxtact detect` share: its options, what is read for it, and the two engines that answer.
namespace voxtact::app {

constexpr std::uint32_t kDefaultBatch = 1024;

struct DetectOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    MethodOptions method;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    bool timing = false;
    std::uint32_t batch = kDefaultBatch;
};

/// What is read before there is a device.
struct DetectInputs {
    std::vector<MeshData> meshes;
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses;
    std::optional<Mat4> clip_from_world;
};

struct Row {
    std::uint32_t volume = 0;
    TimedAnswer timed;
};

struct DetectRun {
    std::vector<Row> rows;
    double wallMilliseconds = 0;
    std::string device;
    std::string driver;
    std::vector<std::string> notes; ///< to be said once all has gone well: an error is one line
};

/// Meshes, poses, camera and control points; volumes are read one at a time, later.
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

/// The table of the rows. It refers to both arguments.
[[nodiscard]] Table makeDetectTable(const DetectOptions& options, const DetectRun& run);

} // namespace voxtact::app
