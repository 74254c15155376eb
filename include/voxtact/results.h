// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/device_results.h"
#include "voxtact/methods.h"

#include <cstdint>
#include <optional>
#include <vector>

/// What can be asked for in addition to the count, and the answers in host memory, the same from device and host.
namespace voxtact {

/// What is asked for; fixed for the life of a detector.
struct Outputs {
    bool triangles = false; ///< which triangles have survivors, and how many
    bool contacts = false;  ///< a Contact for each survivor, as many as there is room for
    bool bounds = false;    ///< the world box of the survivors of each pair
    bool labels = false;    ///< survivors by the label of the place where they are; the items need label maps
    /// How far a contact's penetration is followed, mm; positive. Contacts only.
    double maxDepth = kDefaultMaxDepth;

    /// Whether anything is.
    [[nodiscard]] bool any() const noexcept { return triangles || contacts || bounds || labels; }
};

/// What is certain of a pair.
enum class Verdict : std::uint32_t {
    No,        ///< nothing touches: proven
    Yes,       ///< it touches: proven
    Undecided, ///< rounding decides, or the steps that were allowed are used up
};
/// "no", "yes" or "undecided"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Verdict verdict) noexcept;

/// Triangle of a witness point inside the mesh of a question with `solid`: it is on no triangle.
inline constexpr std::uint32_t kInsideMesh = 0xffffffffU;

/// A point that proves a yes.
struct WitnessPoint {
    Vec3 position{};            ///< world mm: opaque, and at most the margin from the triangle, or inside the mesh
    std::uint32_t triangle = 0; ///< number in the mesh, or kInsideMesh
};

/// Whether one pair touches.
struct PairTouch {
    std::uint32_t pair = 0;              ///< number of the pair in its batch
    std::uint32_t item = 0;              ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0;              ///< number of the pose within that item
    Verdict touch = Verdict::No;         ///< within the margin, and at any pose of the uncertainty
    std::optional<WitnessPoint> witness; ///< of a yes, where Touch asks for it
};

/// What a batch gave.
struct TouchAnswer {
    std::vector<PairTouch> pairs; ///< in the order of the batch
    double wallMilliseconds = 0;  ///< of the whole call
};

/// A triangle with at least one survivor.
struct TouchedTriangle {
    std::uint32_t pair = 0;     ///< number of the pair in its batch
    std::uint32_t triangle = 0; ///< number in the mesh
    std::uint32_t count = 0;    ///< its survivors
};

/// One survivor and its place.
struct Contact {
    std::uint32_t pair = 0;     ///< number of the pair in its batch
    std::uint32_t triangle = 0; ///< number in the mesh
    /// World, mm: in an opaque sample up to rounding, and on the triangle to a hundred-thousandth of a voxel and two of
    /// its size, times the ratio of the grid's largest spacing to its smallest, and times the condition number of a
    /// pose that shears or squashes.
    Vec3 position{};
    /// Unit vector in world space, against the gradient of opacity: out of what is opaque. The gradient is of
    /// differences over one voxel to each side, the span clamped to the image; where these vanish the step is doubled,
    /// up to maxDepth. Zero where they all vanish.
    Vec3 normal{};
    /// mm along the normal from the position to where the opacity falls below the threshold, or the image ends. It is
    /// looked for in steps of half the smallest spacing, so that a thinner gap may be missed. No more than 16,384 steps
    /// are taken: they get longer where the way to maxDepth, or through the image, needs more. maxDepth where there is
    /// none up to there, or where there is no normal. The opacity on the way is that of the table, in every projection.
    double depth = 0;
    double value = 0; ///< of the image, in its own units
    /// Of that value, by Filter::Exact: a survivor of Filter::Hardware may be a little below the threshold. In
    /// Projection::Certified both are those that prove the touch, and it is not below the threshold (a float).
    double opacity = 0;
    std::int32_t label = 0; ///< of the nearest voxel of the label map; 0 without a map, and outside of it
};

/// Survivors of a pair at one label.
struct LabelCount {
    std::uint32_t pair = 0;  ///< number of the pair in its batch
    std::int32_t label = 0;  ///< as the label map has it
    std::uint64_t count = 0; ///< at least 1
};

/// A PairResult unpacked.
struct PairAnswer {
    std::uint32_t pair = 0;  ///< number of the pair in its batch
    std::uint32_t item = 0;  ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0;  ///< number of the pose within that item
    bool hit = false;        ///< at least one survivor: the pair certainly touches
    bool possible = false;   ///< no survivor, but certified fragments that could not be decided: it may touch
    std::uint64_t count = 0; ///< survivors; 1 for a hit of a boolean query or an early exit
    Exactness exactness = Exactness::Exact;        ///< what the count is worth
    CountingMethod method = CountingMethod::Query; ///< what counted
    Projection projection = Projection::View;      ///< what gave the fragments
};

/// Reads the packed words of a PairResult: its count, its numbers, and how it was counted.
[[nodiscard]] VOXTACT_API PairAnswer unpack(const PairResult& result) noexcept;

/// Of two batches together: the totals of both, and the larger of each two peaks.
[[nodiscard]] VOXTACT_API CertifiedCounters together(const CertifiedCounters& a, const CertifiedCounters& b) noexcept;

/// What a batch gave: the pairs, and what the detector's Outputs asked for. What was not asked for is empty.
struct BatchAnswer {
    std::vector<PairAnswer> pairs;               ///< in the order of the batch
    std::vector<TouchedTriangle> triangles;      ///< by pair, then by triangle
    std::vector<Contact> contacts;               ///< by pair, then by triangle, then by position
    std::uint64_t contactsFound = 0;             ///< more than contacts.size(): the list was cut, arbitrarily
    std::vector<std::optional<Box>> bounds;      ///< world, of each pair; nothing where it has no survivor
    std::vector<LabelCount> labels;              ///< by pair, then by label
    std::optional<CertifiedCounters> counters{}; ///< with DetectorDesc::counters
    double gpuMilliseconds = 0;                  ///< device time of the batch; 0 where it is not known
    double wallMilliseconds = 0;                 ///< from the start of recording to the results in host memory
};

} // namespace voxtact
