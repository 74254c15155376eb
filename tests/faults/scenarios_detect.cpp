// SPDX-License-Identifier: MIT
// Every counting method, projection and output, blocking; the lists of survivors, and the queries of triangles; the
// self-test.
#include "bench/engines/localize.h"
#include "device/detector/self_test.h"
#include "scenarios.h"

#include <sstream>

namespace voxtact::test {

namespace {

constexpr std::uint32_t kMostContacts = 20;

/// One detector asked several times: an answer that is another's would be seen. The third batch needs larger Results.
std::string askThrice(Play& play, const AnyDesc& desc) {
    const Setting setting(play);
    BlockingDetector detector = play.ask("BlockingDetector::create", [&] {
        return BlockingDetector::create(setting.context, desc, play.stage().queue, kMostContacts);
    });
    std::string answers;
    for (const std::uint32_t pairs : {1U, 3U, 67U}) {
        const std::vector<Mat4> poses = somePoses(pairs, 0.01 * pairs);
        const BatchItem item = setting.item(poses);
        answers += textOf(play.ask("BlockingDetector::detect", [&] {
            return detector.detect({{&item, 1}, someView(), kThreshold});
        }));
    }
    return answers;
}

std::string nameOf(const AnyDesc& desc) {
    return std::string(toString(desc.method)) + " " + toString(desc.projection);
}

std::vector<AnyDesc> allWays() {
    std::vector<AnyDesc> ways;
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::QueryAny, CountingMethod::Atomic,
                                        CountingMethod::Subgroup, CountingMethod::Compute}) {
        for (const Projection projection : {Projection::View, Projection::TwoView, Projection::DominantAxis}) {
            ways.push_back({.method = method, .projection = projection, .filter = defaultFilter(method)});
        }
    }
    ways.push_back({.method = CountingMethod::Compute, .projection = Projection::Certified});
    return ways;
}

/// One output after the other, and all.
std::vector<Outputs> allOutputs() {
    return {{.triangles = true},
            {.contacts = true},
            {.bounds = true},
            {.labels = true},
            {.triangles = true, .contacts = true, .bounds = true, .labels = true}};
}

std::string nameOf(const Outputs& outputs) {
    return std::string(outputs.triangles ? " triangles" : "") + (outputs.contacts ? " contacts" : "") +
           (outputs.bounds ? " bounds" : "") + (outputs.labels ? " labels" : "");
}

Result<FragmentTrace> makeTrace(Play& play, const Context& context) {
    return FragmentTrace::create(context, Filter::Hardware, play.stage().queue);
}

std::string trace(Play& play, std::span<const double> shifts) {
    const Setting setting(play);
    FragmentTrace trace = play.ask("FragmentTrace::create", [&] { return makeTrace(play, setting.context); });
    std::ostringstream out;
    for (const double x : shifts) {
        const std::vector<Mat4> poses = somePoses(1, x);
        const BatchItem item = setting.item(poses);
        const auto fragments = play.ask("FragmentTrace::survivors", [&] {
            return trace.survivors({{&item, 1}, someView(), kThreshold});
        });
        out << fragments.size() << ' ' << fragments.back().triangle << '\n';
    }
    return out.str();
}

std::string localize(Play& play) {
    const Setting setting(play);
    Localizer localizer = play.ask(
        "Localizer::create", [&] { return Localizer::create(setting.context, Filter::Hardware, play.stage().queue); });
    std::ostringstream out;
    for (const double x : {0.0, 0.1}) {
        const std::vector<Mat4> poses = somePoses(1, x);
        const BatchItem item = setting.item(poses);
        const lab::Pass found = play.ask("Localizer::triangles", [&] {
            return localizer.triangles({{&item, 1}, someView(), kThreshold}, Localization::Polygon);
        });
        out << *found.queries << ' ' << (found.gpuMilliseconds > 0);
        for (const TouchedTriangle& triangle : found.triangles) {
            out << ' ' << triangle.triangle << ':' << triangle.count;
        }
    }
    return out.str();
}

/// A method that failed is not trusted, with the error as its text: for ask() the same as an error.
template <class Verdicts> Result<Verdicts> trusted(Play& play, Result<Verdicts> verdicts) {
    for (const auto& each : verdicts.ok() ? *verdicts : Verdicts{}) {
        const SelfTestVerdict* verdict = nullptr;
        if constexpr (std::is_same_v<Verdicts, std::vector<SelfTestVerdict>>) {
            verdict = &each;
        } else {
            verdict = &each.verdict;
        }
        if (!verdict->trusted) {
            const bool memory = verdict->text.starts_with("out of");
            const auto& fault = play.stage().faults.fault();
            return Error{memory ? ErrorCode::OutOfMemory : ErrorCode::Vulkan, fault ? fault->result : 0, verdict->text};
        }
    }
    return verdicts;
}

std::string selfTests(Play& play) {
    constexpr std::uint32_t kFewGroups = 2;
    const Context context = play.quietly([&] { return Context::create(play.stage().context); });
    const std::vector<SelfTestVerdict> verdicts =
        play.ask("selfTest", [&] { return trusted(play, selfTest(context, play.stage().queue, {}, kFewGroups)); });
    std::string out;
    for (const SelfTestVerdict& verdict : verdicts) {
        out += std::string(toString(verdict.method)) + ": " + verdict.text + "\n";
    }
    return out;
}

} // namespace

std::vector<Scenario> detectScenarios() {
    std::vector<Scenario> out;
    for (const AnyDesc& desc : allWays()) {
        out.push_back({nameOf(desc), [desc](Play& play) { return askThrice(play, desc); }});
    }
    out.push_back({"compute certified stop-at-first counters", [](Play& play) {
                       return askThrice(play, {.method = CountingMethod::Compute,
                                               .projection = Projection::Certified,
                                               .stopAtFirst = true,
                                               .counters = true});
                   }});
    for (AnyDesc desc : allWays()) {
        // All at once where a method or projection is first seen, one at a time by the rasteriser and certified.
        for (const Outputs& outputs : allOutputs()) {
            const bool all = outputs.triangles && outputs.contacts;
            const bool each = desc.method == CountingMethod::Atomic && desc.projection == Projection::View;
            if (all || each || desc.projection == Projection::Certified) {
                desc.outputs = outputs;
                out.push_back({nameOf(desc) + nameOf(outputs), [desc](Play& play) { return askThrice(play, desc); }});
            }
        }
    }
    static constexpr double kShifts[] = {0, 0.1};
    out.push_back({"list of survivors", [](Play& play) { return trace(play, kShifts); }});
    // It does not fit at first.
    out.push_back({"long list of survivors", [](Play& play) { return trace(play, std::span(kShifts).first(1)); }, false,
                   (1U << 16U) + 5});
    out.push_back({"queries of triangles", localize});
    out.push_back({"self-test", selfTests, true});
    return out;
}

} // namespace voxtact::test
