// SPDX-License-Identifier: MIT
#include "bench/program/bench.h"
#include "cli/output/standard_streams.h"
#include "cli/program.h"

#include <algorithm>

namespace {

using namespace voxtact::app;

constexpr ProgramDesc kProgram{
    "Measurements of voxtact and its peers.",
    "Examples:\n  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel\n  voxtact bench --certified",
    [](CLI::App& program) -> std::vector<Command> {
        return {addCompare(program), addBench(program)};
    }};

} // namespace

int main(int argc, char** argv) {
    claimStandardStreams();
    return runProgram(kProgram, {argv + std::min(argc, 1), argv + argc});
}
