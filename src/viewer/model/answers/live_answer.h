// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/document.h"
#include "voxtact/results.h"

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

/// Answers of the window about its pairs: each mesh and the volume.
namespace voxtact::view {

/// Maximum contacts in picture and list.
inline constexpr std::size_t kShownContacts = 2000;

/// Camera of projections that use one, as in `voxtact count`.
[[nodiscard]] View answerView(const Grid& grid);

/// A question about all instruments of an edit, by one method.
struct LiveQuestion {
    std::uint64_t revision = 0; ///< its answer has the same
    Edit edit;
    MethodChoice method;
};

/// Answer about one mesh.
struct MeshAnswer {
    Instrument instrument; ///< that was asked about
    PairAnswer pair;
    std::vector<std::uint32_t> triangles; ///< numbers of those with passing fragments
    std::vector<Contact> contacts;        ///< the deepest first, at most kShownContacts
    std::uint64_t contactsFound = 0;      ///< of a truncated list of the batch: the pair's count
    std::vector<LabelCount> labels;       ///< touched labels, largest count first
};

struct LiveAnswer {
    std::uint64_t revision = 0;     ///< of the question
    std::vector<MeshAnswer> meshes; ///< in the order of the question
    double milliseconds = 0;        ///< duration: wall clock on the host; a device's own clock if it has one

    /// Answer about a mesh, by its index in Sources::meshes. Null if it was not tested.
    [[nodiscard]] const MeshAnswer* of(std::size_t mesh) const noexcept;
};

/// Answer of a batch with one pair per instrument, in order.
[[nodiscard]] LiveAnswer liveAnswer(BatchAnswer batch, std::uint64_t revision, std::span<const Instrument> instruments,
                                    double milliseconds);

/// "yes", "no" or "undecided".
[[nodiscard]] const char* verdict(const PairAnswer& answer) noexcept;
/// "at least 3 certified cells", "1 fragment".
[[nodiscard]] std::string countText(const PairAnswer& answer);
/// "12 triangles, deepest 3.2 mm".
[[nodiscard]] std::string trianglesText(const MeshAnswer& answer);
/// Number as in `voxtact count`: 0, 1, or 2 for undecided.
[[nodiscard]] int hitNumber(const PairAnswer& answer) noexcept;

/// The times of the last 1,000 answers.
class Times {
  public:
    void add(double milliseconds);
    [[nodiscard]] std::size_t count() const { return last_.size(); }
    /// Nearest-rank percentile: the smallest time that at least this share (0..1) does not exceed. 0 without times.
    [[nodiscard]] double percentile(double share) const;
    /// In their order.
    [[nodiscard]] const std::deque<double>& last() const { return last_; }

  private:
    std::deque<double> last_;
};

/// Answers of the last seconds: an answer is visible until the next one.
class Strip {
  public:
    static constexpr double kSeconds = 10; ///< seconds before now

    /// Records a displayed answer. `when`: seconds of a clock, not decreasing. `hit`: like hitNumber().
    void add(double when, int hit, double milliseconds);

    struct Piece {
        double from = 0; ///< seconds before now, up to kSeconds
        double to = 0;   ///< the same, less than `from`
        int hit = 0;
        double milliseconds = 0; ///< that the answer took
    };
    /// The oldest first. `now`: on the same clock.
    [[nodiscard]] std::vector<Piece> pieces(double now) const;

  private:
    struct Entry {
        double when = 0;
        int hit = 0;
        double milliseconds = 0;
    };
    std::deque<Entry> entries_;
};

} // namespace voxtact::view
