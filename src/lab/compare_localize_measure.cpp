// SPDX-License-Identifier: MIT
#include "lab/compare_localize.h"

#include "cpu/certified/brick_occupancy.h"
#include "lab/localize.h"
#include "lab/trace.h"
#include "oracle/oracle.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<Localization, 3> kByQueries{Localization::Polygon, Localization::Leaf, Localization::LeafBricks};
constexpr std::size_t kFragments = kByQueries.size(); ///< the numbers of the ways in LocalizeResult::ways
constexpr std::size_t kCertified = kFragments + 1;

double millisecondsSince(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

/// What one way found for one pose, and what it took.
struct Found {
    std::vector<TouchedTriangle> triangles;
    std::optional<std::uint64_t> queries{};
    std::optional<std::uint64_t> boxes{};
    double wall = 0;
    std::optional<double> gpu{};
};

/// All the ways on one scene.
class Ways {
  public:
    static Result<Ways> create(const Session& session, const CompareData& data, LocalizeResult& result);

    [[nodiscard]] Result<Found> find(std::size_t way, const Mat4& pose);
    /// What the bounds say of one triangle alone.
    [[nodiscard]] Result<std::string> certifiedOf(std::uint32_t triangle, const Mat4& pose);

  private:
    Ways(const CompareData& data, double threshold, Surroundings surroundings, Subject subject, Localizer localizer,
         cpu::Detector certified, double tolerance)
        : data_(data), threshold_(threshold), surroundings_(std::move(surroundings)), subject_(std::move(subject)),
          localizer_(std::move(localizer)), certified_(std::move(certified)), tree_(makeObbTree(subject_.data.view())),
          bricks_(surroundings_.hostVolume, surroundings_.hostTransferFunction, threshold, tolerance) {}

    Result<Found> byQueries(Localization way, const Batch& batch);
    Result<Found> byFragments(const Batch& batch);
    Result<Found> byCertainty(const Mat4& pose);
    Result<BatchAnswer> certify(const cpu::Mesh& mesh, const Mat4& pose);

    const CompareData& data_;
    double threshold_;
    Surroundings surroundings_;
    Subject subject_;
    Localizer localizer_;
    cpu::Detector certified_;
    std::optional<FragmentTrace> trace_;
    bool timed_ = false;
    ObbTree tree_;
    cpu::BrickOccupancy bricks_;
};

/// The ways by name; without a trace of fragments where the device has none.
Result<std::optional<FragmentTrace>> nameWays(const Session& session, LocalizeResult& result) {
    for (const Localization way : kByQueries) {
        result.ways.push_back({.name = toString(way)});
    }
    LocalizeWay fragments{.name = "fragments"};
    Result<FragmentTrace> trace =
        FragmentTrace::create(session.context, Filter::Hardware, session.device.queueAccess());
    if (!trace.ok() && trace.error().code != ErrorCode::Unsupported) {
        return trace.error();
    }
    if (!trace.ok()) {
        fragments.unchecked = trace.error().text;
        result.notes.push_back("no way fragments on this device: " + fragments.unchecked);
    }
    result.ways.push_back(std::move(fragments));
    result.ways.push_back({.name = "certified", .byView = false});
    return trace.ok() ? std::optional(std::move(*trace)) : std::nullopt;
}

Result<Ways> Ways::create(const Session& session, const CompareData& data, LocalizeResult& result) {
    Result<Surroundings> surroundings = makeSurroundings(session, data.volume.view(), data.transferFunction());
    if (!surroundings.ok()) {
        return surroundings.error();
    }
    Result<Subject> subject = makeSubject(session, data.mesh);
    if (!subject.ok()) {
        return subject.error();
    }
    Result<Localizer> localizer = Localizer::create(session.context, Filter::Hardware, session.device.queueAccess());
    if (!localizer.ok()) {
        return localizer.error();
    }
    Result<cpu::Detector> certified =
        cpu::Detector::create({.projection = Projection::Conservative, .outputs = {.triangles = true}});
    if (!certified.ok()) {
        return certified.error();
    }
    Ways ways(data, data.threshold, std::move(*surroundings), std::move(*subject), std::move(*localizer),
              std::move(*certified), result.machine.eightBitFilter ? cpu::kEightBitFilterError : 0);
    Result<std::optional<FragmentTrace>> trace = nameWays(session, result);
    if (!trace.ok()) {
        return trace.error();
    }
    ways.trace_ = std::move(*trace);
    ways.timed_ = session.device.hasTimestamps();
    return ways;
}

Result<Found> Ways::find(std::size_t way, const Mat4& pose) {
    if (way == kCertified) {
        return byCertainty(pose);
    }
    const BatchItem item{&subject_.device, &surroundings_.volume, &surroundings_.transferFunction, {&pose, 1}};
    const Batch batch{{&item, 1}, data_.view, threshold_};
    return way == kFragments ? byFragments(batch) : byQueries(kByQueries.at(way), batch);
}

Result<Found> Ways::byQueries(Localization way, const Batch& batch) {
    const LocalizeAids aids{&tree_, [this](const Box& box) { return bricks_.mayBeOpaque(box); }};
    Result<LocalizedTriangles> answer = localizer_.triangles(batch, way, aids);
    if (!answer.ok()) {
        return answer.error();
    }
    Found found{.triangles = std::move(answer->triangles)};
    found.queries = answer->queries;
    if (way != Localization::Polygon) {
        found.boxes = answer->boxes;
    }
    found.wall = answer->wallMilliseconds;
    if (timed_) {
        found.gpu = answer->gpuMilliseconds;
    }
    return found;
}

Result<Found> Ways::byFragments(const Batch& batch) {
    const auto begun = Clock::now();
    const Result<std::vector<shader::TracedFragment>> fragments = trace_->survivors(batch);
    if (!fragments.ok()) {
        return fragments.error();
    }
    Found found;
    for (const shader::TracedFragment& fragment : *fragments) {
        if (found.triangles.empty() || found.triangles.back().triangle != fragment.triangle) {
            found.triangles.push_back({0, fragment.triangle, 0});
        }
        ++found.triangles.back().count;
    }
    found.wall = millisecondsSince(begun);
    return found;
}

Result<BatchAnswer> Ways::certify(const cpu::Mesh& mesh, const Mat4& pose) {
    const cpu::BatchItem item{&mesh, &surroundings_.hostVolume, &surroundings_.hostTransferFunction, {&pose, 1}};
    return certified_.detect({{&item, 1}, data_.view, threshold_});
}

Result<Found> Ways::byCertainty(const Mat4& pose) {
    Result<BatchAnswer> answer = certify(subject_.host, pose);
    if (!answer.ok()) {
        return answer.error();
    }
    Found found{.triangles = std::move(answer->triangles)};
    found.wall = answer->wallMilliseconds;
    return found;
}

Result<std::string> Ways::certifiedOf(std::uint32_t triangle, const Mat4& pose) {
    constexpr std::array<std::uint32_t, 3> kCorners{0, 1, 2};
    std::array<float, 9> positions{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t vertex = subject_.data.indices[3 * std::size_t{triangle} + corner];
        std::copy_n(subject_.data.positions.begin() + static_cast<std::ptrdiff_t>(3 * vertex), 3,
                    positions.begin() + static_cast<std::ptrdiff_t>(3 * corner));
    }
    const Result<cpu::Mesh> alone = cpu::Mesh::create({positions, kCorners});
    if (!alone.ok()) {
        return alone.error();
    }
    const Result<BatchAnswer> answer = certify(*alone, pose);
    if (!answer.ok()) {
        return answer.error();
    }
    const PairAnswer& pair = answer->pairs.front();
    return std::string(pair.hit ? "certain" : pair.possible ? "possible" : "none");
}

/// One way on one pose. What it found is kept once.
Result<void> findOne(Ways& ways, std::size_t number, const Mat4& pose, bool keep, LocalizeWay& way) {
    Result<Found> found = ways.find(number, pose);
    if (!found.ok()) {
        return found.error();
    }
    way.wall.push_back(found->wall);
    if (found->gpu) {
        way.gpu.push_back(*found->gpu);
    }
    if (!keep) {
        return {};
    }
    if (found->queries) {
        way.queries = way.queries.value_or(0) + *found->queries;
    }
    if (found->boxes) {
        way.boxes = way.boxes.value_or(0) + *found->boxes;
    }
    way.triangles += found->triangles.size();
    way.found.push_back(std::move(found->triangles));
    return {};
}

/// Every way once, with nothing kept.
Result<void> warmUp(Ways& ways, const Mat4& pose, const LocalizeResult& result) {
    for (std::size_t i = 0; i < result.ways.size(); ++i) {
        LocalizeWay unkept = result.ways[i];
        if (!unkept.unchecked.empty()) {
            continue;
        }
        if (Result<void> one = findOne(ways, i, pose, true, unkept); !one.ok()) {
            return one;
        }
    }
    return {};
}

/// Every way on every pose, in rounds, so that what else the machine does falls on all alike.
Result<void> findAll(Ways& ways, const CompareSettings& settings, const CompareData& data, LocalizeResult& result,
                     const std::function<void()>& step) {
    if (Result<void> warm = warmUp(ways, data.poses.front(), result); !warm.ok()) {
        return warm;
    }
    const auto begun = Clock::now();
    for (std::uint32_t round = 0; round < settings.repeats; ++round) {
        if (round > 0 && millisecondsSince(begun) * (round + 1) / round > settings.timeLimit * 1000) {
            result.notes.push_back(std::to_string(round) + " of " + std::to_string(settings.repeats) +
                                   " rounds of which triangles touch: more would not fit in the time for them");
            break;
        }
        for (const Mat4& pose : data.poses) {
            for (std::size_t i = 0; i < result.ways.size(); ++i) {
                if (!result.ways[i].unchecked.empty()) {
                    continue;
                }
                if (Result<void> one = findOne(ways, i, pose, round == 0, result.ways[i]); !one.ok()) {
                    return one;
                }
            }
            step();
        }
    }
    return {};
}

bool before(const TouchedTriangle& a, const TouchedTriangle& b) {
    return a.triangle < b.triangle;
}

/// What the way of most queries found that is not certified: the other ones are the same, or the run fails.
Result<void> listWrong(Ways& ways, const CompareData& data, LocalizeResult& result) {
    const LocalizeWay& certified = result.ways.back();
    for (std::size_t pose = 0; pose < data.poses.size(); ++pose) {
        std::vector<TouchedTriangle> extra;
        std::ranges::set_difference(result.ways.front().found[pose], certified.found[pose], std::back_inserter(extra),
                                    before);
        for (const TouchedTriangle& triangle : extra) {
            Result<std::string> known = ways.certifiedOf(triangle.triangle, data.poses[pose]);
            if (!known.ok()) {
                return known.error();
            }
            result.wrong.push_back({data.poseNumbers[pose], triangle.triangle, triangle.count, std::move(*known)});
        }
    }
    return {};
}

} // namespace

Result<void> localize(const Session& session, const CompareSettings& settings, const CompareData& data,
                      LocalizeResult& result, const std::function<void()>& step) {
    result.poseNumbers = data.poseNumbers;
    result.triangles = static_cast<std::uint32_t>(data.mesh.indices.size() / 3);
    if (Result<void> fits = checkViewport(session, {data.view.width, data.view.height}); !fits.ok()) {
        return fits;
    }
    Result<Ways> ways = Ways::create(session, data, result);
    if (!ways.ok()) {
        return ways.error();
    }
    if (Result<void> found = findAll(*ways, settings, data, result, step); !found.ok()) {
        return found;
    }
    judgeLocalize(result);
    return listWrong(*ways, data, result);
}

} // namespace voxtact::app
