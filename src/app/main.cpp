// SPDX-License-Identifier: MIT
#include "app/output/standard_streams.h"
#include "app/program.h"

#include <algorithm>

int main(int argc, char** argv) {
    voxtact::app::claimStandardStreams();
    return voxtact::app::runProgram({argv + std::min(argc, 1), argv + argc});
}
