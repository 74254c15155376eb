// SPDX-License-Identifier: MIT
#include "app/chunks/run_facts.h"

#include "app/chunks/content_hash.h"
#include "app/options/file_status.h"
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

/// Adds those that are files.
Result<void> addFiles(const std::vector<fs::path>& paths, NoAccess noAccess, std::set<fs::path>& files) {
    for (const fs::path& path : paths) {
        const Result<bool> file = isFile(path, noAccess);
        VOXTACT_TRY(file);
        if (*file) {
            files.insert(path);
        }
    }
    return {};
}

/// The files that reading `input` may read, in an order that does not depend on the machine; none where it is not
/// there.
Result<std::vector<fs::path>> filesOf(const fs::path& input) {
    const Result<std::optional<struct stat>> status = statusOf(input);
    VOXTACT_TRY(status);
    if (!*status) {
        return std::vector<fs::path>();
    }
    std::set<fs::path> files;
    if (S_ISDIR((*status)->st_mode)) {
        std::error_code problem;
        std::vector<fs::path> entries;
        // What is in a folder that may not be opened is not read either.
        constexpr fs::directory_options kOpened = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator entry(input, kOpened, problem), end; !problem && entry != end;
             entry.increment(problem)) {
            entries.push_back(entry->path());
        }
        if (problem) {
            return cannotLookAt(input, problem);
        }
        VOXTACT_TRY(addFiles(entries, NoAccess::IsAnError, files));
        return std::vector<fs::path>(files.begin(), files.end());
    }
    const Result<std::vector<fs::path>> others = filesNamedIn(input);
    VOXTACT_TRY(others);
    VOXTACT_TRY(addFiles(*others, NoAccess::IsNothing, files));
    files.erase(input);
    std::vector<fs::path> all{input};
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
        const Result<std::vector<fs::path>> files = filesOf(input.path);
        VOXTACT_TRY(files);
        for (const fs::path& file : *files) {
            if (!told.insert(file).second) {
                continue;
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
