// SPDX-License-Identifier: MIT
#include "app/detect/detect_output.h"

#include "app/chunks/run_chunks.h"
#include "app/detect/detect_files.h"
#include "app/detect/detect_table.h"
#include "app/detect/side_files.h"
#include "app/output/standard_streams.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"
#include "io/text/table.h"
#include "voxtact/io.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

/// Columns of text are as wide as what is in them: a screen of rows is waited for before they are settled, and more
/// where they come fast, but not long.
constexpr auto kTextWait = std::chrono::milliseconds(300);
constexpr auto kLongTextWait = std::chrono::seconds(3);
constexpr std::size_t kFewTextRows = 32;
constexpr std::size_t kManyTextRows = 4096;

/// Of ClearanceEnd, and of AreaEnd.
constexpr std::size_t kClearanceEnds = static_cast<std::size_t>(ClearanceEnd::Budget) + 1;
constexpr std::size_t kAreaEnds = static_cast<std::size_t>(AreaEnd::Budget) + 1;

} // namespace

struct DetectOutput::State {
    State(const DetectOptions& how, const DetectInputs& what)
        : options(how), inputs(what), format(how.output.format()), columns(how, what),
          // What validation says decides whether there is a table at all.
          held(how.output.path.empty() && how.device.validate) {}

    void keepMeasured(std::span<const Row> part);
    Result<void> writeRows(std::span<const Row> part);
    Result<void> writeHeld();
    Result<void> pass();
    std::ostream& out() { return table ? table->stream() : text; }
    /// Null where it is not asked for.
    std::ostream* side(SideFile which) {
        std::optional<ResultFile>& file = sides[static_cast<std::size_t>(which)];
        return file ? &file->stream() : nullptr;
    }
    /// All of them, that of the rows first.
    std::vector<ResultFile*> files();

    const DetectOptions& options;
    const DetectInputs& inputs;
    io::Format format;
    DetectColumns columns;
    bool held;
    TextStream text{}; ///< on its way to standard output
    std::optional<ResultFile> table{};
    std::optional<ResultFile> contactsFile{};
    std::array<std::optional<ResultFile>, kSideFiles> sides{};
    bool chunk = false; ///< rows alone: what is before and behind them is the run's
    std::optional<io::TableWriter> writer{};
    io::NamedCells facts{};
    std::vector<Row> waiting{}; ///< rows of text before its columns are settled
    std::optional<Clock::time_point> firstWaiting{};
    std::uint64_t rows = 0;
    std::vector<KeptContact> contacts{};
    std::vector<KeptBounds> bounds{};
    std::uint64_t contactsFound = 0;
    CertifiedCounters counters{}; ///< for --stats
    std::vector<KeptClosest> closest{};
    std::array<std::uint64_t, kClearanceEnds> ends{}; ///< rows by why their bounds are no nearer to each other
    std::array<std::uint64_t, kAreaEnds> areaEnds{};
    std::array<std::uint64_t, kAreaEnds> labelAreaEnds{};
};

std::vector<ResultFile*> DetectOutput::State::files() {
    std::vector<ResultFile*> all;
    const auto add = [&all](std::optional<ResultFile>& file) {
        if (file) {
            all.push_back(&*file);
        }
    };
    add(table);
    add(contactsFile);
    std::ranges::for_each(sides, add);
    return all;
}

void DetectOutput::State::keepMeasured(std::span<const Row> part) {
    for (const Row& row : part) {
        if (row.area) {
            ++areaEnds[static_cast<std::size_t>(row.area->end)];
        }
        if (!row.clearance) {
            continue;
        }
        ++ends[static_cast<std::size_t>(row.clearance->end)];
        if (side(SideFile::Closest) != nullptr && row.clearance->closest) {
            closest.push_back({*row.clearance->closest, row.clearance->bounds, row.job, row.pose});
        }
    }
}

Result<void> DetectOutput::State::writeRows(std::span<const Row> part) {
    io::Table rowsTable = columns.table(part);
    rowsTable.facts = facts;
    writer->add(rowsTable);
    return pass();
}

Result<void> DetectOutput::State::writeHeld() {
    const std::vector<Row> all = std::move(waiting);
    waiting.clear();
    return writeRows(all);
}

/// Hands on what has been written.
Result<void> DetectOutput::State::pass() {
    if (table) {
        // A disk that is full now will not have room for the rest.
        return table->stream() ? Result<void>() : table->close();
    }
    if (held) {
        return {};
    }
    const std::string part = text.str();
    text.str({});
    return writeStandardOutput(part);
}

