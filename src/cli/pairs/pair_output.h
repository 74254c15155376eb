// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <memory>
#include <span>

namespace voxtact::app {

/// Bounds that are farther apart than the tolerance.
struct OpenBounds {
    std::uint64_t all = 0;
    std::uint64_t rounding = 0; ///< rounding leaves the rest undecided
    std::uint64_t budget = 0;   ///< the iteration limit was reached

    /// Returns the note; may be empty.
    [[nodiscard]] std::string note(std::string_view question) const;
};

/// Writes rows to standard output immediately, and files, all or none, once the run has succeeded. Thread-safety: none.
class PairOutput {
  public:
    /// Opens the files. Both arguments must outlive the output. Call begin() before other functions.
    [[nodiscard]] static Result<PairOutput> create(const PairOptions& options, const PairInputs& inputs);
    PairOutput(PairOutput&&) noexcept;
    ~PairOutput();

    /// Sets the answering engine, for JSON.
    void begin(const std::string& device, const std::string& driver);
    /// Appends rows.
    [[nodiscard]] Result<void> add(std::span<const Row> rows);
    void addTriangle(const Row& row, const TouchedTriangle& touched);
    /// Appends a row of the table "triangles".
    void addTriangle(const Row& row, const AnswerTable& triangles, std::size_t number);
    /// Appends the witness points of a row.
    void addWitnesses(const Row& row);
    /// Counts why bounds stayed apart.
    void countEnd(bool rounding, bool budget) noexcept;
    /// Returns false if no more contacts fit.
    [[nodiscard]] bool keepContact(const Row& row, const Contact& contact);
    void countContacts(std::uint64_t found) noexcept;
    /// Adds counters, for --stats.
    void addCounters(const CertifiedCounters& counters) noexcept;

    [[nodiscard]] std::uint64_t rows() const noexcept;

    /// Completes the output and renames the files into place. `wallMilliseconds`: for --timing.
    [[nodiscard]] Result<void> finish(double wallMilliseconds);
    /// Completes standard output after an interrupt; writes no file.
    [[nodiscard]] Result<void> breakOff();
    /// After an error: closes a JSON document on standard output, so that it stays readable.
    [[nodiscard]] Result<void> fail();

    /// Returns the note on a truncated list of contacts; empty if all were kept.
    [[nodiscard]] std::string noteOfContacts() const;
    [[nodiscard]] const OpenBounds& openBounds() const noexcept;
    /// Returns the line of --summary.
    [[nodiscard]] std::string summary() const;

    struct State;

  private:
    explicit PairOutput(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::app
