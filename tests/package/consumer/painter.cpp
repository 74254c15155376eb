// SPDX-License-Identifier: MIT
// A program that needs voxtact::render to link, and no device to run.
#include "voxtact/render.h"

#include <cstdio>
#include <cstdlib>

int main() {
    const auto make = &voxtact::BlockingRenderer::create;
    const auto upload = &voxtact::RenderTransferFunction::upload;
    std::printf("step %g mm, %s\n", voxtact::RenderTransferFunctionDesc{}.step,
                make != nullptr && upload != nullptr ? "linked" : "not linked");
    return EXIT_SUCCESS;
}
