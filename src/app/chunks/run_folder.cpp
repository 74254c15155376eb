// SPDX-License-Identifier: MIT
#include "app/chunks/run_folder.h"

#include "app/chunks/content_hash.h"
#include "app/options/file_status.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "io/text/small_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <fcntl.h>
#include <sys/file.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifestName = "voxtact-run.json";
constexpr std::uintmax_t kMostManifest = std::uintmax_t{1} << 30U;
constexpr const char* kLockName = "run.lock";
constexpr std::string_view kShardName = "shard-";
constexpr std::string_view kShardEnding = ".lock";
/// Of what is written under another name first (io::OutputFile).
constexpr std::string_view kTemporaryName = ".tmp";

Error cannotUse(const fs::path& folder, const std::string& why) {
    return {ErrorCode::File, 0, "--resume: cannot use " + folderText(folder) + ": " + why};
}

std::string shardName(const Shard& shard) {
    return std::string(kShardName) + std::to_string(shard.index) + "-of-" + std::to_string(shard.count) +
           std::string(kShardEnding);
}

/// Whether a file is one that may be there before there is a manifest.
bool isPreparation(const std::string& name) {
    return name == kLockName || name.starts_with(kTemporaryName) || name.starts_with(kShardName);
}

/// Makes the folder if it is not there; refuses what is not ours.
Result<void> prepare(const fs::path& folder) {
    std::error_code problem;
    const fs::file_status status = fs::status(folder, problem);
    if (status.type() == fs::file_type::not_found) {
        fs::create_directory(folder, problem);
        // Another process may have been faster.
        if (std::error_code ignored; !problem || fs::is_directory(folder, ignored)) {
            return {};
        }
        return cannotUse(folder, problem == std::errc::no_such_file_or_directory
                                     ? "the folder " +
                                           folderText(folder.has_parent_path() ? folder.parent_path() : ".") +
                                           " does not exist: make it first"
                                     : problem.message());
    }
    if (!fs::is_directory(status)) {
        return cannotUse(folder, problem ? problem.message() : "it is a file; give a folder, which need not be there");
    }
    if (fs::exists(folder / kManifestName, problem)) {
        return {};
    }
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        if (const std::string name = entry->path().filename().string(); !isPreparation(name) && name != kManifestName) {
            return cannotUse(folder, "it has '" + name + "' and is no folder of a run; give a new or an empty one");
        }
    }
    return problem ? cannotUse(folder, problem.message()) : Result<void>();
}

/// Of processes that have ended: whoever writes has a lock.
void removeTemporaryFiles(const fs::path& folder) {
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        const std::string name = entry->path().filename().string();
        const std::string rest = name.substr(std::min(name.size(), kTemporaryName.size()));
        std::error_code ignored;
        if (name.starts_with(kTemporaryName) && (rest.starts_with('-') || rest.find_first_of("0123456789") == 0) &&
            entry->is_regular_file(ignored)) {
            fs::remove(entry->path(), ignored);
        }
    }
}

Result<void> writeManifest(const fs::path& path, const RunManifest& manifest) {
    return io::writeFile(path, [&](std::ostream& out) -> Result<void> {
        out << manifest.text();
        return {};
    });
}

/// Puts the manifest there unless there is one: of two processes one is first.
Result<void> place(const fs::path& folder, const RunManifest& manifest) {
    const fs::path target = folder / kManifestName;
    std::error_code problem;
    if (fs::exists(target, problem)) {
        return {};
    }
    // A name of our own: an OutputFile replaces what is there, a link does not.
    const fs::path own =
        folder / (std::string(kTemporaryName) + "-manifest-" + std::to_string(::getpid()) + "-" + manifest.id());
    const Result<void> written = writeManifest(own, manifest);
    if (written.ok()) {
        fs::create_hard_link(own, target, problem);
        if (problem && problem != std::errc::file_exists) {
            // A file system without links.
            fs::rename(own, target, problem);
        } else {
            fs::remove(own, problem);
            return {};
        }
    }
    // Who was first may have swept away what is no longer needed.
    if (std::error_code ignored; fs::exists(target, ignored)) {
        return {};
    }
    return written.ok() && !problem ? Result<void>()
                                    : cannotUse(folder, written.ok() ? problem.message() : written.error().text);
}

