// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_output.h"

#include "cli/files/pair_files.h"
#include "cli/output/result_file.h"
#include "cli/output/standard_streams.h"
#include "cli/pairs/pair_table.h"
#include "cli/pairs/summary.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"
#include "io/text/table.h"
#include "voxtact/io.h"

#include <algorithm>
#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

/// Text columns fit their contents: their widths are fixed after a screen of rows, or more if rows come fast, within a
/// short time.
constexpr auto kTextWait = std::chrono::milliseconds(300);
constexpr auto kLongTextWait = std::chrono::seconds(3);
constexpr std::size_t kFewTextRows = 32;
constexpr std::size_t kManyTextRows = 4096;

} // namespace

struct PairOutput::State {
    State(const PairOptions& how, const PairInputs& what)
        : options(how), inputs(what), format(how.output.format()), columns(how, what),
          // A validation error suppresses the table.
          held(how.output.path.empty() && how.device.validate) {}

    Result<void> writeRows(std::span<const Row> part);
    Result<void> writeHeld();
    Result<void> pass();
    std::ostream& out() { return table ? table->stream() : text; }
    /// Returns all files, that of the rows first.
    std::vector<ResultFile*> files();

    const PairOptions& options;
    const PairInputs& inputs;
    io::Format format;
    PairColumns columns;
    bool held;
    TextStream text{}; ///< pending for standard output
    std::optional<ResultFile> table{};
    std::optional<ResultFile> contactsFile{};
    SideFile sideFacts = sideFile(options);
    std::optional<ResultFile> side{};
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
    OpenBounds open{};
    Summary summary{};
};

std::vector<ResultFile*> PairOutput::State::files() {
    std::vector<ResultFile*> all;
    const auto add = [&all](std::optional<ResultFile>& file) {
        if (file) {
            all.push_back(&*file);
        }
    };
    add(table);
    add(contactsFile);
    add(side);
    return all;
}

Result<void> PairOutput::State::writeRows(std::span<const Row> part) {
    io::Table rowsTable = columns.table(part);
    rowsTable.facts = facts;
    writer->add(rowsTable);
    return pass();
}

Result<void> PairOutput::State::writeHeld() {
    const std::vector<Row> all = std::move(waiting);
    waiting.clear();
    return writeRows(all);
}

/// Writes the pending text to standard output.
Result<void> PairOutput::State::pass() {
    if (table) {
        // After a failure, as on a full disk, the rest would fail, too.
        return table->stream() ? Result<void>() : table->close();
    }
    if (held) {
        return {};
    }
    const std::string part = text.str();
    text.str({});
    return writeStandardOutput(part);
}

PairOutput::PairOutput(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
PairOutput::PairOutput(PairOutput&&) noexcept = default;
PairOutput::~PairOutput() = default;

Result<PairOutput> PairOutput::create(const PairOptions& options, const PairInputs& inputs) {
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
    VOXTACT_TRY(open(state->sideFacts.path, state->side));
    if (state->side && !state->sideFacts.comesLast && options.shard.hasHead()) {
        state->sideFacts.header(state->side->stream(), options, inputs);
    }
    state->writer.emplace(state->out(), state->format);
    if (!options.shard.hasHead()) {
        state->writer->omitHead();
    }
    return PairOutput(std::move(state));
}

void PairOutput::begin(const std::string& device, const std::string& driver) {
    state_->facts = pairFacts(state_->options, device, driver);
}

Result<void> PairOutput::add(std::span<const Row> rows) {
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
    if (state.options.summary) {
        state.summary.add(state.options, rows);
    }
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

void PairOutput::addTriangle(const Row& row, const TouchedTriangle& touched) {
    if (state_->side) {
        writeTriangle(state_->side->stream(), state_->options, row, touched);
    }
}

void PairOutput::addTriangle(const Row& row, const AnswerTable& triangles, std::size_t number) {
    if (state_->side) {
        writeTriangle(state_->side->stream(), state_->options, row, triangles, number);
    }
}

void PairOutput::addWitnesses(const Row& row) {
    if (state_->side) {
        state_->closest.push_back({row.measured.front(), row.job, row.pose});
    }
}

void PairOutput::countEnd(bool rounding, bool budget) noexcept {
    ++state_->open.all;
    state_->open.rounding += rounding ? 1 : 0;
    state_->open.budget += budget ? 1 : 0;
}

bool PairOutput::keepContact(const Row& row, const Contact& contact) {
    if (state_->contacts.size() >= state_->options.extra.contactRoom()) {
        return false;
    }
    state_->contacts.push_back({contact, row.job, row.pose});
    return true;
}

void PairOutput::countContacts(std::uint64_t found) noexcept {
    state_->contactsFound += found;
}

void PairOutput::addCounters(const CertifiedCounters& counters) noexcept {
    state_->counters = together(state_->counters, counters);
}

std::uint64_t PairOutput::rows() const noexcept {
    return state_->rows;
}

Result<void> PairOutput::finish(double wallMilliseconds) {
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
    state.writer->end(ends);
    if (state.contactsFile) {
        writeContacts(state.contactsFile->stream(), state.options, state.inputs, {state.contacts, state.bounds});
    }
    if (state.side && state.sideFacts.comesLast) {
        writeWitnesses(state.side->stream(), state.options, state.inputs, state.closest);
    }
    // Renames files after all are written: standard output may fail and cannot be undone.
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
    // The table is renamed last: if it exists, all files do.
    std::ranges::reverse(all);
    return io::OutputFile::commitAll(all);
}

Result<void> PairOutput::fail() {
    if (state_->format == io::Format::Text && !state_->table && !state_->held) {
        return state_->writeHeld();
    }
    return rows() > 0 && state_->format == io::Format::Json ? breakOff() : Result<void>();
}

Result<void> PairOutput::breakOff() {
    State& state = *state_;
    if (state.table) {
        return {};
    }
    state.held = false;
    VOXTACT_TRY(state.writeHeld());
    state.writer->end({}, false);
    return state.pass();
}

std::string PairOutput::noteOfContacts() const {
    const State& state = *state_;
    if (state.contactsFound <= state.contacts.size()) {
        return {};
    }
    return state.options.extra.contacts.string() + ": " + std::to_string(state.contacts.size()) + " of " +
           std::to_string(state.contactsFound) + " contacts are kept (--max-contacts " +
           std::to_string(state.options.extra.contactRoom()) + ")";
}

const OpenBounds& PairOutput::openBounds() const noexcept {
    return state_->open;
}

std::string PairOutput::summary() const {
    return state_->summary.text(state_->options);
}

std::string OpenBounds::note(std::string_view question) const {
    if (rounding + budget == 0) {
        return {};
    }
    return "the bounds of " + std::to_string(rounding + budget) + " of " + std::to_string(all) + " " +
           std::string(question) + "s are farther apart than the tolerance: rounding leaves " +
           std::to_string(rounding) + " undecided, " + std::to_string(budget) + " reached the iteration limit";
}

} // namespace voxtact::app
