// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/view/view_options.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

Command addView(CLI::App& program) {
    auto options = std::make_shared<ViewerOptions>();
    CLI::App* parser = program.add_subcommand("view", "a window; this build of the program has none");
    addViewerOptions(*parser, *options);
    return {parser, [options] {
                return Outcome(kExitFailed, "this build has no window: it was made with VOXTACT_BUILD_VIEW=OFF; "
                                            "voxtact render makes pictures");
            }};
}

} // namespace voxtact::app
