// SPDX-License-Identifier: MIT
#include "lab/compare/localize.h"
#include "lab/compare/output.h"

#include <iomanip>
#include <sstream>

namespace voxtact::lab {

namespace {

/// Of the certified triangles.
double percentMissed(const LocalizeWay& way, const LocalizeResult& result) {
    const std::uint64_t certified = result.ways.back().triangles;
    return certified == 0 ? 0 : 100.0 * static_cast<double>(way.missed) / static_cast<double>(certified);
}

/// JSON has the cells too, with all their names.
io::Table waysTable(const LocalizeResult& result) {
    const auto cellsOf = [&](const LocalizeWay& way) {
        io::NamedCells cells = Row()
                                   .add("way", way.name)
                                   .add("poses", way.found.size())
                                   .add("triangles", way.triangles)
                                   .add("missed", way.missed)
                                   .add("missed_percent", percentMissed(way, result))
                                   .add("false", way.wrong)
                                   .add("queries", way.queries)
                                   .add("boxes", way.boxes)
                                   .add("samples", way.wall.size())
                                   .add("wall_ms", way.wall, {"_median", "_p10", "_p90"})
                                   .add("gpu_ms", way.gpu, {"_median"})
                                   .cells();
        for (std::size_t i = 1; !way.unchecked.empty() && i < cells.size(); ++i) {
            cells[i].second = {};
        }
        return cells;
    };
    std::vector<io::NamedCells> rows;
    std::ranges::transform(result.ways, std::back_inserter(rows), cellsOf);
    return tableOf(std::move(rows));
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
    Json json = headJson(result.machine);
    json["scene"] = sceneJson(scene);
    json["summary"] = sentences(result);
    json["agrees"] = !result.failedPose.has_value();
    json["poses"] = result.poseNumbers;
    json["ways"] = io::rowsJson(waysTable(result));
    json["not_certified"] = arrayOf(result.wrong, [](const WrongTriangle& wrong) {
        return Json{{"pose", wrong.pose},
                    {"triangle", wrong.triangle},
                    {"fragments", wrong.fragments},
                    {"certified", wrong.certified}};
    });
    json["notes"] = allNotes({result.machine, {}, result.notes});
    return json;
}

} // namespace

void writeLocalize(std::ostream& out, io::Format format, const Scene& scene, const LocalizeResult& result) {
    if (format == io::Format::Json) {
        writeJson(out, localizeJson(scene, result));
        return;
    }
    io::writeTable(out, format, waysTable(result));
    writeFindings(out, {result.machine, sentences(result), result.notes});
}

} // namespace voxtact::lab
