// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <atomic>
#include <cerrno>
#include <fstream>
#include <locale>
#include <system_error>

#include <unistd.h>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

std::string systemReason(const char* otherwise) {
    return errno != 0 ? std::generic_category().message(errno) : otherwise;
}

/// A name in the folder of `target` that nobody else uses, with the same ending; removed unless it was renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : path_(target.parent_path() / nameFor(target)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }

    [[nodiscard]] const fs::path& path() const noexcept { return path_; }

    [[nodiscard]] Result<void> renameTo(const fs::path& target) {
        std::error_code problem;
        const fs::file_status old = fs::status(target, problem);
        if (fs::is_regular_file(old)) {
            fs::permissions(path_, old.permissions(), problem);
        }
        fs::rename(path_, target, problem);
        if (problem) {
            return cannotWrite(target, problem.message());
        }
        return {};
    }

  private:
    static std::string nameFor(const fs::path& target) {
        static std::atomic<unsigned> next{0};
        // The ending must survive, and the whole must fit where the target's name fits.
        constexpr std::size_t kKept = 60;
        const std::string name = target.filename().string();
        return ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(next++) + "-" +
               name.substr(name.size() > kKept ? name.size() - kKept : 0);
    }

    fs::path path_;
};

/// Where to rename to (symbolic links are followed); refuses folders, and folders that do not exist.
Result<fs::path> targetOf(const fs::path& path) {
    std::error_code problem;
    if (!path.has_filename() || fs::is_directory(path, problem)) {
        return cannotWrite(path, "it is a folder, not a file");
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const fs::file_status status = fs::status(folder, problem);
    if (status.type() == fs::file_type::not_found) {
        return cannotWrite(path, "the folder '" + folder.string() + "' does not exist");
    }
    if (!fs::is_directory(status)) {
        return cannotWrite(path, "'" + folder.string() + "' is not a folder that can be opened");
    }
    if (fs::is_symlink(fs::symlink_status(path, problem))) {
        const fs::path target = fs::canonical(path, problem);
        return problem ? cannotWrite(path, "it is a link to a file that does not exist") : Result<fs::path>(target);
    }
    return path;
}

/// Devices and pipes: renaming would replace them.
bool isSpecial(const fs::path& path) {
    std::error_code problem;
    const fs::file_status status = fs::status(path, problem);
    return fs::exists(status) && !fs::is_regular_file(status);
}

Result<void> writeStream(const fs::path& place, const fs::path& path,
                         const std::function<Result<void>(std::ostream&)>& write) {
    errno = 0;
    std::ofstream stream(place, std::ios::binary);
    stream.imbue(std::locale::classic());
    if (!stream) {
        return cannotWrite(path, systemReason("it cannot be opened"));
    }
    if (Result<void> written = write(stream); !written.ok()) {
        return written;
    }
    errno = 0;
    stream.close();
    if (!stream) {
        return cannotWrite(path, systemReason("writing stopped before the end"));
    }
    return {};
}

} // namespace

Result<void> writeFileAt(const fs::path& path, const std::function<Result<void>(const fs::path& temporary)>& write) {
    return guard([&]() -> Result<void> {
        const Result<fs::path> target = targetOf(path);
        if (!target.ok()) {
            return target.error();
        }
        if (isSpecial(*target)) {
            return cannotWrite(path, "it is not an ordinary file");
        }
        TemporaryFile temporary(*target);
        if (Result<void> written = write(temporary.path()); !written.ok()) {
            return written;
        }
        return temporary.renameTo(*target);
    });
}

Result<void> writeFile(const fs::path& path, const std::function<Result<void>(std::ostream&)>& write) {
    return guard([&]() -> Result<void> {
        if (isSpecial(path) && !fs::is_directory(path)) {
            return writeStream(path, path, write);
        }
        return writeFileAt(path, [&](const fs::path& temporary) { return writeStream(temporary, path, write); });
    });
}

} // namespace voxtact::io
