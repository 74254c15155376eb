// SPDX-License-Identifier: MIT
#include "lab/engines/engine.h"

#include "core/method/method_table.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

BatchItem Work::onDevice() const {
    return {&*mesh->device, &*volume->device, &*volume->deviceFunction, poses,
            volume->deviceLabels ? &*volume->deviceLabels : nullptr};
}

std::vector<std::uint64_t> Pass::counts() const {
    std::vector<std::uint64_t> counts;
    std::ranges::transform(pairs, std::back_inserter(counts), &PairAnswer::count);
    return counts;
}

void Engine::holdAgainst(std::size_t engine, bool sameCounts) {
    facts_.ratioTo = engine;
    facts_.sameCounts = sameCounts;
}

std::string questionOf(bool yesNo, const Outputs& outputs) {
    return yesNo               ? "yes/no"
           : outputs.triangles ? "count, triangles"
           : outputs.bounds    ? "count, bounds"
           : outputs.labels    ? "count, labels"
           : outputs.contacts  ? "count, contacts"
                               : "count";
}

EngineFacts factsOf(const DetectorDesc& desc) {
    return {.name = toString(desc.method),
            .projection = toString(desc.projection),
            .question = questionOf(desc.stopAtFirst, desc.outputs),
            .threads = 0,
            .certified = desc.projection == Projection::Conservative};
}

MadeEngine makeMethodEngine(const device::Session& session, CountingMethod method) {
    return rowOf(method).host ? makeHostEngine()
                              : makeDeviceEngine(session, {.method = method, .filter = defaultFilter(method)});
}

std::vector<CountingMethod>
availableMethods(const device::Session& session,
                 const std::function<void(CountingMethod, const std::string& reason)>& why) {
    const auto supports = session.context.methods();
    std::vector<CountingMethod> methods;
    for (const CountingMethod method : countingMethods()) {
        const auto support = std::ranges::find(supports, method, &MethodSupport::method);
        const bool known = support != supports.end();
        if (rowOf(method).host || (known && support->available)) {
            methods.push_back(method);
        } else {
            why(method, known ? support->reason : "this version has it not");
        }
    }
    return methods;
}

} // namespace voxtact::lab
