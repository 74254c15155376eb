// SPDX-License-Identifier: MIT
#include "lab/compare/compare_localize.h"

#include "lab/compare/compare_output.h"

#include <nlohmann/json.hpp>

#include <iomanip>
#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;

/// Of the certified triangles.
double percentMissed(const LocalizeWay& way, const LocalizeResult& result) {
    const std::uint64_t certified = result.ways.back().triangles;
    return certified == 0 ? 0 : 100.0 * static_cast<double>(way.missed) / static_cast<double>(certified);
}

io::Table waysTable(const LocalizeResult& result) {
    return tableOf(rowsOf(result.ways, [&](const LocalizeWay& way) {
        io::NamedCells cells{{"way", way.name},
                             {"poses", std::uint64_t{way.found.size()}},
                             {"triangles", way.triangles},
                             {"missed", way.missed},
                             {"missed_percent", rounded(percentMissed(way, result))},
                             {"false", way.wrong},
                             {"queries", cellOf(way.queries)},
                             {"boxes", cellOf(way.boxes)},
                             {"samples", std::uint64_t{way.wall.size()}},
                             {"wall_ms_median", cellOf(way.wall, &Spread::median)},
                             {"wall_ms_p10", cellOf(way.wall, &Spread::p10)},
                             {"wall_ms_p90", cellOf(way.wall, &Spread::p90)},
                             {"gpu_ms_median", cellOf(way.gpu, &Spread::median)}};
        for (std::size_t i = 1; !way.unchecked.empty() && i < cells.size(); ++i) {
            cells[i].second = {};
        }
        return cells;
    }));
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

Json localizeJson(const Scene& scene, const LocalizeResult& result) {
    Json json = provenanceJson(result.machine);
    json["machine"] = machineJson(result.machine);
    json["scene"] = sceneJson(scene);
    json["summary"] = sentences(result);
    json["agrees"] = !result.failedPose.has_value();
    json["poses"] = result.poseNumbers;
    json["ways"] = io::rowsJson(waysTable(result));
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

void writeLocalize(std::ostream& out, io::Format format, const Scene& scene, const LocalizeResult& result) {
    if (format == io::Format::Json) {
        out << localizeJson(scene, result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    io::writeTable(out, format, waysTable(result));
    for (const std::string& sentence : sentences(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::lab
