// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/inputs.h"
#include "cli/options/label_words.h"
#include "cli/options/output_paths.h"
#include "cli/options/shard.h"
#include "cli/options/shared_options.h"
#include "voxtact/cpu.h"

#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Common parts of `voxtact plan`.
namespace CLI {
class App;
} // namespace CLI

namespace voxtact::app {

struct PlanOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction; ///< of the volume; its opaque region has the entries
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::vector<LabelWord> avoid;
    std::string avoidVolume;                 ///< empty: the volume itself
    std::optional<std::string> avoidOpacity; ///< empty: no opaque obstacle
    std::string space;                       ///< of points: lps or ras; empty: not given
    std::vector<std::string> targets;        ///< x,y,z or a label each
    std::vector<LabelWord> targetLabels;     ///< follow `targets`
    std::filesystem::path targetFile;        ///< follows `targetLabels`; one target per line; empty: none
    std::optional<Vec3> tip;
    std::optional<Vec3> axis;
    std::uint32_t entries = 10000;
    LabelWord entryLabel;
    std::optional<double> entryRadius; ///< mm
    bool borderEntries = false;
    std::optional<double> longest;  ///< mm
    std::optional<double> steepest; ///< degrees
    double margin = 0;              ///< mm
    double tolerance = kDefaultPlanTolerance;
    std::optional<double> maximum; ///< mm; empty: planMaximum()
    std::uint32_t threads = 0;
    bool summary = false;
    bool timing = false;
    bool resample = false;
    bool progress = true;
    std::filesystem::path byTarget; ///< CSV file to write; empty: none
    std::filesystem::path surface;  ///< .ply file to write; empty: none
    std::filesystem::path heatMap;  ///< volume file to write; empty: none
    std::filesystem::path picture;  ///< .png file to write; empty: none
    VkExtent2D half{512, 512};      ///< size of each of the picture's two halves
    bool sizeGiven = false;
    DeviceChoice device;
    std::filesystem::path report; ///< .html file to write; empty: none
    Shard shard;                  ///< of the targets
    OutputOptions output;
};

/// A volume with its transfer function, on the host.
struct PlanVolume {
    cpu::Volume volume;
    cpu::TransferFunction transferFunction;
    ScalarType type{};
    ValueRange values; ///< of its voxels
    bool isResampled = false;
};

/// A target of the tip.
struct PlanTarget {
    std::string name; ///< of a label or of a line in a file; else the number of the target, from 1
    Vec3 at{};        ///< world mm
};

/// A target's plan.
struct TargetPlan {
    PlanTarget target;
    PlanAnswer answer;
};

/// A path of one of several plans.
struct ChosenPath {
    const TargetPlan* plan = nullptr; ///< null: no path
    const PlannedPath* path = nullptr;
};

/// Inputs of plans.
struct PlanInputs {
    std::optional<PlanVolume> head;
    std::optional<PlanVolume> avoided;                  ///< volume whose opaque region is an obstacle
    std::optional<cpu::TransferFunction> avoidedInHead; ///< transfer function of an obstacle in `head`
    std::optional<NamedLabels> labels;
    std::optional<cpu::Mesh> mesh;
    std::optional<VolumeData> shown;          ///< for a picture: source of `head`
    std::optional<MeshData> shownMesh;        ///< for a picture: source of `mesh`
    std::vector<cpu::PlanObstacle> obstacles; ///< reference the members above
    std::vector<PlanTarget> targets;          ///< unique names; never empty
    std::optional<bool> isResampled;          ///< true if a volume was resampled; empty: without --resample
    cpu::Plan task;                           ///< references the members above; its target is the first
    std::vector<std::string> notes;           ///< printed after success: an error is one line
};

void addPlanOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options);

/// Parses x,y,z; empty if the text is not three finite numbers.
[[nodiscard]] std::optional<Vec3> parsePoint(const std::string& text);

/// Returns the inputs of a plan, which outputs must not overwrite.
[[nodiscard]] std::vector<NamedPath> planReads(const PlanOptions& options);
/// Returns the outputs of a plan, without the files per target.
[[nodiscard]] std::vector<NamedPath> planWrites(const PlanOptions& options);
/// Reads all inputs. The result must not be moved: it references itself.
[[nodiscard]] Result<std::unique_ptr<PlanInputs>> readPlan(const PlanOptions& options);
/// Sets the targets; volume and labels must be read.
[[nodiscard]] Result<void> readTargets(const PlanOptions& options, PlanInputs& inputs);

/// Returns a maximum in mm that distinguishes the best paths: twice the largest distance in a sample of directions and
/// targets. All shards of a run get the same maximum.
[[nodiscard]] Result<double> planMaximum(const PlanOptions& options, const PlanInputs& inputs);

/// Plans for one of the targets.
[[nodiscard]] Result<TargetPlan> planFor(const PlanInputs& inputs, std::size_t target, cpu::HostEngine& engine);

/// Returns the best safe paths of all plans, at most `max`.
[[nodiscard]] std::vector<ChosenPath> rankedPaths(std::span<const TargetPlan> plans, std::size_t max);
/// Returns the notes on plans: number of safe paths, area, best path.
[[nodiscard]] std::vector<std::string> planNotes(const PlanInputs& inputs, std::span<const TargetPlan> plans);

[[nodiscard]] std::vector<std::string> targetNames(const PlanInputs& inputs);

/// A file per target; its path may have {target}.
struct TargetFile {
    std::string option;
    std::filesystem::path path;
    std::string ending;
    std::function<Result<void>(std::ostream&, const TargetPlan&)> write;
};
/// Returns the requested files. They reference both arguments.
[[nodiscard]] std::vector<TargetFile> targetFiles(const PlanOptions& options, const PlanInputs& inputs);
/// Refuses endings, grids that a file cannot hold, one file for several targets, and files that are read.
[[nodiscard]] Result<void> checkTargetFiles(const PlanOptions& options, const PlanInputs& inputs);

/// JSON has the rows of targetTable() behind these as "by_target".
void writePlanTable(std::ostream& out, const PlanOptions& options, const PlanInputs& inputs,
                    std::span<const TargetPlan> plans);
/// Writes targetTable() as CSV.
void writeTargetTable(std::ostream& out, const PlanOptions& options, const PlanInputs& inputs,
                      std::span<const TargetPlan> plans);
/// Returns one row per path. References both arguments.
[[nodiscard]] io::Table planTable(const PlanInputs& inputs, std::span<const TargetPlan> plans, bool timing);
/// Returns one row per plan. References both arguments.
[[nodiscard]] io::Table targetTable(const PlanInputs& inputs, std::span<const TargetPlan> plans);
/// Writes the coloured triangles between the entries as PLY.
void writePlanSurface(std::ostream& out, const PlanAnswer& answer, bool certified, double maximum);
/// Returns a float volume: the certified distance, mm, of all paths that enter through a voxel; -1 without a path. If
/// not `certified` (paths of a mesh), each path is in the voxel of its entry.
[[nodiscard]] VolumeData planHeatMap(const Grid& grid, const PlanAnswer& answer, bool certified);
/// Returns the ending of a volume file; empty if it is unknown.
[[nodiscard]] std::string volumeEnding(const std::filesystem::path& path);
/// Writes an HTML page with notes, best paths, and the coloured entries of each target. `png`: an embedded picture;
/// empty: none.
void writePlanReport(std::ostream& out, const PlanInputs& inputs, std::span<const TargetPlan> plans, double maximum,
                     std::string_view png);

} // namespace voxtact::app
