// SPDX-License-Identifier: MIT
#include "app/program.h"

#include "app/commands.h"
#include "app/options/old_names.h"
#include "app/output/standard_streams.h"
#include "app/output/text_for_messages.h"
#include "app/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>

namespace voxtact::app {

namespace {

/// The subcommand that the arguments lead to, as far as they were read.
const CLI::App* deepest(const CLI::App& program) {
    const CLI::App* app = &program;
    while (!app->get_subcommands().empty()) {
        app = app->get_subcommands().front();
    }
    return app;
}

/// "make mesh"
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

/// "--option", as far as they have names of that kind.
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
        return "a command is needed" + help;
    }
    return error.what() + help;
}

int finish(const std::string& command, const Outcome& outcome) {
    if (outcome.status != kExitDone) {
        printError(command, outcome.text);
    }
    return outcome.status;
}

int printed(const Result<void>& written) {
    return finish("", written ? Outcome() : Outcome(written.error()));
}

int run(std::vector<std::string> arguments) {
    CLI::App program("Contact between triangle meshes and the visible part of volumes, on Vulkan.", "voxtact");
    program.require_subcommand(1);
    program.set_version_flag("--version", versionText());
    program.footer("Example:\n  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel\n\n"
                   "Exit status: 0 done, 1 failed at run time, 2 unusable arguments, 3 a verification failed.");
    std::vector<Command> commands{addDetect(program), addCompare(program), addBench(program),  addDevices(program),
                                  addInfo(program),   addMerge(program),   addMotion(program), addPlan(program),
                                  addRender(program), addView(program)};
    for (Command& command : addMake(program)) {
        commands.push_back(std::move(command));
    }
    try {
        arguments = withNewNames(std::move(arguments));
        std::ranges::reverse(arguments); // as CLI11 wants them
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
            return finish(commandName(command.parser), command.run());
        }
    }
    return finish("", Outcome(kExitArguments, "a command is needed; see voxtact --help"));
}

std::terminate_handler standardHandler = nullptr;

/// Where no exception may pass and there is no memory: destructors of JSON make room for what they take apart. No other
/// destructor may run then, so the process ends at once.
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

int runProgram(std::vector<std::string> arguments) {
    if (std::get_terminate() != onTerminate) {
        standardHandler = std::set_terminate(onTerminate);
    }
    try {
        return run(std::move(arguments));
    } catch (const std::bad_alloc&) {
        printOutOfMemory();
    } catch (const std::exception& exception) {
        printError("", exception.what());
    }
    return kExitFailed;
}

} // namespace voxtact::app
