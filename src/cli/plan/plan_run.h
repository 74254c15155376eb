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
    TransferFunctionOptions transferFunction; ///< of the volume: what can be entered through
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::vector<LabelWord> avoid;
    std::string avoidVolume;                 ///< empty: the volume itself
    std::optional<std::string> avoidOpacity; ///< empty: no opaque obstacle
    std::string space;                       ///< of points: lps or ras; empty: not given
    std::vector<std::string> targets;        ///< x,y,z or a label each
    std::vector<LabelWord> targetLabels;     ///< after them: labels
    std::filesystem::path targetFile;        ///< after these: a line each; empty: none
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
    std::optional<double> maximum; ///< mm; nothing: planMaximum()
    std::uint32_t threads = 0;
    bool summary = false;
    bool timing = false;
    bool resample = false;
    bool progress = true;
    std::filesystem::path byTarget; ///< a CSV file to write; empty: none
    std::filesystem::path surface;  ///< a .ply file to write; empty: none
    std::filesystem::path heatMap;  ///< a volume to write; empty: none
    std::filesystem::path picture;  ///< a .png file to write; empty: none
    VkExtent2D half{512, 512};      ///< size of each of the picture's two halves
    bool sizeGiven = false;
    DeviceChoice device;
    std::filesystem::path report; ///< an .html file to write; empty: none
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
    std::string name; ///< a label's, or a line's of a file; else its number among all, from 1
    Vec3 at{};        ///< world mm
};

/// A target's plan.
struct TargetPlan {
    PlanTarget target;
    PlanAnswer answer;
};

/// A path of one of several plans.
struct ChosenPath {
    const TargetPlan* plan = nullptr; ///< null: there is none
    const PlannedPath* path = nullptr;
};

/// Inputs of plans.
struct PlanInputs {
    std::optional<PlanVolume> head;
    std::optional<PlanVolume> avoided;                  ///< volume whose opaque region is an obstacle
    std::optional<cpu::TransferFunction> avoidedInHead; ///< the same of `head`
    std::optional<NamedLabels> labels;
    std::optional<cpu::Mesh> mesh;
    std::optional<VolumeData> shown;          ///< for a picture: source of `head`
    std::optional<MeshData> shownMesh;        ///< for a picture: source of `mesh`
    std::vector<cpu::PlanObstacle> obstacles; ///< reference the members above
    std::vector<PlanTarget> targets;          ///< of different names; never none
    std::optional<bool> isResampled;          ///< one of the volumes; nothing: not to be told
    cpu::Plan task;                           ///< refers to all of these; its target is the first
    std::vector<std::string> notes;           ///< printed after success: an error is one line
};

void addPlanOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options);

/// x,y,z; nothing where a text is not three finite numbers.
[[nodiscard]] std::optional<Vec3> parsePoint(const std::string& text);

/// Returns the inputs of a plan, which outputs must not overwrite.
[[nodiscard]] std::vector<NamedPath> planReads(const PlanOptions& options);
/// Returns the outputs of a plan, without the files per target.
[[nodiscard]] std::vector<NamedPath> planWrites(const PlanOptions& options);
/// Reads all inputs. The result must not be moved: it references itself.
[[nodiscard]] Result<std::unique_ptr<PlanInputs>> readPlan(const PlanOptions& options);
/// Sets where tips go; volume and labels are read.
[[nodiscard]] Result<void> readTargets(const PlanOptions& options, PlanInputs& inputs);

/// Returns a maximum in mm that distinguishes the best paths: twice the largest distance along some directions from
/// some of the targets, the same for every part of a run.
[[nodiscard]] Result<double> planMaximum(const PlanOptions& options, const PlanInputs& inputs);

/// Plans for one of the targets.
[[nodiscard]] Result<TargetPlan> planFor(const PlanInputs& inputs, std::size_t target, cpu::HostEngine& engine);

/// Returns the best safe paths of all plans, at most this number.
[[nodiscard]] std::vector<ChosenPath> rankedPaths(std::span<const TargetPlan> plans, std::size_t most);
/// Returns the notes on plans: number of safe paths, area, best path.
[[nodiscard]] std::vector<std::string> planNotes(const PlanInputs& inputs, std::span<const TargetPlan> plans);

[[nodiscard]] std::vector<std::string> targetNames(const PlanInputs& inputs);

/// A file of which each target has one: its path may have {target} in it.
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
/// targetTable() as CSV.
void writeTargetTable(std::ostream& out, const PlanOptions& options, const PlanInputs& inputs,
                      std::span<const TargetPlan> plans);
/// The rows, and what they are about. Refers to both.
[[nodiscard]] io::Table planTable(const PlanInputs& inputs, std::span<const TargetPlan> plans, bool timing);
/// A row for each plan. Refers to both.
[[nodiscard]] io::Table targetTable(const PlanInputs& inputs, std::span<const TargetPlan> plans);
/// The triangles between the entries in colours, as PLY.
void writePlanSurface(std::ostream& out, const PlanAnswer& answer, bool certified, double maximum);
/// The entries on a grid, as float: mm that every path which enters through a voxel certainly keeps; -1 where none
/// does. Not `certified`: of a mesh's paths, each in the voxel of its entry.
[[nodiscard]] VolumeData planHeatMap(const Grid& grid, const PlanAnswer& answer, bool certified);
/// The ending by which a file of volumes is known; empty: it has none of these.
[[nodiscard]] std::string volumeEnding(const std::filesystem::path& path);
/// A page with the notes, the best paths, and for each target the entries in colours.
/// `png`: the content of a picture that is in it; empty: there is none.
void writePlanReport(std::ostream& out, const PlanInputs& inputs, std::span<const TargetPlan> plans, double maximum,
                     std::string_view png);

} // namespace voxtact::app
