// SPDX-License-Identifier: MIT
#include "lab/compare/compare_output.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <ostream>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;

Json verdictJson(const Verdict& verdict) {
    Json json{{"rule", verdict.rule},
              {"required", verdict.required},
              {"checked", verdict.unchecked.empty()},
              {"agrees", !verdict.failed()},
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

Json fragmentJson(const DifferingFragment& fragment) {
    // What is far away is infinite, and JSON has no word for it.
    const auto real = [](double value) { return std::isfinite(value) ? Json(rounded(value)) : Json(); };
    return {{"pose", fragment.pose},
            {"triangle", fragment.triangle},
            {"x", fragment.x},
            {"y", fragment.y},
            {"on", fragment.onDevice ? "device" : "oracle"},
            {"reason", fragment.reason},
            {"edge_distance_px", real(fragment.edgeDistance)},
            {"domain_distance", real(fragment.domainDistance)},
            {"opacity", real(fragment.opacity)},
            {"opacity_low", real(fragment.opacityLow)},
            {"opacity_high", real(fragment.opacityHigh)}};
}

Json oracleJson(const CompareResult& result) {
    const std::array<std::uint64_t, 4> reasons = countReasons(result.fragmentChecks);
    Json json{{"poses", result.fragmentChecks.size()},
              {"ms_a_pose", result.oracleMilliseconds ? Json(rounded(*result.oracleMilliseconds)) : Json()},
              {"by_reason", Json::object()},
              {"checks", Json::array()},
              {"differing", Json::array()}};
    for (std::size_t i = 0; i < reasons.size(); ++i) {
        json["by_reason"][kReasons.at(i)] = reasons.at(i);
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

io::NamedCells cellsOf(const Series& series) {
    return {{"sweep", std::string(toString(series.sweep))},
            {"method", series.method},
            {"mode", std::string(toString(series.mode))},
            {"batch", std::uint64_t{series.batch}},
            {"width", std::uint64_t{series.width}},
            {"height", std::uint64_t{series.height}},
            {"triangles", std::uint64_t{series.triangles}},
            {"fragments", cellOf(series.fragments)},
            {"samples", std::uint64_t{series.wall.size()}},
            {"wall_ms_median", cellOf(series.wall, &Spread::median)},
            {"wall_ms_p10", cellOf(series.wall, &Spread::p10)},
            {"wall_ms_p90", cellOf(series.wall, &Spread::p90)},
            {"gpu_ms_median", cellOf(series.gpu, &Spread::median)},
            {"pairs_per_s", rounded(series.pairsPerSecond())},
            {"fragments_per_s", cellOf(series.fragmentsPerSecond())},
            {"voxels", sizeText(series.voxels)}};
}

} // namespace

Json spreadJson(const std::vector<double>& samples) {
    if (samples.empty()) {
        return nullptr;
    }
    const Spread spread = spreadOf(samples);
    Json json{{"median", rounded(spread.median)}, {"min", rounded(spread.min)}, {"max", rounded(spread.max)},
              {"p10", rounded(spread.p10)},       {"p90", rounded(spread.p90)}, {"samples", Json::array()}};
    for (const double sample : samples) {
        json["samples"].push_back(rounded(sample));
    }
    return json;
}

Json seriesJson(const Series& series, const Machine& machine) {
    const std::optional<double> fragments = series.fragmentsPerSecond();
    return {{"sweep", toString(series.sweep)},
            {"method", series.method},
            {"mode", toString(series.mode)},
            {"batch", series.batch},
            {"width", series.width},
            {"height", series.height},
            {"triangles", series.triangles},
            {"pairs_a_sample", series.pairs},
            {"fragments_a_pair", series.fragments ? Json(rounded(*series.fragments)) : Json()},
            {"wall_ms", spreadJson(series.wall)},
            {"gpu_ms", spreadJson(series.gpu)},
            {"pairs_per_s", rounded(series.pairsPerSecond())},
            {"fragments_per_s", fragments ? Json(rounded(*fragments)) : Json()},
            {"machine", machineJson(machine)},
            {"voxels", series.voxels}};
}

io::Table seriesTable(const std::vector<Series>& series) {
    return tableOf(rowsOf(series, cellsOf), cellsOf({}));
}

Json machineJson(const Machine& machine) {
    return {{"device", machine.device},
            {"device_type", machine.deviceType},
            {"driver", machine.driver},
            {"driver_version", machine.driverVersion},
            {"api", machine.api},
            {"cpu", machine.cpu},
            {"cpu_threads", machine.cpuThreads},
            {"voxtact", machine.provenance.version},
            {"git_revision", machine.provenance.gitRevision},
            {"hardware_filter", machine.filter}};
}

Json provenanceJson(const Machine& machine) {
    return {{"voxtact", machine.provenance.version},
            {"git_revision", machine.provenance.gitRevision},
            {"command", machine.provenance.command}};
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
            {"threshold", scene.volume->threshold}};
}

std::vector<std::string> allNotes(const Machine& machine, const std::vector<std::string>& more) {
    std::vector<std::string> notes = machine.notes;
    notes.insert(notes.end(), more.begin(), more.end());
    return notes;
}

void writeMachine(std::ostream& out, const Machine& machine, const std::vector<std::string>& notes) {
    if (!machine.device.empty()) {
        out << "# device " << machine.device << ", driver " << machine.driver << " " << machine.driverVersion << ", ";
    } else {
        out << "# no device, ";
    }
    out << "cpu " << machine.cpu << ", " << machine.cpuThreads << " threads\n";
    if (!machine.filter.empty()) {
        out << "# " << machine.filter << '\n';
    }
    for (const std::string& note : allNotes(machine, notes)) {
        out << "# " << note << '\n';
    }
}

Json compareJson(const Scene& scene, const CompareResult& result) {
    Json json = provenanceJson(result.machine);
    json["machine"] = machineJson(result.machine);
    json["scene"] = sceneJson(scene);
    json["summary"] = summarize(result);
    json["agrees"] = result.firstFailure() == nullptr;
    json["methods"] = Json::array();
    for (const MethodEntry& method : result.methods) {
        json["methods"].push_back({{"method", method.name},
                                   {"available", method.available},
                                   {"reason", method.reason},
                                   {"filter", method.filter},
                                   {"exact", method.exact}});
    }
    json["agreement"] = Json::array();
    for (const Verdict& verdict : result.verdicts) {
        json["agreement"].push_back(verdictJson(verdict));
    }
    json["oracle"] = oracleJson(result);
    json["poses"] = result.poseNumbers;
    json["counts"] = Json::object();
    for (const NamedCounts& counts : result.counts) {
        json["counts"][counts.method] = counts.counts;
    }
    json["series"] = Json::array();
    for (const Series& series : result.series) {
        json["series"].push_back(seriesJson(series, result.machine));
    }
    json["notes"] = allNotes(result.machine, result.notes);
    return json;
}

void writeCompare(std::ostream& out, io::Format format, const Scene& scene, const CompareResult& result) {
    if (format == io::Format::Json) {
        out << compareJson(scene, result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    io::writeTable(out, format, seriesTable(result.series));
    for (const std::string& sentence : summarize(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::lab
