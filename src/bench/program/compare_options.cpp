// SPDX-License-Identifier: MIT
#include "bench/program/compare_options.h"

#include "bench/program/lab_run.h"
#include "cli/make/poses.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

namespace voxtact::app {

using namespace lab;

namespace {

std::vector<std::string> partsOf(const std::string& list) {
    std::vector<std::string> parts;
    std::istringstream stream(list);
    for (std::string part; std::getline(stream, part, ',');) {
        parts.push_back(part);
    }
    return parts;
}

std::string methodNames() {
    std::string names;
    for (const CountingMethod method : countingMethods()) {
        names += (names.empty() ? "" : ", ") + std::string(toString(method));
    }
    return names;
}

void readMethods(const std::string& list, std::vector<CountingMethod>& methods) {
    methods.clear();
    for (const std::string& name : partsOf(list)) {
        const std::optional<CountingMethod> method = countingMethodFromName(name);
        if (!method) {
            throw CLI::ValidationError("--methods", "'" + name + "' is unknown; choose from: " + methodNames());
        }
        if (std::find(methods.begin(), methods.end(), *method) == methods.end()) {
            methods.push_back(*method);
        }
    }
    if (methods.empty()) {
        throw CLI::ValidationError("--methods", "no method; choose from: " + methodNames());
    }
}

void readSweep(const std::string& name, CompareOptions& options) {
    options.sweepsGiven = true;
    options.settings.sweeps.clear();
    for (const Sweep sweep : kSweeps) {
        if (name == "all" || name == toString(sweep)) {
            options.settings.sweeps.push_back(sweep);
        }
    }
    if (options.settings.sweeps.empty() && name != "none") {
        throw CLI::ValidationError(
            "--sweep", "'" + name + "' is unknown; choose from: batch, triangles, fragments, voxels, all, none");
    }
}

void addPoseOptions(CLI::App& parser, CompareOptions& options) {
    parser.get_option("--poses")->description("4x4 matrices, 16 numbers per line; default: random");
    addWholeNumber(
        parser, "--number", [&options](std::uint32_t number) { options.number = number; },
        {.least = 1, .most = kMostPoses}, "number of random poses", options.number);
    addSeed(parser, options.seed);
    parser.get_option("--number")->excludes("--poses");
    parser.get_option("--seed")->excludes("--poses");
    addWholeNumber(
        parser, "--only-pose", [&options](std::uint32_t pose) { options.onlyPose = pose; }, {},
        "compare only this pose, by its index", std::nullopt);
}

} // namespace

void addCompareOptions(CLI::App& parser, CompareOptions& options) {
    addVolumeOption(parser, options.volumes);
    addMeshOptions(parser, options.meshes);
    addTransferFunctionOptions(parser, options.transferFunction);
    addTableOptions(parser, options.transferFunction);
    addPosesOptions(parser, options.view);
    addCameraOptions(parser, options.view);
    addPoseOptions(parser, options);
    options.settings.sweeps = {Sweep::Batch};
    parser
        .add_option_function<std::string>(
            "--methods", [&options](const std::string& list) { readMethods(list, options.settings.methods); },
            methodNames() + "; default: all")
        ->type_name("LIST");
    addWholeNumber(parser, "--oracle", options.settings.oraclePoses, 0,
                   "poses whose fragments are checked against the oracle");
    parser
        .add_option_function<std::string>(
            "--sweep", [&options](const std::string& name) { readSweep(name, options); },
            "batch, triangles, fragments, voxels, all, none; default: batch; with --report: all")
        ->type_name("NAME");
    addWholeNumber(parser, "--repetitions", options.settings.repeats, 1, "samples per time, after a warm-up");
    addTimeLimit(parser, options.settings.timeLimit,
                 "time for the samples of a sweep, seconds; may reduce --repetitions");
    parser.add_flag("--keep-going", options.settings.keepGoing,
                    "after a disagreement, time the methods and write outputs; exit status 3");
    CLI::Option* localize =
        parser.add_flag("--localize", options.localize, "compare methods that find touched triangles instead");
    addPath(parser, "--report", options.report, "HTML page of tables");
    for (const char* other : {"--methods", "--oracle", "--sweep", "--report"}) {
        localize->excludes(other);
    }
    addDeviceOptions(parser, options.device);
    addOutputOptions(parser, options.output);
    addProgressOption(parser, options.progress);
    for (const char* rare : {"--camera", "--seed", "--only-pose", "--time-limit", "--keep-going"}) {
        setRare(parser, rare);
    }
}

} // namespace voxtact::app
