// SPDX-License-Identifier: MIT
#include "bench/compare/localize.h"

#include "bench/compare/output.h"
#include "bench/measure/numbers.h"
#include "bench/measure/rounds.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"

#include <algorithm>
#include <iomanip>
#include <iterator>

namespace voxtact::lab {

namespace {

constexpr auto kTriangle = &TouchedTriangle::triangle;

/// The ways, as many as there are in LocalizeResult::ways; one that is not supported does not run. The last is
/// certified.
Result<Engines> makeWays(const device::Session& session, const Scene& scene, LocalizeResult& result) {
    Result<Engines> ways = makePolygonEngines(session, *scene.volume, *scene.mesh, result.machine.filterError);
    VOXTACT_TRY(ways);
    MadeEngine certified = makeHostEngine({.projection = Projection::Certified, .outputs = {.triangles = true}});
    VOXTACT_TRY(certified);
    MadeEngine fragments = makeFragmentEngine(session);
    std::string why;
    if (!fragments.ok()) {
        why = fragments.error().text;
        result.notes.push_back("no method fragments on this device: " + why);
    }
    if (!fragments.ok() && fragments.error().code != ErrorCode::Unsupported) {
        return fragments.error();
    }
    for (const Engine& way : *ways) {
        result.ways.push_back({.name = way.facts.name});
    }
    result.ways.push_back({.name = "fragments", .unchecked = why});
    result.ways.push_back({.name = "certified", .byView = false});
    ways->push_back(fragments.ok() ? std::move(*fragments) : Engine());
    ways->push_back(std::move(*certified));
    return ways;
}

/// Returns the certified verdict of a single triangle.
Result<std::string> certifiedOf(const Engine& certified, const Work& work, std::uint32_t triangle) {
    const MeshData& whole = work.mesh->data;
    MeshPart alone;
    alone.data.indices = {0, 1, 2};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const double* const vertex =
            whole.positions.data() + 3 * std::size_t{whole.indices[3 * std::size_t{triangle} + corner]};
        alone.data.positions.insert(alone.data.positions.end(), vertex, vertex + 3);
    }
    VOXTACT_TRY(makeReady(nullptr, alone));
    const Result<Pass> pass = certified.run({*work.volume, alone, work.poses, work.view}, {});
    VOXTACT_TRY(pass);
    const PairAnswer& pair = pass->pairs.front();
    return std::string(pair.hit ? "certain" : pair.possible ? "possible" : "none");
}

void addTo(std::optional<std::uint64_t>& sum, const std::optional<std::uint64_t>& value) {
    if (value) {
        sum = sum.value_or(0) + *value;
    }
}

/// Runs one method on one pose. Keeps its result once.
Result<void> findOne(const Engine& engine, const Work& work, bool keepsFound, LocalizeWay& way) {
    Result<Pass> pass = engine.run(work, {});
    VOXTACT_TRY(pass);
    way.wall.push_back(pass->wallMilliseconds);
    keep(pass->gpuMilliseconds, way.gpu);
    if (keepsFound) {
        addTo(way.queries, pass->queries);
        addTo(way.boxes, pass->boxes);
        way.triangles += pass->triangles.size();
        way.found.push_back(std::move(pass->triangles));
    }
    return {};
}

/// Every way on every pose; before the rounds, on the first one, one whose results go nowhere.
Result<void> findAll(const Engines& engines, const CompareSettings& settings, const Scene& scene,
                     LocalizeResult& result, const std::function<void(std::uint64_t)>& step) {
    const Work work(scene);
    const auto byAll = [&](std::size_t pose, bool keepsFound, std::vector<LocalizeWay>& ways) -> Result<void> {
        for (std::size_t i = 0; i < engines.size(); ++i) {
            if (engines[i].run) {
                VOXTACT_TRY(findOne(engines[i], work.at(work.poses.subspan(pose, 1)), keepsFound, ways[i]));
            }
        }
        return {};
    };
    std::vector<LocalizeWay> unkept = result.ways;
    VOXTACT_TRY(byAll(0, true, unkept));
    Timed round{.take = [&](const Turn& turn) -> Result<double> {
        for (std::size_t pose = 0; pose < scene.poses.size(); ++pose) {
            VOXTACT_TRY(byAll(pose, turn.round == 1, result.ways));
            step(1);
        }
        return 0.0;
    }};
    const Result<std::uint64_t> rounds =
        takeRounds({&round, 1}, {.repeats = settings.repeats, .limit = settings.timeLimit * 1000});
    VOXTACT_TRY(rounds);
    if (*rounds < settings.repeats) {
        step((settings.repeats - *rounds) * scene.poses.size());
        result.notes.push_back(concat(*rounds, " of ", settings.repeats,
                                      " rounds of finding touched triangles: more would exceed the time limit"));
    }
    return {};
}

/// Triangles of the method with the most queries that are not certified: the others agree, or the run fails.
Result<void> listWrong(const Engine& certified, const Scene& scene, LocalizeResult& result) {
    const Work work(scene);
    for (std::size_t pose = 0; pose < scene.poses.size(); ++pose) {
        std::vector<TouchedTriangle> extra;
        std::ranges::set_difference(result.ways.front().found[pose], result.ways.back().found[pose],
                                    std::back_inserter(extra), {}, kTriangle, kTriangle);
        for (const TouchedTriangle& triangle : extra) {
            Result<std::string> known = certifiedOf(certified, work.at(work.poses.subspan(pose, 1)), triangle.triangle);
            VOXTACT_TRY(known);
            result.wrong.push_back({scene.poseNumbers[pose], triangle.triangle, triangle.count, std::move(*known)});
        }
    }
    return {};
}

/// Counts missed and false triangles of each method, compared with the certified set.
void holdAgainstCertified(LocalizeResult& result) {
    const LocalizeWay& certified = result.ways.back();
    for (LocalizeWay& way : result.ways) {
        for (std::size_t pose = 0; pose < way.found.size(); ++pose) {
            std::vector<TouchedTriangle> both;
            std::ranges::set_intersection(certified.found[pose], way.found[pose], std::back_inserter(both), {},
                                          kTriangle, kTriangle);
            way.missed += certified.found[pose].size() - both.size();
            way.wrong += way.found[pose].size() - both.size();
        }
    }
}

std::uint32_t countIn(const std::vector<TouchedTriangle>& found, std::uint32_t triangle) {
    const auto at = std::ranges::find(found, triangle, &TouchedTriangle::triangle);
    return at == found.end() ? 0 : at->count;
}

/// The first pose and triangle on which a way of the view has other fragments than the first of them.
void findDisagreement(LocalizeResult& result) {
    const LocalizeWay& first = result.ways.front();
    for (std::size_t pose = 0; pose < first.found.size(); ++pose) {
        for (const LocalizeWay& way : result.ways) {
            if (!way.byView || !way.unchecked.empty()) {
                continue;
            }
            std::vector<TouchedTriangle> apart;
            const auto key = [](const TouchedTriangle& one) { return std::pair(one.triangle, one.count); };
            std::ranges::set_symmetric_difference(first.found[pose], way.found[pose], std::back_inserter(apart), {},
                                                  key, key);
            if (apart.empty()) {
                continue;
            }
            const std::uint32_t triangle = apart.front().triangle;
            result.verdict.first = {result.poseNumbers[pose],
                                    concat("triangle ", triangle, ": ", first.name, " ",
                                           countIn(first.found[pose], triangle), ", ", way.name, " ",
                                           countIn(way.found[pose], triangle), " fragments")};
            return;
        }
    }
}

/// JSON has the cells too, with all their names.
io::Table waysTable(const LocalizeResult& result) {
    return tableOf(cellsOf(result.ways, [&](const LocalizeWay& way) {
        const auto ifRun = [&way](auto value) { return way.unchecked.empty() ? std::optional(value) : std::nullopt; };
        return Row()
            .add("way", way.name)
            .add("poses", ifRun(way.found.size()))
            .add("triangles", ifRun(way.triangles))
            .add("missed", ifRun(way.missed))
            .add("missed_percent",
                 way.unchecked.empty() ? percentOf(way.missed, result.ways.back().triangles) : std::nullopt)
            .add("false", ifRun(way.wrong))
            .add("queries", way.queries)
            .add("boxes", way.boxes)
            .add("samples", ifRun(way.wall.size()))
            .add("wall_ms", way.wall, {"_median", "_p10", "_p90"})
            .add("gpu_ms", way.gpu, {"_median"});
    }));
}

/// Returns true if no method found a triangle on any pose: agreement is then meaningless.
bool findsNothing(const LocalizeResult& result) {
    return !result.verdict.failed() &&
           std::ranges::all_of(result.ways, [](const LocalizeWay& way) { return way.triangles == 0; });
}

std::vector<std::string> sentences(const LocalizeResult& result) {
    std::vector<std::string> out;
    const CompareVerdict& verdict = result.verdict;
    out.push_back(verdict.rule + (verdict.failed()
                                      ? concat(": NO, on pose ", verdict.first->pose, ": ", verdict.first->text)
                                  : findsNothing(result) ? ": no triangle on any pose"
                                                         : ": the same triangles with the same counts on every pose"));
    TextStream missed;
    missed << "the camera shows " << grouped(result.ways.front().triangles) << " touching triangles; "
           << grouped(result.ways.back().triangles) << " certainly touch";
    if (const auto percent = percentOf(result.ways.front().missed, result.ways.back().triangles)) {
        missed << ": " << std::fixed << std::setprecision(1) << *percent << " % are missed";
    }
    out.push_back(missed.str());
    for (const WrongTriangle& wrong : result.wrong) {
        out.push_back(concat("found but not certified: pose ", wrong.pose, ", triangle ", wrong.triangle, ", ",
                             wrong.fragments, " fragments; by bounds: ", wrong.certified));
    }
    return out;
}

} // namespace

