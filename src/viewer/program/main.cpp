// SPDX-License-Identifier: MIT
#include "cli/output/standard_streams.h"
#include "cli/program.h"
#include "viewer/program/view_options.h"

#include <algorithm>

namespace {

using namespace voxtact::app;

constexpr ProgramDesc kProgram{"A window that shows a volume and meshes, and whether they touch.",
                               "Example:\n  voxtact view --volume head.nii.gz --mesh tool.stl",
                               [](CLI::App& program) -> std::vector<Command> { return {addView(program)}; }};

} // namespace

int main(int argc, char** argv) {
    claimStandardStreams();
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    arguments.insert(arguments.begin(), "view");
    return runProgram(kProgram, std::move(arguments));
}
