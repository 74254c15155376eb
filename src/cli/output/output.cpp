// SPDX-License-Identifier: MIT
#include "cli/output/output.h"

#include "cli/options/file_status.h"
#include "cli/output/outcome.h"
#include "cli/output/standard_streams.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"
#include "core/base/whole_path.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

Error fileError(const fs::path& path, const std::string& why) {
    return Error{ErrorCode::File, 0, "cannot write '" + path.string() + "': " + why};
}

/// Returns true for devices and pipes: io::writeFile() writes them directly, without a temporary file in the folder.
bool isSpecial(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool isStandardOutput(const fs::path& path) {
    return path.empty() || path == "-";
}

} // namespace

io::Format OutputOptions::format() const {
    if (formatName.empty()) {
        return isStandardOutput(path) && outputIsTerminal() ? io::Format::Text : io::Format::Csv;
    }
    return formatName == "json" ? io::Format::Json : formatName == "text" ? io::Format::Text : io::Format::Csv;
}

Result<void> checkOutput(const fs::path& path) {
    if (isStandardOutput(path) || isSpecial(path)) {
        return {};
    }
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        return fileError(path, "it is a folder");
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const Result<std::optional<struct stat>> there = statusOf(folder);
    if (!there.ok()) {
        return fileError(path, there.error().text);
    }
    if (!*there || !S_ISDIR((*there)->st_mode)) {
        return fileError(path, "the folder '" + folder.string() + "' does not exist; create it first");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        return fileError(path, "the folder '" + folder.string() + "': " + std::generic_category().message(errno));
    }
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0 && errno == ENAMETOOLONG) {
        return fileError(path, std::generic_category().message(errno));
    }
    return {};
}

Result<void> checkDistinct(const std::vector<std::pair<std::string, fs::path>>& paths) {
    std::map<fs::path, std::size_t> places;
    std::map<FileIdentity, std::size_t> identities;
    for (std::size_t number = 0; number < paths.size(); ++number) {
        const auto& [option, path] = paths[number];
        if (isStandardOutput(path) || isSpecial(path)) {
            continue;
        }
        std::size_t first = places.emplace(realPath(path), number).first->second;
        const Result<std::optional<FileIdentity>> identity = identityOf(path);
        VOXTACT_TRY(identity);
        if (identity->has_value()) {
            first = std::min(first, identities.emplace(**identity, number).first->second);
        }
        if (first != number) {
            return badArgument(paths[first].first + " and " + option + ": both are '" + path.string() +
                               "'; give each its own file");
        }
    }
    return {};
}

Result<void> deliver(const fs::path& path, const std::function<Result<void>(std::ostream&)>& write) {
    if (isStandardOutput(path)) {
        TextStream text;
        VOXTACT_TRY(write(text));
        return writeStandardOutput(text.str());
    }
    return io::writeFile(path, write);
}

Result<void> deliverAll(std::vector<Delivery> deliveries) {
    std::vector<io::OutputFile> files; // closed: a process can have a limited number of open files
    std::string text;
    for (Delivery& delivery : deliveries) {
        const auto write = std::exchange(delivery.write, {}); // frees what it captured afterwards
        if (isStandardOutput(delivery.path)) {
            TextStream out;
            VOXTACT_TRY(write(out));
            text += out.str();
            continue;
        }
        Result<io::OutputFile> file = io::OutputFile::create(delivery.path);
        VOXTACT_TRY(file);
        VOXTACT_TRY(write(file->stream()));
        VOXTACT_TRY(file->close());
        files.push_back(std::move(*file));
    }
    // Standard output first: it may fail and cannot be undone.
    if (!text.empty()) {
        VOXTACT_TRY(writeStandardOutput(text));
    }
    std::vector<io::OutputFile*> all;
    std::transform(files.rbegin(), files.rend(), std::back_inserter(all), [](io::OutputFile& file) { return &file; });
    return io::OutputFile::commitAll(all);
}

} // namespace voxtact::app
