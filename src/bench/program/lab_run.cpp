// SPDX-License-Identifier: MIT
#include "bench/program/lab_run.h"

#include "cli/options/inputs.h"
#include "cli/options/shared_options.h"
#include "cli/version.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::app {

using namespace lab;

namespace {

std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string_view("_-./:=,+@%").find(static_cast<char>(c)) != std::string::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) {
        return word;
    }
    std::string out = "'";
    for (const char c : word) {
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}

} // namespace

std::string commandLine(const CLI::App& parser, const std::vector<std::string>& without) {
    std::string line = "voxtact " + parser.get_name();
    for (const CLI::Option* option : parser.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || std::find(without.begin(), without.end(), name) != without.end()) {
            continue;
        }
        if (option->get_items_expected_max() == 0) {
            line += " " + name;
            continue;
        }
        for (const std::string& value : option->results()) {
            line += " " + name + " " + quoted(value);
        }
    }
    return line;
}

Provenance provenanceOf(const CLI::App& parser) {
    return {programVersion(), gitRevision(), commandLine(parser)};
}

Loaders loaders() {
    return {[](const std::string& source) { return loadVolume(source); },
            [](const std::string& source) { return loadMesh(source, {}); }};
}

Result<VolumePart> loadVolumePart(const std::string& source, const TransferFunctionOptions& options) {
    Result<std::vector<ControlPoint>> points = loadControlPoints(options);
    VOXTACT_TRY(points);
    Result<VolumeData> data = loadVolume(source);
    VOXTACT_TRY(data);
    const Result<ValueRange> range = checkVolume(data->view());
    VOXTACT_TRY(range);
    VolumePart part;
    part.name = source;
    part.domain = tableDomain(options, data->type, *range);
    part.points = points->empty() ? defaultRamp(part.domain) : std::move(*points);
    part.tableSize = tableSizeFor(options, data->type);
    part.threshold = options.threshold;
    part.data = std::move(*data);
    return part;
}

Result<MeshPart> loadMeshPart(const std::string& source, const MeshOptions& options) {
    Result<MeshData> data = loadMesh(source, options);
    VOXTACT_TRY(data);
    return MeshPart{.name = source, .data = std::move(*data)};
}

void addTimeLimit(CLI::App& parser, double& seconds, const std::string& help) {
    addNumber(
        parser, "--time-limit", [&seconds](double value) { seconds = value; }, help,
        [](double value) { return value > 0; }, "above 0", std::to_string(std::llround(seconds)).c_str());
}

Steps ShownSteps::steps() {
    return {[this](std::uint64_t total) { progress_.emplace(wanted_, title_, total); },
            [this](std::uint64_t steps) { progress_->update(done_ += steps); },
            [this](const std::string& what) { progress_->doing(what); }};
}

Outcome measureOn(const DeviceChoice& choice, const std::function<Result<void>(const device::Session&)>& measure) {
    std::shared_ptr<const device::ValidationMessages> messages;
    {
        const Result<device::Session> session = openSession(choice);
        VOXTACT_TRY(session);
        messages = session->instance.messages();
        VOXTACT_TRY(measure(*session));
    }
    return validationOutcome(*messages);
}

Result<void> checkReportPaths(const std::filesystem::path& output, const std::filesystem::path& report,
                              const std::vector<NamedPath>& inputs) {
    return checkOutputs({{"--output", output.empty() ? "-" : output}, {"--report", report}}, inputs);
}

} // namespace voxtact::app
