// SPDX-License-Identifier: MIT
#pragma once

#include "image.h"
#include "voxtact/motion.h"
#include "voxtact/results.h"

#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

/// What Python asks a scene.
namespace voxtact::python {

/// Meshes at poses, copied: what an answer is about stays known when the arrays change.
struct Request {
    struct Item {
        std::shared_ptr<const Shape> mesh;
        std::vector<Mat4> world_from_object;
        std::size_t firstPair = 0;
        std::size_t firstSegment = 0;

        /// Ways from one pose to the next.
        [[nodiscard]] std::size_t segments() const noexcept {
            return world_from_object.size() - (world_from_object.empty() ? 0 : 1);
        }
    };
    std::vector<Item> items;
    std::size_t pairs = 0;

    void add(std::shared_ptr<const Shape> mesh, std::vector<Mat4> world_from_object);
    [[nodiscard]] std::size_t segments() const noexcept;
    /// The triangles of the largest mesh; at least 1.
    [[nodiscard]] std::size_t mostTriangles() const noexcept;
    /// Calls `each(item, poses)` for the part of each item that lies in `count` pairs from `first` on.
    template <class Each> void forPart(std::size_t first, std::size_t count, const Each& each) const {
        for (const Item& item : items) {
            const std::size_t begin = std::max(first, item.firstPair);
            const std::size_t end = std::min(first + count, item.firstPair + item.world_from_object.size());
            if (begin < end) {
                each(item, std::span(item.world_from_object).subspan(begin - item.firstPair, end - begin));
            }
        }
    }
    /// The same for segments, each with both of its poses.
    template <class Each> void forSegments(std::size_t first, std::size_t count, const Each& each) const {
        for (const Item& item : items) {
            const std::size_t begin = std::max(first, item.firstSegment);
            const std::size_t end = std::min(first + count, item.firstSegment + item.segments());
            if (begin < end) {
                each(item, std::span(item.world_from_object).subspan(begin - item.firstSegment, end - begin + 1));
            }
        }
    }
};

/// A number of a key: NaN, which is neither less nor greater than any other, is a key like all others.
[[nodiscard]] inline std::uint64_t inKey(double number) noexcept {
    return std::bit_cast<std::uint64_t>(number);
}

/// How a detector answers.
struct Question {
    Projection projection = Projection::Conservative;
    std::optional<CountingMethod> method; ///< nothing: cpu on the host, else the best that the projection has
    std::optional<Filter> filter;
    Boundary boundary = Boundary::Auto;
    Outputs outputs;
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
    double resolution = kDefaultResolution;
    bool yesNo = false;
    bool overestimate = false;
    bool counters = false;
    double margin = 0;                        ///< mm; on a device
    std::optional<PoseTolerance> tolerance;   ///< on a device
    std::optional<ClearanceSearch> clearance; ///< on a device
    std::optional<MotionSearch> motion;       ///< on a device
    bool toLabels = false;                    ///< with `clearance`: of these, instead of closest points
    bool labelsAtAnyOpacity = false;
    std::uint32_t mostContacts = 1U << 20U;
    std::optional<View> view; ///< nothing: the volume from above

    /// What a detector is made for, without the view.
    [[nodiscard]] auto key() const noexcept {
        return std::tuple(projection, method, filter, boundary, outputs.triangles, outputs.contacts, outputs.bounds,
                          outputs.labels, inKey(outputs.maxDepth), samplesPerVoxel, inKey(resolution), yesNo,
                          overestimate, counters, inKey(margin), inKey(tolerance ? tolerance->distance : 0),
                          inKey(tolerance ? tolerance->angle : 0), inKey(clearance ? clearance->tolerance : 0),
                          inKey(clearance ? clearance->maximum : 0), inKey(motion ? motion->resolution : 0),
                          motion ? motion->interpolation : Interpolation::Screw, toLabels, labelsAtAnyOpacity,
                          mostContacts);
    }
    using Key = std::tuple<Projection, std::optional<CountingMethod>, std::optional<Filter>, Boundary, bool, bool, bool,
                           bool, std::uint64_t, std::uint32_t, std::uint64_t, bool, bool, bool, std::uint64_t,
                           std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, Interpolation,
                           bool, bool, std::uint32_t>;
};

/// How a clearance is measured.
struct Distance {
    double tolerance = 0;
    double maximum = 0;
    std::uint64_t mostSteps = 0;
    bool labelsAtAnyOpacity = false;

    [[nodiscard]] auto key() const noexcept {
        return std::tuple(inKey(tolerance), inKey(maximum), mostSteps, labelsAtAnyOpacity);
    }
    using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, bool>;
};

/// How an area is measured.
struct Extent {
    double tolerance = 0;
    std::uint64_t mostSteps = 0;

    [[nodiscard]] auto key() const noexcept { return std::tuple(inKey(tolerance), mostSteps); }
    using Key = std::tuple<std::uint64_t, std::uint64_t>;
};

/// The camera of a question; without one, the volume from above. Nothing where the projection has none.
[[nodiscard]] View viewOf(const Question& question, const Grid& grid);
/// A request of a mesh and poses, or of a list of these.
[[nodiscard]] Request requestOf(const py::object& meshes, const py::object& poses);
/// Calls `read(name, value)` for each option; a value that it cannot cast becomes a TypeError with the option's name.
void readOptions(const py::dict& options, const std::function<void(const std::string&, const py::handle&)>& read);
/// Names as on the command line; None is the default.
[[nodiscard]] Question questionOf(const py::dict& options);

} // namespace voxtact::python
