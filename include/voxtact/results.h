// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/device_results.h"
#include "voxtact/methods.h"

#include <cstdint>
#include <optional>
#include <vector>

/// Additional outputs of a count, and the answers in host memory, the same from device and host.
namespace voxtact {

/// Outputs to compute, in addition to the count; fixed for the life of a detector.
struct Outputs {
    bool triangles = false; ///< triangles with passing fragments, and their counts
    bool contacts = false;  ///< a Contact per passing fragment, up to the capacity
    bool bounds = false;    ///< world bounding box of each pair's passing fragments
    bool labels = false;    ///< counts per label of the passing fragments; the items need label maps
    /// Maximum depth of a contact, mm; positive. Contacts only.
    double maxDepth = kDefaultMaxDepth;

    /// True if any output is enabled.
    [[nodiscard]] bool any() const noexcept { return triangles || contacts || bounds || labels; }
};

/// Verdict on a pair.
enum class Verdict : std::uint32_t {
    No,        ///< the pair does not touch: proven
    Yes,       ///< the pair touches: proven
    Undecided, ///< not proven, because of rounding or the iteration limit
};
/// Returns "no", "yes" or "undecided", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Verdict verdict) noexcept;

/// WitnessPoint::triangle of a point inside the mesh (questions with `solid`), which is on no triangle.
inline constexpr std::uint32_t kInsideMesh = 0xffffffffU;

/// A point that proves a yes.
struct WitnessPoint {
    Vec3 position{};            ///< world mm: opaque, and at most the margin from the triangle, or inside the mesh
    std::uint32_t triangle = 0; ///< index of the triangle in the mesh, or kInsideMesh
};

/// The verdict on one pair.
struct PairTouch {
    std::uint32_t pair = 0;              ///< index of the pair in its batch
    std::uint32_t item = 0;              ///< index of the BatchItem of the pair
    std::uint32_t pose = 0;              ///< index of the pose in that item
    Verdict touch = Verdict::No;         ///< within the margin, at any pose of the uncertainty
    std::optional<WitnessPoint> witness; ///< of a yes, if Touch::witness is set
};

/// The answer for a batch.
struct TouchAnswer {
    std::vector<PairTouch> pairs; ///< in the order of the batch
    double wallMilliseconds = 0;  ///< duration of the whole call
};

/// A triangle with at least one passing fragment.
struct TouchedTriangle {
    std::uint32_t pair = 0;     ///< index of the pair in its batch
    std::uint32_t triangle = 0; ///< index of the triangle in the mesh
    std::uint32_t count = 0;    ///< number of its passing fragments
};

/// A passing fragment with its position.
struct Contact {
    std::uint32_t pair = 0;     ///< index of the pair in its batch
    std::uint32_t triangle = 0; ///< index of the triangle in the mesh
    /// World, mm. Lies in an opaque sample, up to rounding. The distance from the triangle is at most 1e-5 voxel plus
    /// 2e-5 of the triangle's size. Multiply this bound by the ratio of the grid's largest spacing to its smallest, and
    /// by the condition number of a shearing or scaling pose.
    Vec3 position{};
    /// Unit vector in world space, against the gradient of opacity: points out of the opaque region. The gradient uses
    /// differences over one voxel to each side, clamped to the image; if they vanish, the step is doubled, up to
    /// maxDepth. Zero if all differences vanish.
    Vec3 normal{};
    /// Distance in mm along the normal, from the position to the first opacity below the threshold or the image's
    /// border. The search takes at most 16,384 steps of half the smallest spacing, and may miss thinner gaps. Longer
    /// distances to maxDepth, or through the image, take longer steps. maxDepth without such a point or without a
    /// normal. Uses the opacity of the table in every projection.
    double depth = 0;
    double value = 0; ///< image value, in its own units
    /// Opacity of that value, by Filter::Exact: a passing fragment of Filter::Hardware may be slightly below the
    /// threshold. In Projection::Certified, value and opacity come from the proof; the opacity is at least the
    /// threshold (a float).
    double opacity = 0;
    std::int32_t label = 0; ///< label of the nearest voxel of the label map; 0 without a map, and outside it
};

/// Number of passing fragments of a pair at one label.
struct LabelCount {
    std::uint32_t pair = 0;  ///< index of the pair in its batch
    std::int32_t label = 0;  ///< value in the label map
    std::uint64_t count = 0; ///< at least 1
};

/// A PairResult, unpacked.
struct PairAnswer {
    std::uint32_t pair = 0;  ///< index of the pair in its batch
    std::uint32_t item = 0;  ///< index of the BatchItem of the pair
    std::uint32_t pose = 0;  ///< index of the pose in that item
    bool hit = false;        ///< at least one passing fragment: the pair certainly touches
    bool possible = false;   ///< undecided: no passing fragment, but undecided fragments of the projection certified
    std::uint64_t count = 0; ///< passing fragments; 1 for a touch by a boolean query or an early exit
    Exactness exactness = Exactness::Exact;        ///< meaning of the count
    CountingMethod method = CountingMethod::Query; ///< method that counted
    Projection projection = Projection::View;      ///< projection that made the fragments
};

/// Unpacks the words of a PairResult: count, indices, method, projection and exactness.
[[nodiscard]] VOXTACT_API PairAnswer unpack(const PairResult& result) noexcept;

/// Merges the counters of two batches: adds totals, keeps the larger peaks.
[[nodiscard]] VOXTACT_API CertifiedCounters together(const CertifiedCounters& a, const CertifiedCounters& b) noexcept;

/// The answer for a batch: the pairs, and the outputs that the detector's Outputs enable. Other outputs are empty.
struct BatchAnswer {
    std::vector<PairAnswer> pairs;               ///< in the order of the batch
    std::vector<TouchedTriangle> triangles;      ///< by pair, then by triangle
    std::vector<Contact> contacts;               ///< by pair, then by triangle, then by position
    std::uint64_t contactsFound = 0;             ///< larger than contacts.size() if the list was cut, arbitrarily
    std::vector<std::optional<Box>> bounds;      ///< world box of each pair; empty without a passing fragment
    std::vector<LabelCount> labels;              ///< by pair, then by label
    std::optional<CertifiedCounters> counters{}; ///< with CertifiedDesc::counters
    double gpuMilliseconds = 0;                  ///< device time of the batch; 0 if unknown
    double wallMilliseconds = 0;                 ///< from the start of recording to the results in host memory
};

} // namespace voxtact
