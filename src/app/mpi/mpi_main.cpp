// SPDX-License-Identifier: MIT
// voxtact-mpi: detect, motion and plan over the ranks of an MPI job. The first rank makes the folder of the run, deals
// its chunks, does some itself, and merges.
#include "app/mpi/mpi_dealer.h"
#include "app/mpi/rank_report.h"
#include "app/output/notes.h"
#include "app/output/outcome.h"
#include "app/output/standard_streams.h"
#include "app/program.h"
#include "device/vulkan_device.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <thread>
#include <unistd.h>

namespace voxtact::app {

namespace {

using Words = std::vector<std::string>;

constexpr const char* kUsage =
    R"(voxtact-mpi: detect, motion and plan over the ranks of an MPI job.

Usage:
  mpirun -n N voxtact-mpi detect ... --resume DIR [--output PATH]
  mpirun -n N voxtact-mpi motion ... --resume DIR [--output PATH]
  mpirun -n N voxtact-mpi plan ... --resume DIR [--output PATH]

The options are those of voxtact; DIR must be the same folder for all ranks. The first rank deals the chunks, shows the
progress of the whole run, and writes its output once all is done; what each rank did is said at the end. A job that was
ended goes on when it is begun again, with any number of ranks. --threads is of each rank. On a machine with several
GPUs each rank has one of its own, unless --device says which.
)";

bool isGiven(const Words& words, const std::string& option) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return word == option || word.starts_with(option + "="); });
}

/// What is wrong with the arguments beyond what the program itself would find; empty: nothing.
std::string refusalOf(const Words& words) {
    if (words.empty() || (words.front() != "detect" && words.front() != "motion" && words.front() != "plan")) {
        return "the ranks of a job do detect, motion or plan; for anything else there is voxtact; see voxtact-mpi "
               "--help";
    }
    if (isGiven(words, "--shard")) {
        return "--shard: the first rank deals the chunks; leave it out";
    }
    return isGiven(words, "--resume") ? "" : "--resume is required: the folder where the ranks put their chunks";
}

/// Of several GPUs of this machine the one of this rank.
void addDevice(Words& words) {
    if (words.front() != "detect" || isGiven(words, "--device")) {
        return;
    }
    MPI_Comm machine = MPI_COMM_NULL;
    int rank = 0;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &rank);
    MPI_Comm_free(&machine);
    const Result<device::VulkanInstance> instance = device::VulkanInstance::create({});
    const auto devices =
        instance.ok() ? instance->devices() : Result<std::vector<device::PhysicalDevice>>(instance.error());
    if (!devices.ok()) {
        return; // without Vulkan the host answers, or the program says why it cannot
    }
    std::vector<bool> isGpu;
    for (const device::PhysicalDevice& one : *devices) {
        isGpu.push_back(one.type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ||
                        one.type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);
    }
    if (const std::optional<std::size_t> own = deviceOfRank(isGpu, rank)) {
        words.insert(words.end(), {"--device", std::to_string(*own)});
    }
}

/// Takes standard error while it lives, so that of many ranks only one says what all have to say.
class HeldErrors {
  public:
    HeldErrors() : file_(std::tmpfile()), old_(::dup(STDERR_FILENO)) {
        if (file_ != nullptr) {
            ::dup2(::fileno(file_), STDERR_FILENO);
        }
    }
    HeldErrors(const HeldErrors&) = delete;
    HeldErrors& operator=(const HeldErrors&) = delete;
    ~HeldErrors() {
        ::dup2(old_, STDERR_FILENO);
        ::close(old_);
        if (file_ != nullptr) {
            static_cast<void>(std::fclose(file_));
        }
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        if (file_ != nullptr) {
            std::rewind(file_);
            std::array<char, 4096> part{};
            while (const std::size_t got = std::fread(part.data(), 1, part.size(), file_)) {
                all.append(part.data(), got);
            }
        }
        return all;
    }

  private:
    std::FILE* file_;
    int old_;
};

int runOther(const Words& words) {
    DeckAsker asker;
    useDealer(&asker);
    const HeldErrors errors;
    std::string notes;
    useNotes([&](const std::string& note) { notes += note + "\n"; });
    const int status = runProgram(words);
    useNotes({});
    const bool good = status == kExitDone && asker.ended();
    const std::string end = RankEnd{status, asker.ended(), good ? notes : errors.text()}.message();
    MPI_Send(end.data(), static_cast<int>(end.size()), MPI_BYTE, 0, kEndTag, MPI_COMM_WORLD);
    return status;
}

/// What the first rank does for the others, in addition to its own share.
class Service {
  public:
    Service(DeckHolder& deck, int ranks) : deck_(deck), ranks_(ranks), works_(static_cast<std::size_t>(ranks)) {}

    /// Until the program, which runs in another thread, has ended: `status` is then no longer kRunning.
    [[nodiscard]] int serve(const std::atomic<int>& status);
    void addNote(const std::string& note) { notes_.add(0, note); } ///< of the program, while it runs
    void sayNotes() const;
    void sayWork() const;

    static constexpr int kRunning = -1;

  private:
    [[nodiscard]] bool takeMessage();
    [[nodiscard]] bool takeEnd();
    void answer(int rank, std::int64_t number) const {
        MPI_Send(&number, 1, MPI_INT64_T, rank, kAnswerTag, MPI_COMM_WORLD);
    }

    DeckHolder& deck_;
    int ranks_;
    std::vector<RankWork> works_;
    std::vector<int> waiting_; ///< to begin
    int ended_ = 0;            ///< that ask for no more chunks
    int reported_ = 0;         ///< whose program has ended
    std::vector<std::pair<int, std::string>> otherNotes_;
    RankNotes notes_;
    bool over_ = false; ///< nothing is dealt any more
    std::string failure_;
    int failureStatus_ = 0;
};

