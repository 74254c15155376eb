// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/inputs.h"
#include "app/options/shared_options.h"
#include "voxtact/cpu.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What the parts of `voxtact plan` share.
namespace voxtact::app {

/// A label by its number, or by its name.
using LabelWord = std::string;

struct PlanOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction; ///< of the volume: what can be entered through
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::vector<LabelWord> avoid;
    std::string avoidVolume;                 ///< empty: the volume itself
    std::optional<std::string> avoidOpacity; ///< nothing: what is opaque is not avoided
    std::string target;                      ///< x,y,z or a label
    std::optional<Vec3> tip;
    std::optional<Vec3> axis;
    std::uint32_t entries = 10000;
    LabelWord entryLabel;
    std::optional<double> entryRadius; ///< mm
    std::optional<double> longest;     ///< mm
    std::optional<double> steepest;    ///< degrees
    double margin = 0;                 ///< mm
    double tolerance = kDefaultPlanTolerance;
    double maximum = kDefaultPlanMaximum;
    std::uint32_t threads = 0;
    bool summary = false;
    bool timing = false;
    std::filesystem::path surface; ///< a .ply file to write; empty: none
    std::filesystem::path report;  ///< an .html file to write; empty: none
    OutputOptions output;
};

/// A volume with its transfer function, on the host.
struct PlanVolume {
    cpu::Volume volume;
    cpu::TransferFunction transferFunction;
    ScalarType type{};
    ValueRange values; ///< of its voxels
};

/// What is read, and what of it is planned with.
struct PlanInputs {
    std::optional<PlanVolume> head;
    std::optional<PlanVolume> avoided;                  ///< what is opaque of it is an obstacle
    std::optional<cpu::TransferFunction> avoidedInHead; ///< the same of `head`
    std::optional<NamedLabels> labels;
    std::optional<cpu::Mesh> mesh;
    std::vector<cpu::PlanObstacle> obstacles; ///< refer to what is above
    cpu::PlanTask task;                       ///< refers to all of these
};

/// x,y,z; nothing where a text is not three finite numbers.
[[nodiscard]] std::optional<Vec3> parsePoint(const std::string& text);

/// Reads all of it. What comes out must not be moved: it refers to itself.
[[nodiscard]] Result<std::unique_ptr<PlanInputs>> readPlan(const PlanOptions& options);

/// The name of a label, or its number where it has none.
[[nodiscard]] std::string labelText(const NamedLabels& labels, std::int32_t label);

/// The rows, and what they are about. Refers to both.
[[nodiscard]] io::Table planTable(const PlanInputs& inputs, const PlanAnswer& answer, bool timing);
/// The triangles between the entries in colours, as PLY.
void writePlanSurface(std::ostream& out, const PlanAnswer& answer, bool certified, double maximum);
/// A page with the notes, the entries in colours, and the best paths.
void writePlanReport(std::ostream& out, const PlanInputs& inputs, const PlanAnswer& answer,
                     const std::vector<std::string>& notes, double maximum);

} // namespace voxtact::app