void judgeLocalize(LocalizeResult& result) {
    holdAgainstCertified(result);
    findDisagreement(result);
}

Result<void> localize(const device::Session& session, const CompareSettings& settings, const Scene& scene,
                      LocalizeResult& result, const std::function<void(std::uint64_t)>& step) {
    result.poseNumbers = scene.poseNumbers;
    VOXTACT_TRY(makeReady(session, scene));
    const Result<Engines> engines = makeWays(session, scene, result);
    VOXTACT_TRY(engines);
    VOXTACT_TRY(findAll(*engines, settings, scene, result, step));
    judgeLocalize(result);
    if (session.device.hasTimestamps() && result.ways.front().gpu.size() < result.ways.front().wall.size()) {
        session.device.missTimestamp();
    }
    noteMissedTimes(session, result.notes);
    return listWrong(engines->back(), scene, result);
}

void writeLocalize(std::ostream& out, io::Format format, const Scene& scene, const LocalizeResult& result) {
    Output output{.machine = result.machine,
                  .members = {},
                  .table = waysTable(result),
                  .sentences = sentences(result),
                  .notes = result.notes};
    if (result.ways.back().triangles == 0) {
        output.notes.emplace_back(kNothingTouches);
    }
    Json& json = output.members;
    json["scene"] = sceneJson(scene);
    json["summary"] = output.sentences;
    json["agrees"] = findsNothing(result) ? Json() : Json(!result.verdict.failed());
    json["poses"] = result.poseNumbers;
    json["ways"] = io::rowsJson(output.table);
    json["not_certified"] = arrayOf(result.wrong, [](const WrongTriangle& wrong) {
        return Json{{"pose", wrong.pose},
                    {"triangle", wrong.triangle},
                    {"fragments", wrong.fragments},
                    {"certified", wrong.certified}};
    });
    writeOutput(out, format, output);
}

} // namespace voxtact::lab
