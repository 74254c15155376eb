// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <memory>
#include <span>

namespace voxtact::app {

/// Distances or areas whose bounds are farther apart than the tolerance.
struct OpenBounds {
    std::uint64_t all = 0;
    std::uint64_t rounding = 0; ///< rounding leaves the rest undecided
    std::uint64_t budget = 0;   ///< the iteration limit was reached

    /// Returns the note; may be empty.
    [[nodiscard]] std::string note(Question question) const;
};

/// Writes rows to standard output as they come, and files, all or none, once the run has succeeded. Thread-safety:
/// none.
class PairOutput {
  public:
    /// Opens the files. Both must outlive it. Wants begin() before the rest.
    [[nodiscard]] static Result<PairOutput> create(const PairOptions& options, const PairInputs& inputs);
    PairOutput(PairOutput&&) noexcept;
    ~PairOutput();

    /// Who answers: for JSON.
    void begin(const std::string& device, const std::string& driver);
    /// The next rows.
    [[nodiscard]] Result<void> add(std::span<const Row> rows);
    void addTriangle(const Row& row, const TouchedTriangle& touched);
    void addTriangleArea(const Row& row, const TriangleArea& area);
    void addWitnesses(const Row& row, const WitnessPoints& closest, double upper);
    /// Counts why the bounds of a distance or an area are no closer.
    void countEnd(bool rounding, bool budget) noexcept;
    /// False: as many are kept as there is room for.
    [[nodiscard]] bool keepContact(const Row& row, const Contact& contact);
    void countContacts(std::uint64_t found) noexcept;
    /// Adds counters, for --stats.
    void addCounters(const CertifiedCounters& counters) noexcept;

    [[nodiscard]] std::uint64_t rows() const noexcept;

    /// Completes what has been written; the files get their names. `wallMilliseconds` is for --timing.
    [[nodiscard]] Result<void> finish(double wallMilliseconds);
    /// Completes standard output with the rows that there are; no file gets its name.
    [[nodiscard]] Result<void> breakOff();
    /// After an error: ends what standard output has of a JSON document, so that it can be read.
    [[nodiscard]] Result<void> fail();

    /// A list that was cut is still a good run, with fewer contacts than there are; empty: it was not.
    [[nodiscard]] std::string noteOfContacts() const;
    [[nodiscard]] const OpenBounds& openBounds() const noexcept;
    /// The line of --summary.
    [[nodiscard]] std::string summary() const;

    struct State;

  private:
    explicit PairOutput(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::app
