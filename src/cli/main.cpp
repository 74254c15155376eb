// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/output/standard_streams.h"
#include "cli/program.h"

#include <algorithm>
#include <iterator>

namespace {

using namespace voxtact::app;

std::vector<Command> addCommands(CLI::App& program) {
    std::vector<Command> commands = addQuestions(program);
    for (const auto add : {addPlan, addRender, addInfo, addDevices}) {
        commands.push_back(add(program));
    }
    for (const auto add : {addMake, addOtherPrograms}) {
        std::ranges::move(add(program), std::back_inserter(commands));
    }
    return commands;
}

constexpr ProgramDesc kProgram{"Certified collision and distance queries: triangle meshes against CT/MR images.",
                               "COMMAND --help lists its options, COMMAND --help-all the rare ones, too.\n\n"
                               "Example:\n  voxtact touch --volume builtin:head:128 --mesh builtin:scalpel\n\n"
                               "Exit status: 0 done, 1 run-time failure, 2 unusable arguments, 3 failed check.",
                               addCommands};

} // namespace

int main(int argc, char** argv) {
    claimStandardStreams();
    return runProgram(kProgram, {argv + std::min(argc, 1), argv + argc});
}
