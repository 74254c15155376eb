// SPDX-License-Identifier: MIT
#include "voxtact/methods.h"

#include <array>

namespace voxtact {

namespace {

struct MethodName {
    CountingMethod method;
    const char* name;
};

constexpr std::array kMethods{CountingMethod::Query,    CountingMethod::QueryAny, CountingMethod::Atomic,
                              CountingMethod::Subgroup, CountingMethod::Compute,  CountingMethod::Cpu};
constexpr std::array<MethodName, kMethods.size()> kMethodNames{{
    {CountingMethod::Query, "query"},
    {CountingMethod::QueryAny, "query-any"},
    {CountingMethod::Atomic, "atomic"},
    {CountingMethod::Subgroup, "subgroup"},
    {CountingMethod::Compute, "compute"},
    {CountingMethod::Cpu, "cpu"},
}};

struct ProjectionName {
    Projection projection;
    const char* name;
};

constexpr std::array kProjections{Projection::View, Projection::TwoView, Projection::DominantAxis,
                                  Projection::Conservative};
constexpr std::array<ProjectionName, kProjections.size()> kProjectionNames{{
    {Projection::View, "view"},
    {Projection::TwoView, "two-view"},
    {Projection::DominantAxis, "dominant-axis"},
    {Projection::Conservative, "conservative"},
}};

} // namespace

const char* toString(CountingMethod method) noexcept {
    for (const MethodName& entry : kMethodNames) {
        if (entry.method == method) {
            return entry.name;
        }
    }
    return "unknown";
}

const char* toString(Projection projection) noexcept {
    for (const ProjectionName& entry : kProjectionNames) {
        if (entry.projection == projection) {
            return entry.name;
        }
    }
    return "unknown";
}

const char* toString(Filter filter) noexcept {
    return filter == Filter::Exact ? "exact" : "hardware";
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

const char* toString(Exactness exactness) noexcept {
    return exactness == Exactness::Exact ? "exact" : "lower-bound";
}

std::span<const CountingMethod> countingMethods() noexcept {
    return kMethods;
}

std::optional<CountingMethod> countingMethodFromName(std::string_view name) noexcept {
    for (const MethodName& entry : kMethodNames) {
        if (name == entry.name) {
            return entry.method;
        }
    }
    return std::nullopt;
}

std::span<const Projection> projections() noexcept {
    return kProjections;
}

std::optional<Projection> projectionFromName(std::string_view name) noexcept {
    for (const ProjectionName& entry : kProjectionNames) {
        if (name == entry.name) {
            return entry.projection;
        }
    }
    return std::nullopt;
}

bool usesView(Projection projection) noexcept {
    return projection == Projection::View || projection == Projection::TwoView;
}

Filter defaultFilter(CountingMethod method) noexcept {
    return method == CountingMethod::Compute || method == CountingMethod::Cpu ? Filter::Exact : Filter::Hardware;
}

Exactness exactness(CountingMethod method) noexcept {
    return method == CountingMethod::QueryAny ? Exactness::LowerBound : Exactness::Exact;
}

} // namespace voxtact
