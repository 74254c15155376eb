// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/scene.h"
#include "cli/options/open_session.h"
#include "cli/options/output_paths.h"
#include "cli/options/shared_options.h"
#include "cli/output/progress.h"

/// Arguments of the measuring commands for the lab.
namespace voxtact::app {

/// The command line that gives the same run, quoted for a shell; without the options in `without`.
[[nodiscard]] std::string commandLine(const CLI::App& parser, const std::vector<std::string>& without = {});
[[nodiscard]] lab::Provenance provenanceOf(const CLI::App& parser);
/// loadVolume() and loadMesh(), files as they are.
[[nodiscard]] lab::Loaders loaders();

/// A volume or mesh as the options say, in host memory.
[[nodiscard]] Result<lab::VolumePart> loadVolumePart(const std::string& source, const TransferFunctionOptions& options);
[[nodiscard]] Result<lab::MeshPart> loadMeshPart(const std::string& source, const MeshOptions& options);

/// --time-limit, in seconds; `seconds` has the default.
void addTimeLimit(CLI::App& parser, double& seconds, const std::string& help);

/// Steps on a bar of progress. Must outlive the use of steps().
class ShownSteps {
  public:
    ShownSteps(bool wanted, std::string title) : wanted_(wanted), title_(std::move(title)) {}
    [[nodiscard]] lab::Steps steps();

  private:
    bool wanted_;
    std::string title_;
    std::optional<Progress> progress_;
    std::uint64_t done_ = 0;
};

/// Opens the session of the device that the user chose, measures on it, and ends it; then says what the validation
/// layer found until its end. Nothing that `measure` leaves behind may be on the device.
[[nodiscard]] Outcome measureOn(const DeviceChoice& choice,
                                const std::function<Result<void>(const device::Session&)>& measure);

/// checkOutputs() of both; an empty output is standard output, and there may be no report.
[[nodiscard]] Result<void> checkReportPaths(const std::filesystem::path& output, const std::filesystem::path& report,
                                            const std::vector<NamedPath>& inputs);

} // namespace voxtact::app
