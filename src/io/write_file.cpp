// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/file_buffer.h"
#include "voxtact/io.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <locale>
#include <optional>
#include <ostream>
#include <random>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

/// A name in the folder of `target` that nobody else uses, with the same ending; removed unless it was renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : path_(target.parent_path() / nameFor(target)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        if (!isReleased_) {
            fs::remove(path_, ignored);
        }
    }
    void release() noexcept { isReleased_ = true; }

    [[nodiscard]] const fs::path& path() const noexcept { return path_; }

    /// `old`: the previous file, whose permissions it takes.
    [[nodiscard]] Result<void> renameTo(const fs::path& target, const fs::file_status& old) {
        std::error_code problem;
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
        // Other machines and containers that share the folder count their processes, too.
        static const unsigned own = std::random_device()();
        static std::atomic<unsigned> next{0};
        // The ending must survive, and the whole must fit where the target's name fits.
        constexpr std::size_t kKept = 60;
        const std::string name = target.filename().string();
        return ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(own) + "-" + std::to_string(next++) + "-" +
               name.substr(name.size() > kKept ? name.size() - kKept : 0);
    }

    fs::path path_;
    bool isReleased_ = false;
};

/// Moves a file to its place. Unless confirmed, removes it again and restores the previous file.
class Replacement {
  public:
    Replacement(TemporaryFile& file, fs::path target) : file_(file), target_(std::move(target)), old_(target_) {}
    Replacement(const Replacement&) = delete;
    Replacement& operator=(const Replacement&) = delete;
    ~Replacement() {
        if (!isSettled_) {
            static_cast<void>(undo());
        }
    }

    /// `isLast`: nothing has to be removed afterwards.
    [[nodiscard]] Result<void> make(bool isLast) {
        std::error_code problem;
        const fs::file_status old = fs::status(target_, problem);
        if (fs::is_regular_file(old) && !isLast) {
            fs::create_hard_link(target_, old_.path(), problem);
            if (problem) { // not every file system has links, or permits them
                fs::rename(target_, old_.path(), problem);
            }
            isKept_ = !problem;
        }
        Result<void> renamed = file_.renameTo(target_, old);
        isNew_ = renamed.ok() && !fs::exists(old);
        return renamed;
    }
    void settle() noexcept { isSettled_ = true; }
    /// Returns true if the previous file is restored. If not, it stays under the name of keptAs().
    [[nodiscard]] bool undo() noexcept {
        isSettled_ = true;
        std::error_code problem;
        if (isKept_) {
            fs::rename(old_.path(), target_, problem);
            if (problem) {
                old_.release();
            }
        } else if (isNew_) {
            fs::remove(target_, problem);
        }
        return !problem;
    }
    [[nodiscard]] std::string keptAs() const {
        return "'" + target_.string() + "'" +
               (isKept_ ? " as it was is now '" + old_.path().string() + "'" : " is new");
    }

  private:
    TemporaryFile& file_;
    fs::path target_;
    TemporaryFile old_; ///< the previous file
    bool isKept_ = false;
    bool isNew_ = false;
    bool isSettled_ = false;
};

/// Returns the path to rename to (follows symbolic links). Refuses folders, and missing parent folders.
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

} // namespace

struct OutputFile::State {
    fs::path path; ///< as the caller named it
    std::optional<fs::path> target;
    std::optional<TemporaryFile> temporary; ///< nothing: a device or a pipe
    FileBuffer buffer{};
    std::ostream stream{&buffer};
    bool closed = false;
};

OutputFile::OutputFile(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

Result<OutputFile> OutputFile::create(const fs::path& path) {
    return guard([&]() -> Result<OutputFile> {
        auto state = std::make_unique<State>();
        state->path = path;
        state->stream.imbue(std::locale::classic());
        bool opened = false;
        if (isSpecial(path) && !fs::is_directory(path)) {
            opened = state->buffer.openSpecial(path);
        } else {
            const Result<fs::path> target = targetOf(path);
            VOXTACT_TRY(target);
            state->target = *target;
            state->temporary.emplace(*target);
            opened = state->buffer.create(state->temporary->path());
        }
        if (!opened) {
            return cannotWrite(path, std::generic_category().message(state->buffer.reason()));
        }
        return OutputFile(std::move(state));
    });
}

std::ostream& OutputFile::stream() noexcept {
    return state_->stream;
}

Result<void> OutputFile::close() {
    return guard([&]() -> Result<void> {
        State& state = *state_;
        state.closed = true;
        const bool written = state.buffer.close();
        if (!written) {
            return cannotWrite(state.path, std::generic_category().message(state.buffer.reason()));
        }
        if (!state.stream) {
            return cannotWrite(state.path, "writing stopped before the end");
        }
        return {};
    });
}

Result<void> OutputFile::commit() {
    return guard([&]() -> Result<void> {
        if (!state_->closed) {
            VOXTACT_TRY(close());
        }
        if (!state_->temporary) {
            return {};
        }
        std::error_code ignored;
        return state_->temporary->renameTo(*state_->target, fs::status(*state_->target, ignored));
    });
}

Result<void> OutputFile::commitAll(std::span<OutputFile* const> files) {
    return guard([&]() -> Result<void> {
        for (OutputFile* const file : files) {
            if (!file->state_->closed) {
                VOXTACT_TRY(file->close());
            }
        }
        std::deque<Replacement> all;
        for (OutputFile* const file : files) {
            if (file->state_->temporary) {
                all.emplace_back(*file->state_->temporary, *file->state_->target);
            }
        }
        for (Replacement& one : all) {
            const Result<void> done = one.make(&one == &all.back());
            if (!done.ok()) {
                Error error = done.error();
                for (auto made = all.rbegin(); made != all.rend(); ++made) {
                    error.text += made->undo() ? "" : "; " + made->keptAs();
                }
                return error;
            }
        }
        std::for_each(all.begin(), all.end(), [](Replacement& one) { one.settle(); });
        return {};
    });
}

Result<void> writeFile(const fs::path& path, const std::function<Result<void>(std::ostream&)>& write) {
    return guard([&]() -> Result<void> {
        Result<OutputFile> file = OutputFile::create(path);
        VOXTACT_TRY(file);
        if (Result<void> written = write(file->stream()); !written.ok()) {
            // The error of the disk is the reason of a failed stream.
            const Result<void> closed = file->stream() ? Result<void>() : file->close();
            return closed.ok() ? written : closed;
        }
        return file->commit();
    });
}

} // namespace voxtact::io
