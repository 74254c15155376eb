// SPDX-License-Identifier: MIT
#include "cli/program.h"

#include "cli/options/help_format.h"
#include "cli/options/output_paths.h"
#include "cli/output/standard_streams.h"
#include "cli/output/text_for_messages.h"
#include "cli/version.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>

namespace voxtact::app {

namespace {

/// Returns the subcommand that the arguments reached.
const CLI::App* deepest(const CLI::App& program) {
    const CLI::App* app = &program;
    while (!app->get_subcommands().empty()) {
        app = app->get_subcommands().front();
    }
    return app;
}

/// Returns the full name: "make mesh".
std::string commandName(const CLI::App* app) {
    std::string name;
    for (; app->get_parent() != nullptr; app = app->get_parent()) {
        name = app->get_name() + (name.empty() ? "" : " ") + name;
    }
    return name;
}

std::vector<std::string> commandsOf(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
        names.push_back(command->get_name());
    }
    return names;
}

/// Returns the long names of the options: "--option".
std::vector<std::string> optionsOf(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

std::string parseErrorText(const CLI::App& program, const CLI::ParseError& error) {
    const CLI::App* app = deepest(program);
    const std::string name = commandName(app);
    const std::string help = "; see voxtact " + name + (name.empty() ? "" : " ") + "--help";
    const bool maybeUnknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (const auto unknown = program.remaining(true); maybeUnknown && !unknown.empty()) {
        const bool command = !app->get_subcommands({}).empty() && !unknown.front().starts_with('-');
        const std::string meant = nearestName(unknown.front(), command ? commandsOf(*app) : optionsOf(*app));
        return (command ? "unknown command " : "unknown argument ") + forMessage(unknown.front()) +
               (meant.empty() ? "" : ", did you mean " + meant + "?") + help;
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        for (const CLI::Option* option : app->get_options()) {
            if (const std::size_t count = option->count(); option->get_items_expected_max() == 1 && count > 1) {
                return option->get_name() + " is given " + (count == 2 ? "twice" : std::to_string(count) + " times") +
                       "; leave out all but one" + help;
            }
        }
    }
    if (!app->get_subcommands({}).empty()) {
        return "no command" + help;
    }
    return error.what() + help;
}

int finish(const std::string& command, const Outcome& outcome) {
    // Ignores a closed pipe, but reports a missing file.
    if (outcome.status == kExitFailed && standardOutputIsClosed() && !writesFiles()) {
        return kExitDone;
    }
    if (outcome.status != kExitDone) {
        printError(command, outcome.text);
    }
    return outcome.status;
}

int printed(const Result<void>& written) {
    return finish("", written ? Outcome() : Outcome(written.error()));
}

int run(const ProgramDesc& desc, std::vector<std::string> arguments) {
    CLI::App program(desc.description, "voxtact");
    program.require_subcommand(1);
    program.set_help_flag("-h,--help,--help-all", "print this text; --help-all: all options");
    program.set_version_flag("--version", versionText());
    program.footer(desc.footer);
    program.formatter(std::make_shared<HelpFormat>(std::ranges::find(arguments, "--help-all") != arguments.end()));
    const std::vector<Command> commands = desc.addCommands(program);
    bool force = false;
    for (const Command& command : commands) {
        for (const char* output : {"--output", "OUTPUT"}) {
            if (command.parser->get_option_no_throw(output) != nullptr) {
                command.parser->add_flag("--force", force, "overwrite existing outputs, never an input");
            }
        }
    }
    try {
        if (!arguments.empty() && arguments.front() == "help") {
            std::rotate(arguments.begin(), arguments.begin() + 1, arguments.end());
            arguments.back() = "--help";
            const std::vector<std::string> known = commandsOf(program);
            if (arguments.size() > 1 && std::ranges::find(known, arguments.front()) == known.end()) {
                arguments.pop_back(); // an unknown command
            }
        }
        std::ranges::reverse(arguments); // the order that CLI11 expects
        program.parse(std::move(arguments));
    } catch (const CLI::CallForHelp&) {
        return printed(writeStandardOutput(program.help()));
    } catch (const CLI::CallForVersion&) {
        return printed(writeStandardOutput(versionText()));
    } catch (const CLI::ParseError& error) {
        return finish(commandName(deepest(program)), Outcome(kExitArguments, parseErrorText(program, error)));
    }
    for (const Command& command : commands) {
        if (command.parser == deepest(program)) {
            keepExisting(!force && command.parser->get_option_no_throw("--force") != nullptr);
            return finish(commandName(command.parser), command.run());
        }
    }
    return finish("", Outcome(kExitArguments, "no command; see voxtact --help"));
}

std::terminate_handler standardHandler = nullptr;

/// Handles exceptions without allocating: destructors of JSON allocate. No other destructor may run, so the process
/// ends immediately.
[[noreturn]] void onTerminate() noexcept {
    try {
        if (std::current_exception() != nullptr) {
            throw;
        }
    } catch (const std::bad_alloc&) {
        printOutOfMemory();
        std::_Exit(kExitFailed);
    } catch (...) {
        standardHandler();
    }
    standardHandler();
    std::abort();
}

} // namespace

int runProgram(const ProgramDesc& desc, std::vector<std::string> arguments) {
    if (std::get_terminate() != onTerminate) {
        standardHandler = std::set_terminate(onTerminate);
    }
    try {
        return run(desc, std::move(arguments));
    } catch (const std::bad_alloc&) {
        printOutOfMemory();
    } catch (const std::exception& exception) {
        printError("", exception.what());
    }
    return kExitFailed;
}

} // namespace voxtact::app
