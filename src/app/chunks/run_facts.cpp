// SPDX-License-Identifier: MIT
#include "app/chunks/run_facts.h"

#include "app/chunks/content_hash.h"
#include "app/output/text_for_messages.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

/// How the names of facts about files begin; the path and an apostrophe follow.
constexpr std::string_view kContentOf = "content of '";

Error cannotRead(const fs::path& path, const std::string& why) {
    return {ErrorCode::File, 0, "cannot read '" + path.string() + "': " + why};
}

Result<std::string> factOf(const fs::path& path) {
    constexpr std::size_t kPart = std::size_t{1} << 20U;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    ContentHash hash;
    std::vector<char> part(kPart);
    while (file) {
        file.read(part.data(), static_cast<std::streamsize>(part.size()));
        hash.add({part.data(), static_cast<std::size_t>(file.gcount())});
    }
    if (!file.eof()) {
        return cannotRead(path, std::generic_category().message(errno != 0 ? errno : EIO));
    }
    return std::to_string(hash.length()) + " bytes, " + hash.hex();
}

/// The files that reading `input` may read, in an order that does not depend on the machine.
std::vector<fs::path> filesOf(const fs::path& input) {
    std::error_code problem;
    std::set<fs::path> files;
    if (fs::is_directory(input, problem)) {
        for (fs::recursive_directory_iterator entry(input, problem), end; !problem && entry != end;
             entry.increment(problem)) {
            if (entry->is_regular_file(problem)) {
                files.insert(entry->path());
            }
        }
        return {files.begin(), files.end()};
    }
    std::vector<fs::path> all{input};
    for (const std::string& name : namesIn(input)) {
        const fs::path other = input.parent_path() / name;
        if (!name.empty() && name.find('\0') == std::string::npos && fs::is_regular_file(other, problem)) {
            files.insert(other);
        }
    }
    files.erase(input);
    all.insert(all.end(), files.begin(), files.end());
    return all;
}

} // namespace

void addOptionFacts(RunFacts& facts, const CLI::App& parser, const std::vector<std::string>& without) {
    for (const CLI::Option* option : parser.get_options()) {
        if (option->get_lnames().empty() || option->count() == 0) {
            continue;
        }
        const std::string name = "--" + option->get_lnames().front();
        if (std::find(without.begin(), without.end(), name) != without.end()) {
            continue;
        }
        for (const std::string& value : option->results()) {
            facts.emplace_back(name, value);
        }
    }
}

Result<void> addInputFacts(RunFacts& facts, const std::vector<NamedPath>& inputs) {
    std::set<fs::path> told;
    for (const NamedPath& input : inputs) {
        for (const fs::path& file : filesOf(input.path)) {
            std::error_code problem;
            if (!fs::exists(file, problem) || !told.insert(file).second) {
                continue; // names of labels need not be there
            }
            const Result<std::string> fact = factOf(file);
            VOXTACT_TRY(fact);
            facts.emplace_back(std::string(kContentOf) + file.string() + "'", *fact);
        }
    }
    return {};
}

std::vector<NamedPath> inputsOf(const RunFacts& facts) {
    std::vector<NamedPath> inputs;
    for (const auto& fact : facts) {
        const std::string& name = fact.first;
        if (name.starts_with(kContentOf) && name.ends_with('\'')) {
            inputs.push_back({"the run", name.substr(kContentOf.size(), name.size() - kContentOf.size() - 1)});
        }
    }
    return inputs;
}

std::string differenceOf(const RunFacts& its, const RunFacts& here) {
    const auto valueIn = [](const RunFacts& facts, const std::string& name) {
        std::string all;
        for (const auto& [one, value] : facts) {
            all += one == name ? (all.empty() ? "" : ", ") + value : "";
        }
        return all;
    };
    const auto said = [](const std::string& value) { return value.empty() ? "not given" : forMessage(value); };
    for (const RunFacts* facts : {&its, &here}) {
        for (const auto& entry : *facts) {
            const std::string& name = entry.first;
            const std::string old = valueIn(its, name);
            const std::string now = valueIn(here, name);
            if (old != now) {
                return "its " + name + " is " + said(old) + ", here it is " + said(now);
            }
        }
    }
    return its == here ? "" : "the order of its options is another one";
}

} // namespace voxtact::app
