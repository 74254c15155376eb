// SPDX-License-Identifier: MIT
#include "cli/commands.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <unistd.h>

namespace voxtact::app {

namespace {

struct OtherProgram {
    const char* command;
    const char* help;
    const char* file;
    const char* firstArgument; ///< may be null
    const char* build;         ///< the command that builds it
};

constexpr std::array<OtherProgram, 3> kOtherPrograms{{
    {"view", "open the window (voxtact-view)", "voxtact-view", nullptr, "./run view"},
    {"compare", "verify and time counting methods (voxtact-bench)", "voxtact-bench", "compare", "./run test"},
    {"bench", "verify and time the engines (voxtact-bench)", "voxtact-bench", "bench", "./run test"},
}};

/// Replaces this process; returns only on failure.
Outcome become(const OtherProgram& other, const std::vector<std::string>& arguments) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    std::vector<std::string> words{(self.parent_path() / other.file).string()};
    if (other.firstArgument != nullptr) {
        words.emplace_back(other.firstArgument);
    }
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    ::execv(pointers.front(), pointers.data());
    const std::string reason = errno == ENOENT ? "is not in the folder of this program" : std::strerror(errno);
    return {kExitFailed, std::string(other.file) + ": " + reason + "; " + other.build + " builds it"};
}

} // namespace

std::vector<Command> addOtherPrograms(CLI::App& program) {
    std::vector<Command> commands;
    for (const OtherProgram& other : kOtherPrograms) {
        CLI::App* parser = program.add_subcommand(other.command, other.help);
        parser->set_help_flag();
        parser->prefix_command();
        commands.push_back({parser, [&other, parser] { return become(other, parser->remaining()); }});
    }
    return commands;
}

} // namespace voxtact::app
