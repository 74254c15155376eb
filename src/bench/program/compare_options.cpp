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
            throw CLI::ValidationError("--methods", "'" + name + "' is not known; there are: " + methodNames());
        }
        if (std::find(methods.begin(), methods.end(), *method) == methods.end()) {
            methods.push_back(*method);
        }
    }
    if (methods.empty()) {
        throw CLI::ValidationError("--methods", "no method; there are: " + methodNames());
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
            "--sweep", "'" + name + "' is not known; there are: batch, triangles, fragments, voxels, all, none");
    }
}

void addPoseOptions(CLI::App& parser, CompareOptions& options) {
    parser.get_option("--poses")->description(
        "a world_from_object matrix a line: 16 numbers, row by row; default: random ones, as make poses gives");
    addWholeNumber(
        parser, "--number", [&options](std::uint32_t number) { options.number = number; },
        {.least = 1, .most = kMostPoses}, "how many random poses", options.number);
    addSeed(parser, options.seed);
    parser.get_option("--number")->excludes("--poses");
    parser.get_option("--seed")->excludes("--poses");
    addWholeNumber(
        parser, "--only-pose", [&options](std::uint32_t pose) { options.onlyPose = pose; }, {},
        "this pose alone, by its number from 0", std::nullopt);
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
            "which, as a list: " + methodNames() + "; default: all that the device can do, and cpu")
        ->type_name("LIST");
    addWholeNumber(
        parser, "--oracle", options.settings.oraclePoses, 0,
        "poses that are checked fragment by fragment against the oracle, spread evenly over those that touch, and over "
        "the others where these are too few; 0: none");
    parser
        .add_option_function<std::string>(
            "--sweep", [&options](const std::string& name) { readSweep(name, options); },
            "what is timed: batch, triangles, fragments, voxels, all, none; default: batch, and all with --report")
        ->type_name("NAME");
    addWholeNumber(parser, "--repetitions", options.settings.repeats, 1, "samples of each time, after a warm-up");
    addTimeLimit(parser, options.settings.timeLimit,
                 "seconds for the samples of a sweep: fewer than --repetitions are taken where they do not fit");
    parser.add_flag("--keep-going", options.settings.keepGoing,
                    "when methods disagree, time them and still write the outputs; the exit status stays 3");
    CLI::Option* localize =
        parser.add_flag("--localize", options.localize,
                        "which triangles touch, by each way to tell, instead; 8 poses and 3 repetitions unless given");
    addPath(parser, "--report", options.report, "an HTML page of tables, in one file");
    for (const char* other : {"--methods", "--oracle", "--sweep", "--report"}) {
        localize->excludes(other);
    }
    addDeviceOptions(parser, options.device);
    addOutputOptions(parser, options.output);
    addProgressOption(parser, options.progress);
}

} // namespace voxtact::app