DetectOutput::DetectOutput(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
DetectOutput::DetectOutput(DetectOutput&&) noexcept = default;
DetectOutput::~DetectOutput() = default;

Result<DetectOutput> DetectOutput::create(const DetectOptions& options, const DetectInputs& inputs) {
    auto state = std::make_unique<State>(options, inputs);
    const auto open = [](const std::filesystem::path& path, std::optional<ResultFile>& file) -> Result<void> {
        if (path.empty()) {
            return {};
        }
        Result<ResultFile> opened = ResultFile::create(path);
        VOXTACT_TRY(opened);
        file = std::move(*opened);
        return {};
    };
    VOXTACT_TRY(open(options.output.path, state->table));
    VOXTACT_TRY(open(options.extra.contacts, state->contactsFile));
    for (std::size_t i = 0; i < kSideFiles; ++i) {
        const SideFileFacts& facts = sideFileTable()[i];
        VOXTACT_TRY(open(facts.path(options), state->sides[i]));
        if (state->sides[i] && !facts.comesLast) {
            facts.header(state->sides[i]->stream(), options, inputs);
        }
    }
    state->writer.emplace(state->out(), state->format);
    return DetectOutput(std::move(state));
}

Result<DetectOutput> DetectOutput::createChunk(const DetectOptions& options, const DetectInputs& inputs,
                                               const ChunkFiles& files) {
    auto state = std::make_unique<State>(options, inputs);
    state->chunk = true;
    Result<ResultFile> table = files.create("--output");
    VOXTACT_TRY(table);
    state->table = std::move(*table);
    for (std::size_t i = 0; i < kSideFiles; ++i) {
        if (!sideFileTable()[i].path(options).empty()) {
            Result<ResultFile> side = files.create(sideFileTable()[i].option);
            VOXTACT_TRY(side);
            state->sides[i] = std::move(*side);
        }
    }
    state->writer.emplace(state->out(), state->format);
    state->writer->omitHead();
    return DetectOutput(std::move(state));
}

std::vector<RunOutput> runOutputs(const DetectOptions& options, const DetectInputs& inputs, const std::string& device,
                                  const std::string& driver) {
    const DetectColumns columns(options, inputs);
    io::Table empty = columns.table({});
    empty.facts = detectFacts(device, driver);
    std::vector<RunOutput> outputs{tableOutput(options.output.format(), empty)};
    for (const SideFileFacts& side : sideFileTable()) {
        if (!side.path(options).empty()) {
            TextStream head;
            side.header(head, options, inputs);
            outputs.push_back({side.option, side.ending, head.str(), "", ""});
        }
    }
    return outputs;
}

void DetectOutput::begin(const std::string& device, const std::string& driver) {
    state_->facts = detectFacts(device, driver);
}

Result<void> DetectOutput::add(std::span<const Row> rows) {
    State& state = *state_;
    state.rows += rows.size();
    if (state.options.extra.asked.bounds && !state.options.extra.contacts.empty()) {
        for (const Row& row : rows) {
            const std::optional<Box> bounds = boundsOf(row.extra);
            if (bounds && state.bounds.size() < state.options.extra.contactRoom()) {
                state.bounds.push_back({*bounds, row.job, row.pose});
            }
        }
    }
    state.keepMeasured(rows);
    if (state.format != io::Format::Text) {
        return state.writeRows(rows);
    }
    const Clock::time_point now = Clock::now();
    if (!state.firstWaiting) {
        state.firstWaiting = now;
    }
    state.waiting.insert(state.waiting.end(), rows.begin(), rows.end());
    const bool wait = now - *state.firstWaiting < (state.waiting.size() < kFewTextRows ? kLongTextWait : kTextWait) &&
                      state.waiting.size() < kManyTextRows;
    return wait ? Result<void>() : state.writeHeld();
}

void DetectOutput::addTriangle(const Row& row, const TouchedTriangle& touched) {
    if (std::ostream* const out = state_->side(SideFile::Triangles)) {
        writeTriangle(*out, state_->options, row, touched);
    }
}

void DetectOutput::addLabelClearance(const Row& row, const LabelClearance& clearance) {
    if (std::ostream* const out = state_->side(SideFile::LabelClearance)) {
        writeLabelClearance(*out, state_->options, state_->inputs, row, clearance);
    }
}

void DetectOutput::addLabelArea(const Row& row, const LabelArea& area) {
    if (std::ostream* const out = state_->side(SideFile::LabelArea)) {
        ++state_->labelAreaEnds[static_cast<std::size_t>(area.end)];
        writeLabelArea(*out, state_->options, state_->inputs, row, area);
    }
}

void DetectOutput::addTriangleArea(const Row& row, const TriangleArea& area) {
    if (std::ostream* const out = state_->side(SideFile::TriangleArea)) {
        writeTriangleArea(*out, state_->options, row, area);
    }
}

bool DetectOutput::keepContact(const Row& row, const Contact& contact) {
    if (state_->contacts.size() >= state_->options.extra.contactRoom()) {
        return false;
    }
    state_->contacts.push_back({contact, row.job, row.pose});
    return true;
}

void DetectOutput::countContacts(std::uint64_t found) noexcept {
    state_->contactsFound += found;
}

void DetectOutput::addCounters(const CertifiedCounters& counters) noexcept {
    state_->counters = together(state_->counters, counters);
}

std::uint64_t DetectOutput::rows() const noexcept {
    return state_->rows;
}

Result<void> DetectOutput::finish(double wallMilliseconds) {
    State& state = *state_;
    VOXTACT_TRY(state.writeHeld());
    io::NamedCells timing;
    if (state.options.timing) {
        const double seconds = wallMilliseconds / 1000;
        const double rate = seconds > 0 ? static_cast<double>(state.rows) / seconds : 0;
        timing = {
            {"pairs", state.rows}, {"wall_ms", rounded(wallMilliseconds, 1e6)}, {"pairs_per_s", rounded(rate, 10)}};
    }
    const io::TableEnd ends[] = {{"stats", state.options.stats ? statsCells(state.counters) : io::NamedCells()},
                                 {"timing", std::move(timing)}};
    if (!state.chunk) {
        state.writer->end(ends);
    }
    if (state.contactsFile) {
        writeContacts(state.contactsFile->stream(), state.options, state.inputs, {state.contacts, state.bounds});
    }
    if (std::ostream* const out = state.side(SideFile::Closest)) {
        const auto write = state.chunk ? writeClosestRows : writeClosest;
        write(*out, state.options, state.inputs, state.closest);
    }
    // Nothing gets its name before all is written. What is on standard output cannot be taken back, and may fail.
    for (ResultFile* const file : state.files()) {
        VOXTACT_TRY(file->close());
    }
    state.held = false;
    VOXTACT_TRY(state.table ? Result<void>() : state.pass());
    std::vector<io::OutputFile*> all;
    for (ResultFile* const file : state.files()) {
        if (file->file() != nullptr) {
            all.push_back(file->file());
        }
    }
    // The table is the last to get its name: where it is, all of them are.
    std::ranges::reverse(all);
    return io::OutputFile::commitAll(all);
}

Result<void> DetectOutput::fail() {
    return rows() > 0 && state_->format == io::Format::Json ? breakOff() : Result<void>();
}

Result<void> DetectOutput::breakOff() {
    State& state = *state_;
    if (state.table) {
        return {};
    }
    state.held = false;
    VOXTACT_TRY(state.writeHeld());
    state.writer->end({}, false);
    return state.pass();
}

std::string DetectOutput::noteOfContacts() const {
    const State& state = *state_;
    if (state.contactsFound <= state.contacts.size()) {
        return {};
    }
    return state.options.extra.contacts.string() + ": " + std::to_string(state.contacts.size()) + " of " +
           std::to_string(state.contactsFound) + " contacts were kept (--most-contacts " +
           std::to_string(state.options.extra.contactRoom()) + ")";
}

OpenBounds DetectOutput::clearanceEnds() const {
    const auto of = [&](ClearanceEnd end) { return state_->ends[static_cast<std::size_t>(end)]; };
    return {"clearances", state_->rows, of(ClearanceEnd::Rounding), of(ClearanceEnd::Budget)};
}

OpenBounds DetectOutput::areaEnds() const {
    const auto of = [&](AreaEnd end) { return state_->areaEnds[static_cast<std::size_t>(end)]; };
    return {"areas", state_->rows, of(AreaEnd::Rounding), of(AreaEnd::Budget)};
}

OpenBounds DetectOutput::labelAreaEnds() const {
    const auto of = [&](AreaEnd end) { return state_->labelAreaEnds[static_cast<std::size_t>(end)]; };
    return {"areas in labels", of(AreaEnd::Closed) + of(AreaEnd::Rounding) + of(AreaEnd::Budget), of(AreaEnd::Rounding),
            of(AreaEnd::Budget)};
}

void OpenBounds::add(const OpenBounds& more) {
    what = more.what;
    rows += more.rows;
    rounding += more.rounding;
    budget += more.budget;
}

std::string OpenBounds::note() const {
    if (rounding + budget == 0) {
        return {};
    }
    return "the bounds of " + std::to_string(rounding + budget) + " of " + std::to_string(rows) + " " + what +
           " are farther apart than the tolerance: rounding decides " + std::to_string(rounding) + " of them, " +
           std::to_string(budget) + " took too many steps";
}

} // namespace voxtact::app
