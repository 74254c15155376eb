// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

#include <limits>
#include <span>
#include <utility>
#include <vector>

/// A question and an engine together, for tests that ask the same question many times. Made, they refuse what
/// HostEngine::ask() refuses of a question.
namespace voxtact::cpu {

/// Makes an engine, and lets it refuse the question.
template <class Question> Result<HostEngine> engineFor(const Question& question, std::uint32_t threads) {
    Result<HostEngine> engine = HostEngine::create(threads);
    if (!engine.ok()) {
        return engine;
    }
    const auto refused = engine->ask(question, Batch{});
    return refused.ok() ? std::move(engine) : Result<HostEngine>(refused.error());
}

/// Converts the answer of `touch` to a count of 0 or 1.
inline Result<BatchAnswer> asCounts(const Result<TouchAnswer>& touched) {
    if (!touched.ok()) {
        return touched.error();
    }
    BatchAnswer answer;
    for (const PairTouch& pair : touched->pairs) {
        PairAnswer out;
        out.pair = pair.pair;
        out.item = pair.item;
        out.pose = pair.pose;
        out.hit = pair.touch == Verdict::Yes;
        out.possible = pair.touch == Verdict::Undecided;
        out.count = out.hit ? 1 : 0;
        out.exactness = Exactness::LowerBound;
        out.method = CountingMethod::Cpu;
        out.projection = Projection::Certified;
        answer.pairs.push_back(out);
    }
    answer.wallMilliseconds = touched->wallMilliseconds;
    return answer;
}

struct DetectorDesc {
    std::uint32_t threads = 0;
    Boundary boundary = Boundary::Auto;
    bool stopAtFirst = false;
    Projection projection = Projection::View;
    Outputs outputs{};
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel;
    double resolution = kDefaultResolution;
    std::uint32_t mostContacts = 1U << 20U;
};

/// Counts.
class Detector {
  public:
    static Result<Detector> create(const DetectorDesc& desc = {}) {
        const Count question{desc.projection,      desc.boundary,   desc.outputs,     desc.stopAtFirst,
                             desc.samplesPerVoxel, desc.resolution, desc.mostContacts};
        Result<HostEngine> engine = HostEngine::create(desc.threads);
        if (!engine.ok()) {
            return engine.error();
        }
        const bool asksView = usesView(desc.projection);
        const Result<BatchAnswer> refused = engine->ask(question, Batch{.view = asksView ? anyView() : View{}});
        return refused.ok() ? Result<Detector>(Detector{std::move(*engine), question}) : refused.error();
    }
    Result<BatchAnswer> detect(const Batch& batch) { return engine_.ask(question_, batch); }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    Detector(HostEngine engine, const Count& question) : engine_(std::move(engine)), question_(question) {}
    static View anyView() { return {identity(), 1, 1}; }

    HostEngine engine_;
    Count question_;
};

struct AreaDesc {
    std::uint32_t threads = 0;
    double tolerance = kDefaultAreaTolerance;
    double resolution = kDefaultResolution;
    std::uint64_t maxSteps = 1U << 18U;
};

/// Measures areas.
class AreaMeter {
  public:
    static Result<AreaMeter> create(const AreaDesc& desc = {}) {
        const Area question{.tolerance = desc.tolerance, .resolution = desc.resolution, .maxSteps = desc.maxSteps};
        Result<HostEngine> engine = engineFor(question, desc.threads);
        return engine.ok() ? Result<AreaMeter>(AreaMeter{std::move(*engine), question}) : engine.error();
    }
    Result<AreaAnswer> measure(const Batch& batch) { return engine_.ask(question_, batch); }
    Result<AreaAnswer> measureTriangles(const Batch& batch) {
        Area question = question_;
        question.triangles = true;
        return engine_.ask(question, batch);
    }
    Result<AreaAnswer> measureLabels(const Batch& batch, std::span<const std::int32_t> labels) {
        Area question = question_;
        question.labels.emplace(labels.begin(), labels.end());
        return engine_.ask(question, batch);
    }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    AreaMeter(HostEngine engine, Area question) : engine_(std::move(engine)), question_(std::move(question)) {}

    HostEngine engine_;
    Area question_;
};

struct OverlapDesc {
    std::uint32_t threads = 0;
};

/// Measures overlaps.
class OverlapMeter {
  public:
    static Result<OverlapMeter> create(const OverlapDesc& desc = {}) {
        Result<HostEngine> engine = HostEngine::create(desc.threads);
        return engine.ok() ? Result<OverlapMeter>(OverlapMeter{std::move(*engine)}) : engine.error();
    }
    Result<OverlapAnswer> measure(const Overlap& question, const Batch& batch) { return engine_.ask(question, batch); }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    explicit OverlapMeter(HostEngine engine) : engine_(std::move(engine)) {}

