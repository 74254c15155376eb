// SPDX-License-Identifier: MIT
#include "lab/compare_localize.h"

#include "lab/compare_output.h"

#include <nlohmann/json.hpp>

#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kColumns{"way",         "poses",       "triangles",    "missed",  "missed_percent",
                                        "false",       "queries",     "boxes",        "samples", "wall_ms_median",
                                        "wall_ms_p10", "wall_ms_p90", "gpu_ms_median"};

/// Of the certified triangles.
double percentMissed(const LocalizeWay& way, const LocalizeResult& result) {
    const std::uint64_t certified = result.ways.back().triangles;
    return certified == 0 ? 0 : 100.0 * static_cast<double>(way.missed) / static_cast<double>(certified);
}

io::Cell cellOf(const LocalizeWay& way, const LocalizeResult& result, std::size_t column) {
    const auto spread = [](const std::vector<double>& samples, double Spread::*part) {
        return samples.empty() ? io::Cell() : io::Cell(rounded(spreadOf(samples).*part));
    };
    const auto maybe = [](const std::optional<std::uint64_t>& value) { return value ? io::Cell(*value) : io::Cell(); };
    if (!way.unchecked.empty() && column > 0) {
        return {};
    }
    switch (column) {
    case 0:
        return way.name;
    case 1:
        return std::uint64_t{way.found.size()};
    case 2:
        return way.triangles;
    case 3:
        return way.missed;
    case 4:
        return rounded(percentMissed(way, result));
    case 5:
        return way.wrong;
    case 6:
        return maybe(way.queries);
    case 7:
        return maybe(way.boxes);
    case 8:
        return std::uint64_t{way.wall.size()};
    case 9:
        return spread(way.wall, &Spread::median);
    case 10:
        return spread(way.wall, &Spread::p10);
    case 11:
        return spread(way.wall, &Spread::p90);
    default:
        return spread(way.gpu, &Spread::median);
    }
}

io::Table tableOf(const LocalizeResult& result) {
    io::Table table;
    table.columns = kColumns;
    table.rows = result.ways.size();
    table.cell = [&result](std::size_t row, std::size_t column) { return cellOf(result.ways[row], result, column); };
    return table;
}

std::vector<std::string> sentences(const LocalizeResult& result) {
    std::vector<std::string> out;
    out.push_back(result.failedPose ? "polygon = leaf = leaf-bricks = fragments: NO, on pose " +
                                          std::to_string(*result.failedPose) + ": " + result.failure
                                    : "polygon = leaf = leaf-bricks = fragments: the same triangles with the same "
                                      "counts on every pose");
    std::ostringstream missed;
    missed << "the camera shows " << grouped(result.ways.front().triangles) << " touching triangles, "
           << grouped(result.ways.back().triangles) << " certainly touch: " << std::fixed << std::setprecision(1)
           << percentMissed(result.ways.front(), result) << " % are missed";
    out.push_back(missed.str());
    for (const WrongTriangle& wrong : result.wrong) {
        out.push_back("found and not certified: pose " + std::to_string(wrong.pose) + ", triangle " +
                      std::to_string(wrong.triangle) + ", " + std::to_string(wrong.fragments) +
                      " fragments; by bounds: " + wrong.certified);
    }
    return out;
}

Json localizeJson(const CompareData& data, const LocalizeResult& result) {
    Json json = provenanceJson(result.machine);
    json["machine"] = machineJson(result.machine);
    json["scene"] = sceneJson(data);
    json["summary"] = sentences(result);
    json["agrees"] = !result.failedPose.has_value();
    json["poses"] = result.poseNumbers;
    json["ways"] = io::rowsJson(tableOf(result));
    json["not_certified"] = Json::array();
    for (const WrongTriangle& wrong : result.wrong) {
        json["not_certified"].push_back({{"pose", wrong.pose},
                                         {"triangle", wrong.triangle},
                                         {"fragments", wrong.fragments},
                                         {"certified", wrong.certified}});
    }
    json["notes"] = allNotes(result.machine, result.notes);
    return json;
}

} // namespace

void writeLocalize(std::ostream& out, io::Format format, const CompareData& data, const LocalizeResult& result) {
    if (format == io::Format::Json) {
        out << localizeJson(data, result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    io::writeTable(out, format, tableOf(result));
    for (const std::string& sentence : sentences(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::app
