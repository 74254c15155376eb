// SPDX-License-Identifier: MIT
#include "voxtact/methods.h"

#include "core/method/method_table.h"
#include "voxtact/area.h"
#include "voxtact/distance.h"
#include "voxtact/motion.h"
#include "voxtact/overlap.h"
#include "voxtact/results.h"

namespace voxtact {

namespace {

constexpr auto kMethods = [] {
    std::array<CountingMethod, kMethodTable.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = kMethodTable[i].method;
    }
    return all;
}();

constexpr auto kProjections = [] {
    std::array<Projection, kProjectionTable.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = kProjectionTable[i].projection;
    }
    return all;
}();

} // namespace

const char* toString(CountingMethod method) noexcept {
    return isKnown(method) ? rowOf(method).name : "unknown";
}

const char* toString(Projection projection) noexcept {
    return isKnown(projection) ? rowOf(projection).name : "unknown";
}

const char* toString(Filter filter) noexcept {
    switch (filter) {
    case Filter::Hardware:
        return "hardware";
    case Filter::Exact:
        return "exact";
    }
    return "unknown";
}

const char* toString(Boundary boundary) noexcept {
    switch (boundary) {
    case Boundary::Auto:
        return "auto";
    case Boundary::Range:
        return "range";
    case Boundary::Clamp:
        return "clamp";
    }
    return "unknown";
}

const char* toString(Interpolation interpolation) noexcept {
    switch (interpolation) {
    case Interpolation::Screw:
        return "screw";
    case Interpolation::Slerp:
        return "slerp";
    }
    return "unknown";
}

const char* toString(MotionEnd end) noexcept {
    switch (end) {
    case MotionEnd::Decided:
        return "decided";
    case MotionEnd::Grazes:
        return "grazes";
    case MotionEnd::Budget:
        return "budget";
    }
    return "unknown";
}

const char* toString(StopReason reason) noexcept {
    switch (reason) {
    case StopReason::Closed:
        return "closed";
    case StopReason::Beyond:
        return "beyond";
    case StopReason::Rounding:
        return "rounding";
    case StopReason::Budget:
        return "budget";
    }
    return "unknown";
}

const char* toString(Containment containment) noexcept {
    switch (containment) {
    case Containment::None:
        return "none";
    case Containment::Some:
        return "some";
    case Containment::All:
        return "all";
    case Containment::Undecided:
        return "undecided";
    }
    return "unknown";
}

const char* toString(Verdict verdict) noexcept {
    switch (verdict) {
    case Verdict::No:
        return "no";
    case Verdict::Yes:
        return "yes";
    case Verdict::Undecided:
        return "undecided";
    }
    return "unknown";
}

const char* toString(Exactness exactness) noexcept {
    switch (exactness) {
    case Exactness::Exact:
        return "exact";
    case Exactness::LowerBound:
        return "lower-bound";
    case Exactness::Refused:
        return "refused";
    }
    return "unknown";
}

std::span<const CountingMethod> countingMethods() noexcept {
    return kMethods;
}

std::optional<CountingMethod> countingMethodFromName(std::string_view name) noexcept {
    for (const MethodRow& row : kMethodTable) {
        if (name == row.name) {
            return row.method;
        }
    }
    return std::nullopt;
}

std::span<const Projection> projections() noexcept {
    return kProjections;
}

std::optional<Projection> projectionFromName(std::string_view name) noexcept {
    for (const ProjectionRow& row : kProjectionTable) {
        if (name == row.name) {
            return row.projection;
        }
    }
    return std::nullopt;
}

bool usesView(Projection projection) noexcept {
    return isKnown(projection) && rowOf(projection).camera;
}

Filter defaultFilter(CountingMethod method) noexcept {
    return isKnown(method) ? rowOf(method).filter : Filter::Hardware;
}

Exactness exactness(CountingMethod method) noexcept {
    return isKnown(method) ? rowOf(method).exactness : Exactness::Exact;
}

} // namespace voxtact