    HostEngine engine_;
};

struct ClearanceDesc {
    std::uint32_t threads = 0;
    double tolerance = kDefaultTolerance;
    double maximum = std::numeric_limits<double>::infinity();
    double resolution = kDefaultResolution;
    std::uint64_t maxSteps = 1U << 18U;
    bool labelsAtAnyOpacity = false;
};

/// Measures distances.
class ClearanceMeter {
  public:
    static Result<ClearanceMeter> create(const ClearanceDesc& desc = {}) {
        const Distance question{.tolerance = desc.tolerance,
                                .maximum = desc.maximum,
                                .labelsAtAnyOpacity = desc.labelsAtAnyOpacity,
                                .resolution = desc.resolution,
                                .maxSteps = desc.maxSteps};
        Result<HostEngine> engine = engineFor(question, desc.threads);
        return engine.ok() ? Result<ClearanceMeter>(ClearanceMeter{std::move(*engine), question}) : engine.error();
    }
    Result<DistanceAnswer> measure(const Batch& batch) { return engine_.ask(question_, batch); }
    Result<DistanceAnswer> measureLabels(const Batch& batch, std::span<const std::int32_t> labels) {
        Distance question = question_;
        question.labels.emplace(labels.begin(), labels.end());
        return engine_.ask(question, batch);
    }
    Result<BatchAnswer> within(const Batch& batch, double margin) {
        const Touch touch{.margin = margin, .resolution = question_.resolution, .maxSteps = question_.maxSteps};
        return asCounts(engine_.ask(touch, batch));
    }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    ClearanceMeter(HostEngine engine, Distance question) : engine_(std::move(engine)), question_(std::move(question)) {}

    HostEngine engine_;
    Distance question_;
};

struct MotionDesc {
    std::uint32_t threads = 0;
    Interpolation interpolation = Interpolation::Screw;
    double resolution = kDefaultMotionResolution;
    double touchResolution = kDefaultResolution;
    std::uint64_t maxSteps = 1U << 20U;
};

/// Checks motions, and poses that are uncertain.
class MotionChecker {
  public:
    static Result<MotionChecker> create(const MotionDesc& desc = {}) {
        const Motion question{.interpolation = desc.interpolation,
                              .resolution = desc.resolution,
                              .touchResolution = desc.touchResolution,
                              .maxSteps = desc.maxSteps};
        Result<HostEngine> engine = engineFor(question, desc.threads);
        return engine.ok() ? Result<MotionChecker>(MotionChecker{std::move(*engine), question}) : engine.error();
    }
    Result<MotionAnswer> check(const Batch& batch) { return engine_.ask(question_, batch); }
    Result<MotionAnswer> checkBending(const Batch& batch, std::span<const ShapesOfPoses> shapes) {
        Motion question = question_;
        question.shapes = shapes;
        return engine_.ask(question, batch);
    }
    Result<BatchAnswer> around(const Batch& batch, const PoseTolerance& tolerance) {
        return asCounts(engine_.ask(
            Touch{.uncertainty = tolerance, .resolution = question_.touchResolution, .maxSteps = question_.maxSteps},
            batch));
    }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    MotionChecker(HostEngine engine, const Motion& question) : engine_(std::move(engine)), question_(question) {}

    HostEngine engine_;
    Motion question_;
};

struct PlannerDesc {
    std::uint32_t threads = 0;
    double tolerance = kDefaultPlanTolerance;
    double maximum = kDefaultPlanMaximum;
    std::uint64_t maxSteps = 1U << 18U;
};

/// Plans.
class Planner {
  public:
    static Result<Planner> create(const PlannerDesc& desc = {}) {
        Result<HostEngine> engine = HostEngine::create(desc.threads);
        return engine.ok() ? Result<Planner>(Planner{std::move(*engine), desc}) : engine.error();
    }
    Result<PlanAnswer> plan(Plan question) {
        question.tolerance = desc_.tolerance;
        question.maximum = desc_.maximum;
        question.maxSteps = desc_.maxSteps;
        return engine_.ask(question);
    }
    [[nodiscard]] std::uint32_t threads() const { return engine_.threads(); }

  private:
    Planner(HostEngine engine, const PlannerDesc& desc) : engine_(std::move(engine)), desc_(desc) {}

    HostEngine engine_;
    PlannerDesc desc_;
};

} // namespace voxtact::cpu
