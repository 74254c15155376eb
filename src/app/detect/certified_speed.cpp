// SPDX-License-Identifier: MIT
#include "app/detect/certified_speed.h"

#include "app/detect/detect_run.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "lab/engines/engine.h"
#include "lab/measure/numbers.h"
#include "lab/measure/poses.h"
#include "lab/measure/rounds.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <array>

namespace voxtact::app {

using namespace lab;

namespace {

constexpr std::uint32_t kPoses = 2 * kDefaultBatch;
constexpr std::uint32_t kRounds = 3;
constexpr double kMostMilliseconds = 500; // of the rounds; there is one at least

bool isSame(const PairAnswer& one, const PairAnswer& other) {
    const bool exact = one.exactness == Exactness::Exact && other.exactness == Exactness::Exact;
    return one.hit == other.hit && one.possible == other.possible && (one.count == other.count || !exact);
}

/// What both answer, ready for them. It must end before the device does.
struct Asked {
    VolumePart volume;
    MeshPart mesh;
    std::vector<Mat4> poses;
    View view;

    static Result<Asked> create(const device::Session& session) {
        Result<MeasureScene> scene = makeMeasureScene();
        VOXTACT_TRY(scene);
        Asked asked{{.name = {}, .data = std::move(scene->volume), .points = scene->points, .domain = scene->domain},
                    {.name = {}, .data = std::move(scene->mesh)},
                    {},
                    scene->view};
        asked.volume.threshold = scene->threshold;
        asked.poses = randomPoses(asked.volume.data.grid, asked.mesh.data.view(), kPoses, 1);
        VOXTACT_TRY(makeReady(session, {.bricks = true}, asked.volume));
        VOXTACT_TRY(makeReady(&session, asked.mesh));
        return asked;
    }
    [[nodiscard]] Work work() const { return {volume, mesh, poses, view}; }
};

/// One of the two, and what it has taken.
struct Candidate {
    Engine engine;
    Feeding feeding;
    MethodSpeed speed;
    std::vector<double> milliseconds{};

    Result<Pass> answer(const Asked& asked) const { return engine.run(asked.work(), feeding); }
    void setRate() { speed.pairsPerSecond = kPoses * 1000 / std::max(medianOf(milliseconds), 1e-6); }
};

Result<void> race(const Asked& asked, std::array<Candidate, 2>& both) {
    std::vector<Timed> things;
    for (Candidate& one : both) {
        things.push_back({.take = [&](const Turn&) -> Result<double> {
            const Result<Pass> pass = one.answer(asked);
            VOXTACT_TRY(pass);
            one.milliseconds.push_back(pass->wallMilliseconds);
            return pass->wallMilliseconds;
        }});
    }
    VOXTACT_TRY(takeRounds(things, {.repeats = kRounds, .limit = kMostMilliseconds}));
    std::ranges::for_each(both, &Candidate::setRate);
    return {};
}

} // namespace

std::string otherAnswers(std::span<const PairAnswer> device, std::span<const PairAnswer> host) {
    std::size_t others = 0;
    for (std::size_t i = 0; i < host.size(); ++i) {
        others += i < device.size() && isSame(device[i], host[i]) ? 0 : 1;
    }
    return others == 0 ? "" : concat("answers ", others, " of ", host.size(), " pairs otherwise than cpu");
}

Result<std::vector<MethodSpeed>> measureCertified(const device::Session& session, bool yesNo) {
    const std::array methods{CountingMethod::Compute};
    Result<std::vector<SelfTestVerdict>> verdicts = selfTest(session.context, session.device.queueAccess(), methods);
    VOXTACT_TRY(verdicts);
    std::vector<MethodSpeed> speeds{{std::move(verdicts->front()), 0}, {{CountingMethod::Cpu, true, true, {}}, 0}};
    if (!speeds.front().verdict.trusted) {
        return speeds;
    }
    const Result<Asked> asked = Asked::create(session);
    VOXTACT_TRY(asked);
    MadeEngine device = makeDeviceEngine(session, {.method = CountingMethod::Compute,
                                                   .projection = Projection::Conservative,
                                                   .filter = defaultFilter(CountingMethod::Compute),
                                                   .stopAtFirst = yesNo});
    VOXTACT_TRY(device);
    MadeEngine host = makeHostEngine({.stopAtFirst = yesNo, .projection = Projection::Conservative});
    VOXTACT_TRY(host);
    std::array<Candidate, 2> both{Candidate{std::move(*device), {kDefaultBatch, kSubmissionsInFlight}, speeds[0]},
                                  Candidate{std::move(*host), {}, speeds[1]}};
    // Not timed: pipelines, threads and the bits of opaque cells are made.
    const Result<Pass> first = both[0].answer(*asked);
    VOXTACT_TRY(first);
    const Result<Pass> known = both[1].answer(*asked);
    VOXTACT_TRY(known);
    if (std::string others = otherAnswers(first->pairs, known->pairs); !others.empty()) {
        speeds.front().verdict.trusted = false;
        speeds.front().verdict.text = std::move(others);
        return speeds;
    }
    VOXTACT_TRY(race(*asked, both));
    return std::vector{both[0].speed, both[1].speed};
}

} // namespace voxtact::app
