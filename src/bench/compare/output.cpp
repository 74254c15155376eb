// SPDX-License-Identifier: MIT
#include "bench/compare/output.h"

#include <cmath>
#include <cstdio>

namespace voxtact::lab {

namespace {

Json verdictJson(const CompareVerdict& verdict) {
    Json json{{"rule", verdict.rule},
              {"required", verdict.required},
              {"checked", verdict.unchecked.empty()},
              {"agrees", verdict.unchecked.empty() ? Json(!verdict.failed()) : Json()},
              {"unit", verdict.unit},
              {"compared", verdict.compared},
              {"differing", verdict.differing},
              {"largest_difference", verdict.largest},
              {"detail", verdict.detail}};
    if (!verdict.unchecked.empty()) {
        json["why_not"] = verdict.unchecked;
    }
    if (verdict.first) {
        json["pose"] = verdict.first->pose;
        json["text"] = verdict.first->text;
    }
    return json;
}

Json fragmentJson(const DifferingFragment& differing) {
    // Far distances are infinite, which JSON cannot express.
    const auto real = [](double value) { return std::isfinite(value) ? Json(rounded(value)) : Json(); };
    return {{"pose", differing.pose},
            {"triangle", differing.fragment.triangle},
            {"x", differing.fragment.x},
            {"y", differing.fragment.y},
            {"on", differing.onDevice ? "device" : "oracle"},
            {"reason", toString(differing.doubt())},
            {"edge_distance_px", real(differing.evidence.edgeDistance)},
            {"domain_distance", real(differing.evidence.domainDistance)},
            {"opacity", real(differing.evidence.opacity)},
            {"opacity_low", real(differing.evidence.opacityLow)},
            {"opacity_high", real(differing.evidence.opacityHigh)}};
}

Json oracleJson(const CompareResult& result) {
    Json json{{"poses", result.fragmentChecks.size()},
              {"ms_a_pose", result.oracleMilliseconds ? Json(rounded(*result.oracleMilliseconds)) : Json()},
              {"by_reason", Json::object()},
              {"checks", Json::array()},
              {"differing", Json::array()}};
    for (const oracle::Doubt doubt : kDoubts) {
        json["by_reason"][toString(doubt)] = countOf(doubt, result.fragmentChecks);
    }
    for (const FragmentCheck& check : result.fragmentChecks) {
        json["checks"].push_back({{"pose", check.pose},
                                  {"device", check.onDevice},
                                  {"oracle", check.byOracle},
                                  {"differing", check.differing.size()}});
        for (const DifferingFragment& fragment : check.differing) {
            json["differing"].push_back(fragmentJson(fragment));
        }
    }
    return json;
}

std::string plural(std::uint64_t count, const std::string& unit) {
    const bool one = count == 1 && unit.ends_with('s');
    return grouped(count) + " " + (one ? unit.substr(0, unit.size() - 1) : unit);
}

/// Three significant digits.
std::string milliseconds(double value) {
    char text[32];
    static_cast<void>(std::snprintf(text, sizeof text,
                                    value < 1     ? "%.3f ms"
                                    : value < 100 ? "%.3g ms"
                                                  : "%.0f ms",
                                    value));
    return text;
}

std::string sentenceOf(const CompareVerdict& verdict) {
    if (!verdict.unchecked.empty()) {
        return verdict.members + ": not checked, " + verdict.unchecked;
    }
    if (verdict.failed()) {
        return concat("DISAGREEMENT: ", verdict.rule, ": pose ", verdict.first->pose, ": ", verdict.first->text);
    }
    if (verdict.unit == "fragments") {
        return "of " + plural(verdict.compared, "fragments") + " from the device's rasteriser or the oracle, " +
               grouped(verdict.differing) + " are from one of them only" +
               (verdict.differing > 0 ? ", each within rounding of a decision" : "") + " (" + verdict.detail + ")";
    }
    const std::string where = (verdict.compared == 1 ? "the one pose" : "all " + plural(verdict.compared, "poses"));
    if (verdict.differing == 0) {
        return verdict.byRule ? verdict.rule + ", on " + where : verdict.members + " count the same on " + where;
    }
    return verdict.members + " differ on " + grouped(verdict.differing) + " of " + plural(verdict.compared, "poses") +
           ", by at most " + plural(verdict.largest, "fragments") + " (" + verdict.detail + ")";
}

std::string speedOf(const Series& series, const std::string& what) {
    return "fastest " + what + ": " + series.method + " (" + milliseconds(medianOf(series.wall)) + ", " +
           grouped(static_cast<std::uint64_t>(std::llround(*series.pairsPerSecond()))) + " pairs per second)";
}

/// Returns the results as sentences: the agreement, then the speed.
std::vector<std::string> summarize(const CompareResult& result) {
    std::vector<std::string> sentences;
    for (const CompareVerdict& verdict : result.verdicts) {
        sentences.push_back(sentenceOf(verdict));
    }
    const auto addFastest = [&](Mode mode, std::uint32_t batch, const char* what) {
        const Series* const best = fastestOf(
            result.series, [&](const Series& series) { return series.mode == mode && series.batch == batch; });
        if (best != nullptr) {
            sentences.push_back(speedOf(*best, what));
        }
    };
    addFastest(Mode::Sync, 1, "for 1 pair, waiting for each");
    addFastest(Mode::Pipelined, 1024, "for 1,024 pairs, in flight");
    return sentences;
}

} // namespace

Json methodJson(const MethodEntry& method) {
    return {{"method", method.name},       {"available", method.available}, {"reason", method.reason},
            {"filter", method.filter},     {"exact", method.exact},         {"trusted", method.trusted},
            {"self_test", method.selfTest}};
}

Row rowOf(const Series& series) {
    return Row()
        .add("sweep", toString(series.sweep))
        .add("method", series.method)
        .add("mode", toString(series.mode))
        .add("batch", series.batch)
        .add("width", series.width)
        .add("height", series.height)
        .add("triangles", series.triangles)
        .add({"fragments", "fragments_a_pair"}, series.fragments)
        .add({"samples", ""}, series.wall.size())
        .add("wall_ms", series.wall, {"_median", "_p10", "_p90"})
        .add("gpu_ms", series.gpu, {"_median"})
        .add("pairs_per_s", series.pairsPerSecond())
        .add("fragments_per_s", series.fragmentsPerSecond())
        .add({"voxels", ""}, sizeText(series.voxels))
        .add("pairs_a_sample", series.pairs);
}

io::Table seriesTable(const std::vector<Series>& series) {
    return tableOf(cellsOf(series, [](const Series& one) { return rowOf(one); }), rowOf(Series()).cells());
}

Json seriesJson(const std::vector<Series>& series, const Machine& machine) {
    return arrayOf(series, [&](const Series& one) {
        return rowOf(one).member("machine", machineJson(machine)).member("voxels", one.voxels).json();
    });
}

Json sceneJson(const Scene& scene) {
    return {{"volume", scene.volume->name},
            {"voxels", scene.volume->data.grid.size},
            {"voxel_type", toString(scene.volume->data.type)},
            {"mesh", scene.mesh->name},
            {"triangles", scene.mesh->triangles()},
            {"poses", scene.poses.size()},
            {"poses_from", scene.posesFrom},
            {"width", scene.view.width},
            {"height", scene.view.height},
            {"threshold", scene.volume->threshold},
            {"opacity", opacityText(scene.volume->points)},
            {"tf_domain", {scene.volume->domain.lo, scene.volume->domain.hi}},
            {"tf_size", scene.volume->tableSize}};
}

Output compareOutput(const Scene& scene, const CompareResult& result) {
    Output output{.machine = result.machine,
                  .members = {},
                  .table = seriesTable(result.series),
                  .sentences = summarize(result),
                  .notes = result.notes};
    Json& json = output.members;
    json["scene"] = sceneJson(scene);
    json["summary"] = output.sentences;
    json["agrees"] = result.agrees() ? Json(*result.agrees()) : Json();
    json["methods"] = arrayOf(result.methods, methodJson);
    json["agreement"] = arrayOf(result.verdicts, verdictJson);
    json["oracle"] = oracleJson(result);
    json["poses"] = result.poseNumbers;
    json["counts"] = Json::object();
    for (const NamedCounts& counts : result.counts) {
        json["counts"][counts.method] = counts.counts;
    }
    json["series"] = seriesJson(result.series, result.machine);
    return output;
}

} // namespace voxtact::lab
