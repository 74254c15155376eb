// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect/detect_run.h"

#include <memory>
#include <span>

namespace voxtact::app {

struct ChunkFiles;
struct RunOutput;

/// Clearances or areas whose bounds are farther apart than the tolerance.
struct OpenBounds {
    const char* what = "clearances";
    std::uint64_t rows = 0; ///< all of them
    std::uint64_t rounding = 0;
    std::uint64_t budget = 0;

    void add(const OpenBounds& more);
    /// Empty: there are none.
    [[nodiscard]] std::string note() const;
};

/// What `voxtact detect` writes: rows on standard output as they come, files when all is done and well, all of them or
/// none. Thread-safety: none; one thread at a time.
class DetectOutput {
  public:
    /// Opens the files. Both must outlive it. Wants begin() before the rest.
    [[nodiscard]] static Result<DetectOutput> create(const DetectOptions& options, const DetectInputs& inputs);
    /// Of a chunk: files without what is before and behind the rows. finish() seals them; standard output has nothing.
    [[nodiscard]] static Result<DetectOutput> createChunk(const DetectOptions& options, const DetectInputs& inputs,
                                                          const ChunkFiles& files);
    DetectOutput(DetectOutput&&) noexcept;
    ~DetectOutput();

    /// Who answers: for JSON.
    void begin(const std::string& device, const std::string& driver);
    /// The next rows.
    [[nodiscard]] Result<void> add(std::span<const Row> rows);
    void addTriangle(const Row& row, const TouchedTriangle& touched);
    void addLabelClearance(const Row& row, const LabelClearance& clearance);
    void addLabelArea(const Row& row, const LabelArea& area);
    void addTriangleArea(const Row& row, const TriangleArea& area);
    /// False: as many are kept as there is room for.
    [[nodiscard]] bool keepContact(const Row& row, const Contact& contact);
    void countContacts(std::uint64_t found) noexcept;
    /// For --stats.
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
    [[nodiscard]] OpenBounds clearanceEnds() const;
    [[nodiscard]] OpenBounds areaEnds() const;
    [[nodiscard]] OpenBounds labelAreaEnds() const;

    struct State;

  private:
    explicit DetectOutput(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// What a run in chunks makes of the options: the table, and the files beside it.
[[nodiscard]] std::vector<RunOutput> runOutputs(const DetectOptions& options, const DetectInputs& inputs,
                                                const std::string& device, const std::string& driver);

} // namespace voxtact::app
