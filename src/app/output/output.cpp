// SPDX-License-Identifier: MIT
#include "app/output/output.h"

#include "app/output/outcome.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <sstream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

Error fileError(const fs::path& path, const std::string& why) {
    return Error{ErrorCode::File, 0, "cannot write '" + path.string() + "': " + why};
}

/// A device, a pipe: io::writeFile() writes it as it is, so that its folder does not matter.
bool isSpecial(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// What a file is, by whatever name; nothing where there is none.
std::optional<std::pair<dev_t, ino_t>> identityOf(const fs::path& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? std::optional(std::pair(status.st_dev, status.st_ino)) : std::nullopt;
}

bool isStandardOutput(const fs::path& path) {
    return path.empty() || path == "-";
}

/// The deliveries from number `next` on, each written before the ones after it are put in their places.
Result<void> deliverFrom(const std::vector<Delivery>& deliveries, std::size_t next) {
    if (next == deliveries.size()) {
        return {};
    }
    const Delivery& delivery = deliveries[next];
    return deliver(delivery.path, [&](std::ostream& out) -> Result<void> {
        VOXTACT_TRY(delivery.write(out));
        errno = 0;
        if (!out.flush()) {
            return fileError(delivery.path, errno != 0 ? std::generic_category().message(errno) : "writing stopped");
        }
        return deliverFrom(deliveries, next + 1);
    });
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
    if (!fs::is_directory(folder, ignored)) {
        return fileError(path, "the folder '" + folder.string() + "' does not exist: make it first");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        return fileError(path, "the folder '" + folder.string() + "': " + std::generic_category().message(errno));
    }
    return {};
}

Result<void> checkDistinct(const std::vector<std::pair<std::string, fs::path>>& paths) {
    for (auto one = paths.begin(); one != paths.end(); ++one) {
        if (isStandardOutput(one->second) || isSpecial(one->second)) {
            continue;
        }
        std::error_code ignored;
        const fs::path place = fs::weakly_canonical(fs::absolute(one->second), ignored);
        const auto identity = identityOf(one->second);
        for (auto other = paths.begin(); other != one; ++other) {
            if (!isStandardOutput(other->second) &&
                (fs::weakly_canonical(fs::absolute(other->second), ignored) == place ||
                 (identity && identityOf(other->second) == identity))) {
                return badArgument(other->first + " and " + one->first + ": both are '" + one->second.string() +
                                   "'; each needs a file of its own");
            }
        }
    }
    return {};
}

Result<void> deliver(const fs::path& path, const std::function<Result<void>(std::ostream&)>& write) {
    if (isStandardOutput(path)) {
        std::ostringstream text;
        VOXTACT_TRY(write(text));
        return writeStandardOutput(text.str());
    }
    return io::writeFile(path, write);
}

Result<void> deliverAll(std::vector<Delivery> deliveries) {
    // The last is put in its place first. What is on standard output cannot be taken back, and may fail.
    std::stable_partition(deliveries.begin(), deliveries.end(),
                          [](const Delivery& delivery) { return !isStandardOutput(delivery.path); });
    return deliverFrom(deliveries, 0);
}

} // namespace voxtact::app
