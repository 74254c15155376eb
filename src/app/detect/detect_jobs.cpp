// SPDX-License-Identifier: MIT
#include "app/detect/detect_jobs.h"

#include "app/options/file_status.h"
#include "app/output/text_for_messages.h"
#include "core/base/try.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

namespace voxtact::app {

namespace {

/// The number of `value` in `list`, where it is added if it is new.
template <class Value> std::uint32_t numberIn(std::vector<Value>& list, const Value& value) {
    const auto found = std::find(list.begin(), list.end(), value);
    const auto number = static_cast<std::uint32_t>(found - list.begin());
    if (found == list.end()) {
        list.push_back(value);
    }
    return number;
}

/// The fields of a line of CSV (RFC 4180, without line breaks in fields); nothing where quotes are not closed, or stand
/// in the middle.
std::optional<std::vector<std::string>> csvFields(std::string_view line) {
    std::vector<std::string> fields(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == ',') {
            fields.emplace_back();
        } else if (line[i] != '"') {
            fields.back() += line[i];
        } else if (!fields.back().empty()) {
            return std::nullopt;
        } else {
            bool closed = false;
            for (++i; i < line.size() && !closed; ++i) {
                const bool doubled = line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
                closed = line[i] == '"' && !doubled;
                i += doubled ? 1 : 0;
                if (!closed) {
                    fields.back() += line[i];
                }
            }
            if (!closed || (i < line.size() && line[i] != ',')) {
                return std::nullopt;
            }
            --i;
        }
    }
    return fields;
}

struct JobLine {
    const std::filesystem::path& path;
    std::uint64_t number;

    [[nodiscard]] Error bad(const std::string& why) const {
        return {ErrorCode::Format, 0, path.string() + " line " + std::to_string(number) + ": " + why};
    }
};

Result<void> addJob(const JobLine& at, const std::string& line, PairJobs& all) {
    std::optional<std::vector<std::string>> fields = csvFields(line);
    if (!fields) {
        return at.bad("quotes that are not closed, or in the middle of a field");
    }
    if (at.number == 1 && fields->front() == "mesh") {
        const bool known = *fields == std::vector<std::string>{"mesh", "volume", "poses"} ||
                           *fields == std::vector<std::string>{"mesh", "volume"};
        return known ? Result<void>() : at.bad("the columns are mesh,volume,poses, in this order");
    }
    if (fields->size() < 2 || fields->size() > 3 || (*fields)[0].empty() || (*fields)[1].empty()) {
        return at.bad(forMessage(line) + " is no job; a job is mesh,volume,poses (the poses may be left out)");
    }
    fields->resize(3);
    if ((*fields)[2] == "-") {
        return at.bad("standard input is for --poses -, not for a job");
    }
    all.jobs.push_back({numberIn(all.meshes, (*fields)[0]), numberIn(all.volumes, (*fields)[1]),
                        numberIn(all.poses, std::filesystem::path((*fields)[2]))});
    return {};
}

} // namespace

std::size_t PairJobs::uses(std::uint32_t number) const {
    return static_cast<std::size_t>(
        std::count_if(jobs.begin(), jobs.end(), [number](const Job& job) { return job.poses == number; }));
}

PairJobs allPairs(const std::vector<std::string>& meshes, const std::vector<std::string>& volumes,
                  const std::filesystem::path& poses) {
    PairJobs all;
    all.poses = {poses};
    for (const std::string& volume : volumes) {
        for (const std::string& mesh : meshes) {
            all.jobs.push_back({numberIn(all.meshes, mesh), numberIn(all.volumes, volume), 0});
        }
    }
    return all;
}

Result<PairJobs> readJobs(const std::filesystem::path& path) {
    const auto cannotRead = [&path](const std::string& why) {
        return Error{ErrorCode::File, 0, "cannot read '" + path.string() + "': " + why};
    };
    const Result<std::optional<struct stat>> there = statusOf(path);
    VOXTACT_TRY(there);
    if (!*there || !S_ISREG((*there)->st_mode)) {
        return cannotRead(*there ? "it is not an ordinary file" : "there is no such file");
    }
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return cannotRead(std::generic_category().message(errno));
    }
    PairJobs all;
    all.fromFile = true;
    file.exceptions(std::ios::badbit); // which getline() takes for the end
    std::string line;
    const auto next = [&]() -> Result<bool> {
        try {
            return static_cast<bool>(std::getline(file, line));
        } catch (const std::ios::failure& failure) {
            return cannotRead(failure.code().message());
        }
    };
    for (std::uint64_t number = 1;; ++number) {
        const Result<bool> some = next();
        VOXTACT_TRY(some);
        if (!*some) {
            break;
        }
        if (number == 1 && line.starts_with("\xEF\xBB\xBF")) {
            line.erase(0, 3);
        }
        if (line.ends_with('\r')) {
            line.pop_back();
        }
        if (line.empty() || line.starts_with('#')) {
            continue;
        }
        VOXTACT_TRY(addJob({path, number}, line, all));
    }
    if (all.jobs.empty()) {
        return Error{ErrorCode::Format, 0,
                     "cannot use '" + path.string() + "': it holds no job; a job is a line mesh,volume,poses"};
    }
    return all;
}

} // namespace voxtact::app