bool Service::takeMessage() {
    int there = 0;
    MPI_Status about;
    MPI_Iprobe(MPI_ANY_SOURCE, kMessageTag, MPI_COMM_WORLD, &there, &about);
    if (there == 0) {
        return false;
    }
    RankMessage message;
    const int rank = about.MPI_SOURCE;
    MPI_Recv(&message, sizeof message, MPI_BYTE, rank, kMessageTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (message.kind == RankMessage::Hello) {
        waiting_.push_back(rank);
    } else if (message.kind == RankMessage::Ask) {
        const std::optional<std::uint64_t> chunk = over_ ? std::nullopt : deck_.deal(rank);
        answer(rank, chunk ? static_cast<std::int64_t>(*chunk) : kNone);
    } else {
        works_[static_cast<std::size_t>(rank)] = message.work;
        ++ended_;
    }
    return true;
}

bool Service::takeEnd() {
    int there = 0;
    MPI_Status about;
    MPI_Iprobe(MPI_ANY_SOURCE, kEndTag, MPI_COMM_WORLD, &there, &about);
    if (there == 0) {
        return false;
    }
    int size = 0;
    MPI_Get_count(&about, MPI_BYTE, &size);
    std::string message(static_cast<std::size_t>(size), '\0');
    MPI_Recv(message.data(), size, MPI_BYTE, about.MPI_SOURCE, kEndTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    const RankEnd end = RankEnd::of(message);
    ++reported_;
    ended_ += end.done ? 0 : 1;
    if (end.status == kExitDone && end.done) {
        otherNotes_.emplace_back(about.MPI_SOURCE, end.text);
    } else if (failure_.empty()) {
        failureStatus_ = std::max(end.status, kExitFailed);
        failure_ = "rank " + std::to_string(about.MPI_SOURCE) + ": " + oneLine(end.text);
    }
    return true;
}

int Service::serve(const std::atomic<int>& status) {
    constexpr auto kWait = std::chrono::microseconds(200);
    constexpr auto kPatience = std::chrono::seconds(10);
    std::optional<std::chrono::steady_clock::time_point> last;
    while (true) {
        const int now = status;
        while (takeMessage() || takeEnd()) {
        }
        if (now > kExitDone && !last) {
            // It has said why. The others may have found the same, or are in the middle of a chunk.
            over_ = true;
            last = std::chrono::steady_clock::now() + kPatience;
        }
        for (const int rank : deck_.ready() || over_ ? waiting_ : std::vector<int>()) {
            answer(rank, over_ ? kNone : kGo);
        }
        waiting_.erase(waiting_.begin(), deck_.ready() || over_ ? waiting_.end() : waiting_.begin());
        if (reported_ == ranks_ - 1 && now != kRunning) {
            return now;
        }
        if (ended_ == ranks_ - 1 && failure_.empty()) {
            deck_.othersEnded();
        }
        if (!failure_.empty() && !over_ && deck_.ready()) {
            // Of arguments and inputs the first rank would have found the same: this is about one rank.
            printError("", failure_);
            MPI_Abort(MPI_COMM_WORLD, failureStatus_);
        }
        if (last && std::chrono::steady_clock::now() > *last) {
            MPI_Abort(MPI_COMM_WORLD, now);
        }
        std::this_thread::sleep_for(kWait);
    }
}

void Service::sayNotes() const {
    RankNotes all = notes_;
    for (const auto& [rank, text] : otherNotes_) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            all.add(rank, line);
        }
    }
    for (const std::string& line : all.lines(ranks_)) {
        printNote(line);
    }
}

void Service::sayWork() const {
    for (int rank = 0; rank < ranks_; ++rank) {
        const RankWork& work = rank == 0 ? deck_.work() : works_[static_cast<std::size_t>(rank)];
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "rank %d: %llu chunks, %.1f s busy, %.1f s idle", rank,
                      static_cast<unsigned long long>(work.chunks), work.seconds,
                      std::max(deck_.seconds() - work.seconds, 0.0));
        printNote(line.data());
    }
    if (deck_.found() > 0) {
        printNote(std::to_string(deck_.found()) + " chunks were there already");
    }
}

int runFirst(const Words& words, int ranks) {
    DeckHolder deck;
    useDealer(&deck);
    Service service(deck, ranks);
    std::atomic<int> ended{Service::kRunning};
    // Said at the end, with those of the others.
    useNotes([&](const std::string& note) { service.addNote(note); });
    std::thread program([&] { ended = runProgram(words); });
    const int status = service.serve(ended);
    program.join();
    useNotes({});
    service.sayNotes();
    if (status == kExitDone) {
        service.sayWork();
    }
    return status;
}

int runRank(Words words) {
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const bool help = words.empty() || isGiven(words, "--help") || isGiven(words, "-h");
    if (help || isGiven(words, "--version")) {
        if (rank != 0) {
            return kExitDone;
        }
        return words.size() > 1 || !help          ? runProgram(words)
               : writeStandardOutput(kUsage).ok() ? kExitDone
                                                  : kExitFailed;
    }
    if (const std::string refusal = refusalOf(words); !refusal.empty()) {
        if (rank == 0) {
            printError("", refusal);
        }
        return kExitArguments;
    }
    addDevice(words);
    return rank == 0 ? runFirst(words, ranks) : runOther(words);
}

} // namespace

} // namespace voxtact::app

int main(int argc, char** argv) {
    voxtact::app::claimStandardStreams();
    int provided = 0;
    // One thread of the first rank calls MPI, and another one works.
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    const int status = voxtact::app::runRank({argv + std::min(argc, 1), argv + argc});
    MPI_Finalize();
    return status;
}
