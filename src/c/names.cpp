// SPDX-License-Identifier: MIT
// The version, the last error, and the names of numbers.
#include "c/convert.h"
#include "voxtact/methods.h"

#define VOXTACT_VERSION_TEXT(major, minor, patch)                                                                      \
    VOXTACT_QUOTED(major) "." VOXTACT_QUOTED(minor) "." VOXTACT_QUOTED(patch)
#define VOXTACT_QUOTED(number) #number

using namespace voxtact;
using namespace voxtact::c;

namespace {

static_assert(VXT_METHOD_QUERY == static_cast<int>(CountingMethod::Query));
static_assert(VXT_METHOD_QUERY_ANY == static_cast<int>(CountingMethod::QueryAny));
static_assert(VXT_METHOD_ATOMIC == static_cast<int>(CountingMethod::Atomic));
static_assert(VXT_METHOD_SUBGROUP == static_cast<int>(CountingMethod::Subgroup));
static_assert(VXT_METHOD_COMPUTE == static_cast<int>(CountingMethod::Compute));
static_assert(VXT_METHOD_CPU == static_cast<int>(CountingMethod::Cpu));
static_assert(VXT_PROJECTION_VIEW == static_cast<int>(Projection::View));
static_assert(VXT_PROJECTION_TWO_VIEW == static_cast<int>(Projection::TwoView));
static_assert(VXT_PROJECTION_DOMINANT_AXIS == static_cast<int>(Projection::DominantAxis));
static_assert(VXT_PROJECTION_CERTIFIED == static_cast<int>(Projection::Certified));
static_assert(VXT_FILTER_HARDWARE == static_cast<int>(Filter::Hardware));
static_assert(VXT_FILTER_EXACT == static_cast<int>(Filter::Exact));
static_assert(VXT_BOUNDARY_AUTO == static_cast<int>(Boundary::Auto));
static_assert(VXT_BOUNDARY_RANGE == static_cast<int>(Boundary::Range));
static_assert(VXT_BOUNDARY_CLAMP == static_cast<int>(Boundary::Clamp));
static_assert(VXT_EXACTNESS_EXACT == static_cast<int>(Exactness::Exact));
static_assert(VXT_EXACTNESS_LOWER_BOUND == static_cast<int>(Exactness::LowerBound));
static_assert(VXT_EXACTNESS_REFUSED == static_cast<int>(Exactness::Refused));

template <class Found, class To> void keepNumber(const Found& found, const char* what, const char* name, To* out) {
    if (!found) {
        refuse(ErrorCode::InvalidArgument, std::string("there is no ") + what + " '" + name + "'");
    }
    *out = number<To>(*found);
}

} // namespace

const char* vxt_version(void) {
    return VOXTACT_VERSION_TEXT(VOXTACT_VERSION_MAJOR, VOXTACT_VERSION_MINOR, VOXTACT_VERSION_PATCH);
}

const char* vxt_method_name(vxt_method method) {
    return toString(number<CountingMethod>(method));
}

const char* vxt_projection_name(vxt_projection projection) {
    return toString(number<Projection>(projection));
}

const char* vxt_filter_name(vxt_filter filter) {
    return toString(number<Filter>(filter));
}

const char* vxt_boundary_name(vxt_boundary boundary) {
    return toString(number<Boundary>(boundary));
}

const char* vxt_exactness_name(vxt_exactness exactness) {
    return toString(number<Exactness>(exactness));
}

vxt_result vxt_method_from_name(const char* name, vxt_method* method) {
    return call([&] {
        keepNumber(countingMethodFromName(&need(name, "name")), "counting method", name, &need(method, "method"));
    });
}

vxt_result vxt_projection_from_name(const char* name, vxt_projection* projection) {
    return call([&] {
        keepNumber(projectionFromName(&need(name, "name")), "projection", name, &need(projection, "projection"));
    });
}

uint32_t vxt_projection_uses_view(vxt_projection projection) {
    return usesView(number<Projection>(projection)) ? 1 : 0;
}

vxt_exactness vxt_method_exactness(vxt_method method) {
    return number<vxt_exactness>(exactness(number<CountingMethod>(method)));
}

vxt_filter vxt_default_filter(vxt_method method) {
    return number<vxt_filter>(defaultFilter(number<CountingMethod>(method)));
}