Result<ReadManifest> readManifest(const fs::path& folder) {
    const Result<std::string> text = io::readSmallFile(folder / kManifestName, kMostManifest);
    if (!text.ok()) {
        return cannotUse(folder / kManifestName, text.error().text);
    }
    return readManifestText(*text);
}

Result<RunManifest> readWholeManifest(const fs::path& folder) {
    Result<ReadManifest> read = readManifest(folder);
    VOXTACT_TRY(read);
    const std::string file = "'" + (folder / kManifestName).string() + "' is ";
    switch (read->state) {
    case ManifestState::Whole:
        return std::move(read->manifest);
    case ManifestState::OfAnotherVersion:
        return Error{ErrorCode::Format, 0, file + "of another version of voxtact; begin anew with an empty folder"};
    case ManifestState::Damaged:
        break;
    }
    return Error{ErrorCode::Format, 0, file + "damaged; the command that made it writes it anew, and goes on"};
}

} // namespace

/// An flock() of a file, which the system lifts however the process ends.
class RunFolder::Lock {
  public:
    explicit Lock(int file) noexcept : file_(file) {}
    Lock(Lock&& other) noexcept : file_(std::exchange(other.file_, -1)), isReal_(other.isReal_) {}
    Lock& operator=(Lock&& other) noexcept {
        std::swap(file_, other.file_);
        std::swap(isReal_, other.isReal_);
        return *this;
    }
    ~Lock() {
        if (file_ >= 0) {
            ::close(file_);
        }
    }

