// SPDX-License-Identifier: MIT
// Files per target.
#include "cli/output/target_path.h"
#include "cli/plan/plan_run.h"
#include "core/base/try.h"
#include "voxtact/io.h"

#include <cstddef>
#include <ostream>

namespace voxtact::app {

namespace {

/// Checks ending and format limits before the work.
Result<void> checkHeatMap(const std::filesystem::path& path, const Grid& grid) {
    if (volumeEnding(path).empty()) {
        return badArgument("--heat-map: the ending of '" + path.string() + "' must be .nii.gz, .nii, .nrrd or .mha");
    }
    const std::vector<std::byte> voxels(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]);
    std::ostream nowhere(nullptr);
    return io::writeVolume(nowhere, path, {grid, ScalarType::UInt8, voxels});
}

} // namespace

std::vector<std::string> targetNames(const PlanInputs& inputs) {
    std::vector<std::string> names;
    for (const PlanTarget& target : inputs.targets) {
        names.push_back(target.name);
    }
    return names;
}

std::vector<TargetFile> targetFiles(const PlanOptions& options, const PlanInputs& inputs) {
    std::vector<TargetFile> files;
    if (!options.surface.empty()) {
        files.push_back(
            {"--surface", options.surface, ".ply", [&](std::ostream& out, const TargetPlan& plan) -> Result<void> {
                 writePlanSurface(out, plan.answer, !inputs.task.mesh, *options.maximum);
                 return {};
             }});
    }
    if (!options.heatMap.empty()) {
        files.push_back({"--heat-map", options.heatMap, volumeEnding(options.heatMap),
                         [&](std::ostream& out, const TargetPlan& plan) {
                             const VolumeData map =
                                 planHeatMap(inputs.head->volume.grid(), plan.answer, !inputs.task.mesh);
                             return io::writeVolume(out, options.heatMap, map.view());
                         }});
    }
    return files;
}

Result<void> checkTargetFiles(const PlanOptions& options, const PlanInputs& inputs) {
    if (!options.heatMap.empty()) {
        VOXTACT_TRY(checkHeatMap(options.heatMap, inputs.head->volume.grid()));
    }
    const std::vector<std::string> names = targetNames(inputs);
    std::vector<NamedPath> paths = planWrites(options);
    for (const TargetFile& file : targetFiles(options, inputs)) {
        VOXTACT_TRY(checkTargetPaths(file.option, file.path, names));
        const auto [first, end] = options.shard.range(names.size());
        for (std::uint64_t target = first; target < end; ++target) {
            paths.push_back({file.option, targetPath(file.path, names[target])});
        }
    }
    return checkOutputs(paths, planReads(options));
}

} // namespace voxtact::app
