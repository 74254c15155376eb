// SPDX-License-Identifier: MIT
#include "lab/engines/engine.h"

#include "core/method/method_table.h"
#include "detect/outputs/output_parts.h"

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

void EngineList::add(MadeEngine engine, std::size_t ratioTo, bool sameCounts) {
    if (!engine.ok()) {
        error_ = error_.value_or(engine.error());
        return;
    }
    engine->facts.ratioTo = ratioTo;
    engine->facts.sameCounts = sameCounts;
    engines_.push_back(std::move(*engine));
}

Result<Engines> EngineList::take() {
    return error_ ? Result<Engines>(*error_) : Result<Engines>(std::move(engines_));
}

std::string questionOf(bool yesNo, const Outputs& outputs) {
    const auto asked = [&](const OutputPartRow& part) { return outputs.*part.output; };
    const auto found = std::ranges::find_if(outputParts(), asked);
    return yesNo ? "yes/no" : found == outputParts().end() ? "count" : std::string("count, ") + found->name;
}

MadeEngine makeMethodEngine(const device::Session& session, CountingMethod method) {
    return rowOf(method).host ? makeHostEngine()
                              : makeDeviceEngine(session, {.method = method, .filter = defaultFilter(method)});
}

std::string whyNot(const device::Session& session, CountingMethod method) {
    if (rowOf(method).host) {
        return {};
    }
    const auto all = session.context.methods();
    const auto support = std::ranges::find(all, method, &MethodSupport::method);
    return support == all.end() ? "this version has it not" : support->available ? std::string() : support->reason;
}

} // namespace voxtact::lab