    /// Nothing where another process has it.
    [[nodiscard]] static Result<std::optional<Lock>> take(const fs::path& folder, const std::string& name, bool alone) {
        constexpr mode_t kMode = 0666; // less the user's mask
        Lock lock(::open((folder / name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode));
        if (lock.file_ < 0) {
            return cannotUse(folder, std::generic_category().message(errno));
        }
        return lock.change(alone) ? std::optional(std::move(lock)) : std::optional<Lock>();
    }
    /// Whether it is had, alone or with others; where not, it is had no longer.
    [[nodiscard]] bool change(bool alone) {
        isReal_ = ::flock(file_, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0;
        // Some file systems know no locks. Nothing is lost without: a chunk that is done twice is the same twice.
        return isReal_ || errno != EWOULDBLOCK;
    }
    /// Whether the file system knows locks.
    [[nodiscard]] bool isReal() const noexcept { return isReal_; }

  private:
    int file_;
    bool isReal_ = false;
};

namespace {

/// For a lock that another process has for as long as it takes to remove or write files.
class Waiting {
  public:
    /// Waits, at first hardly; false: long enough.
    [[nodiscard]] bool goesOn() {
        constexpr int kTries = 40;
        constexpr auto kWait = std::chrono::milliseconds(50);
        std::this_thread::sleep_for(tries_ == 0 ? kWait / 50 : kWait);
        return tries_++ < kTries;
    }

  private:
    int tries_ = 0;
};

} // namespace

RunFolder::RunFolder(fs::path path, RunManifest manifest)
    : path_(std::move(path)), manifest_(std::move(manifest)), id_(manifest_.id()) {}
RunFolder::RunFolder(RunFolder&&) noexcept = default;
RunFolder& RunFolder::operator=(RunFolder&&) noexcept = default;
RunFolder::~RunFolder() = default;

Result<void> RunFolder::lock(const std::optional<Shard>& shard) {
    Result<std::optional<Lock>> whole = Lock::take(path_, kLockName, true);
    VOXTACT_TRY(whole);
    if (*whole && (*whole)->isReal()) {
        removeTemporaryFiles(path_);
    }
    if (shard && (!*whole || !(*whole)->change(false))) {
        whole->reset();
        for (Waiting waiting; !*whole && waiting.goesOn();) {
            whole = Lock::take(path_, kLockName, false);
            VOXTACT_TRY(whole);
        }
    }
    if (!*whole) {
        return cannotUse(path_, shard ? "another process does the whole run; wait for it, or stop it"
                                      : "other processes do this run; wait for them, or stop them");
    }
    locks_.push_back(std::move(**whole));
    if (shard) {
        Result<std::optional<Lock>> own = Lock::take(path_, shardName(*shard), true);
        VOXTACT_TRY(own);
        if (!*own) {
            return cannotUse(path_, "another process does shard " + std::to_string(shard->index) + "/" +
                                        std::to_string(shard->count) + "; wait for it, or stop it");
        }
        locks_.push_back(std::move(**own));
    }
    return {};
}

Result<RunFolder> RunFolder::join(const fs::path& path, const RunManifest& manifest) {
    Result<RunManifest> there = readWholeManifest(path);
    VOXTACT_TRY(there);
    const RunManifest here = manifest.asWritten();
    if (const std::string difference = differenceOf(there->facts, here.facts); !difference.empty()) {
        return refuse("--resume: " + folderText(path) + " has another run: " + difference +
                      "; give another folder, or what it has");
    }
    return RunFolder(path, std::move(*there));
}

Result<RunFolder> RunFolder::open(const fs::path& path, const RunManifest& manifest,
                                  const std::optional<Shard>& shard) {
    VOXTACT_TRY(prepare(path));
    VOXTACT_TRY(place(path, manifest));
    const Result<bool> writtenAnew = RunFolder(path, manifest.asWritten()).writeAnewIfDamaged();
    VOXTACT_TRY(writtenAnew);
    Result<RunFolder> folder = join(path, manifest);
    VOXTACT_TRY(folder);
    folder->isWrittenAnew_ = *writtenAnew;
    VOXTACT_TRY(folder->lock(shard));
    return folder;
}

Result<bool> RunFolder::writeAnewIfDamaged() const {
    Result<ReadManifest> there = readManifest(path_);
    VOXTACT_TRY(there);
    for (Waiting waiting; there->state != ManifestState::Whole && waiting.goesOn();) {
        const Result<std::optional<Lock>> alone = Lock::take(path_, kLockName, true);
        VOXTACT_TRY(alone);
        if (*alone) {
            return writeAnew();
        }
        there = readManifest(path_);
        VOXTACT_TRY(there);
    }
    if (there->state == ManifestState::Whole) {
        return false;
    }
    return cannotUse(path_, std::string("'") + kManifestName +
                                "' is damaged, and other processes are at work; wait for them, or stop them");
}

/// Expects that no other process is at work. What there is tells whether the manifest that is lost was this one: a
/// chunk's name has a hash of its run's facts, the version among them.
Result<bool> RunFolder::writeAnew() const {
    const Result<ReadManifest> there = readManifest(path_);
    VOXTACT_TRY(there);
    bool others = false;
    bool ours = false;
    std::error_code problem;
    for (fs::directory_iterator entry(path_, problem), end; !problem && entry != end; entry.increment(problem)) {
        const std::string name = entry->path().filename().string();
        if (name != kManifestName && !isPreparation(name)) {
            (isChunk(name) ? ours : others) = true;
        }
    }
    if (problem) {
        return cannotUse(path_, problem.message());
    }
    if (there->state == ManifestState::Whole || (there->state == ManifestState::OfAnotherVersion && !ours)) {
        return false;
    }
    if (others && !ours) {
        return cannotUse(path_, std::string("'") + kManifestName +
                                    "' is damaged, and no chunk there is of this command; give the one that made it, "
                                    "with the --count that answered, or a new folder");
    }
    VOXTACT_TRY(writeManifest(path_ / kManifestName, manifest_));
    return true;
}

Result<RunFolder> RunFolder::read(const fs::path& path) {
    const Result<bool> there = isFile(path / kManifestName);
    VOXTACT_TRY(there);
    if (!*there) {
        return Error{ErrorCode::File, 0,
                     "cannot merge " + folderText(path) + ": it is no folder of a run, as detect --resume makes it"};
    }
    Result<RunManifest> manifest = readWholeManifest(path);
    VOXTACT_TRY(manifest);
    return RunFolder(path, std::move(*manifest));
}

fs::path RunFolder::chunkPath(std::uint64_t chunk, const RunOutput& output) const {
    constexpr std::size_t kDigits = 8;
    constexpr std::size_t kHash = 16;
    std::string number = std::to_string(chunk);
    number.insert(0, number.size() < kDigits ? kDigits - number.size() : 0, '0');
    return path_ / (number + "-" + hashOf(id_ + " " + number).substr(0, kHash) + "." + output.name());
}

bool RunFolder::isChunk(const std::string& name) const {
    std::uint64_t chunk = 0;
    std::from_chars(name.data(), name.data() + name.size(), chunk);
    return std::ranges::any_of(manifest_.outputs,
                               [&](const RunOutput& output) { return chunkPath(chunk, output).filename() == name; });
}

std::string RunFolder::chunkLine(std::uint64_t chunk, const RunOutput& output) const {
    return "voxtact chunk " + id_ + " " + std::to_string(chunk) + " " + output.name();
}

ChunkState RunFolder::stateOf(std::uint64_t chunk) const {
    ChunkState state = ChunkState::Whole;
    for (const RunOutput& output : manifest_.outputs) {
        switch (readSealed(chunkPath(chunk, output), chunkLine(chunk, output))) {
        case SealState::Damaged:
            return ChunkState::Damaged;
        case SealState::Missing:
            state = ChunkState::Missing;
            break;
        case SealState::Whole:
            break;
        }
    }
    return state;
}

std::uint64_t RunFolder::chunksThere() const {
    std::uint64_t there = 0;
    for (std::uint64_t chunk = 0; chunk < manifest_.chunks; ++chunk) {
        there += std::ranges::all_of(manifest_.outputs, [&](const RunOutput& output) {
            std::error_code ignored;
            return fs::is_regular_file(chunkPath(chunk, output), ignored);
        });
    }
    return there;
}

std::vector<Shard> RunFolder::shards() const {
    std::vector<Shard> found;
    std::error_code problem;
    for (fs::directory_iterator entry(path_, problem), end; !problem && entry != end; entry.increment(problem)) {
        const std::string name = entry->path().filename().string();
        Shard shard;
        const std::string_view rest = std::string_view(name).substr(std::min(name.size(), kShardName.size()));
        const auto [index, bad] = std::from_chars(rest.data(), rest.data() + rest.size(), shard.index);
        const std::size_t of = name.find("-of-");
        if (!name.starts_with(kShardName) || of == std::string::npos || bad != std::errc()) {
            continue;
        }
        std::from_chars(name.data() + of + 4, name.data() + name.size(), shard.count);
        if (shardName(shard) == name && shard.index >= 1 && shard.index <= shard.count) {
            found.push_back(shard);
        }
    }
    std::sort(found.begin(), found.end(),
              [](const Shard& a, const Shard& b) { return std::pair(a.count, a.index) < std::pair(b.count, b.index); });
    return found;
}

std::pair<std::uint64_t, std::uint64_t> chunksOf(const Shard& shard, std::uint64_t chunks) {
    // No product of two large numbers: shards differ by one chunk at most.
    const std::uint64_t each = chunks / shard.count;
    const std::uint64_t more = chunks % shard.count;
    const auto begin = [&](std::uint64_t index) { return index * each + std::min(index, more); };
    return {begin(shard.index - 1), begin(shard.index)};
}

std::string folderText(const fs::path& path) {
    return "'" + path.string() + "'";
}

} // namespace voxtact::app
