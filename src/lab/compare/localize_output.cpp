// SPDX-License-Identifier: MIT
#include "core/base/text_stream.h"
#include "lab/compare/localize.h"
#include "lab/compare/output.h"

#include <iomanip>

namespace voxtact::lab {

namespace {

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

std::vector<std::string> sentences(const LocalizeResult& result) {
    std::vector<std::string> out;
    const Verdict& verdict = result.verdict;
    out.push_back(verdict.rule + (verdict.failed() ? ": NO, on pose " + std::to_string(verdict.first->pose) + ": " +
                                                         verdict.first->text
                                                   : ": the same triangles with the same counts on every pose"));
    TextStream missed;
    missed << "the camera shows " << grouped(result.ways.front().triangles) << " touching triangles, "
           << grouped(result.ways.back().triangles) << " certainly touch";
    if (const auto percent = percentOf(result.ways.front().missed, result.ways.back().triangles)) {
        missed << ": " << std::fixed << std::setprecision(1) << *percent << " % are missed";
    }
    out.push_back(missed.str());
    for (const WrongTriangle& wrong : result.wrong) {
        out.push_back("found and not certified: pose " + std::to_string(wrong.pose) + ", triangle " +
                      std::to_string(wrong.triangle) + ", " + std::to_string(wrong.fragments) +
                      " fragments; by bounds: " + wrong.certified);
    }
    return out;
}

} // namespace

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
    json["agrees"] = !result.verdict.failed();
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
