// SPDX-License-Identifier: MIT
#include "bench/compare/output.h"
#include "bench/paper/paper.h"

#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

/// The interval of the median of percents.
Row intervalOf(const std::vector<double>& percents) {
    const std::optional<MedianInterval> interval = medianInterval(percents, kConfidence);
    const auto known = [&](double MedianInterval::*part) {
        return interval ? std::optional((*interval).*part) : std::nullopt;
    };
    return Row()
        .add({"overhead_low", "low"}, known(&MedianInterval::low))
        .add({"overhead_high", "high"}, known(&MedianInterval::high))
        .add("confidence", known(&MedianInterval::confidence));
}

/// Their spread, with that interval.
Json percentJson(const std::vector<double>& percents) {
    Json json = spreadJson(percents);
    if (!json.is_null()) {
        json.update(intervalOf(percents).json());
    }
    return json;
}

/// A row of CSV; of JSON what the clock says.
Row rowOf(const PaperRow& row, const PaperClock& clock, const PaperResult& result) {
    const PaperScene& scene = result.scenes[row.scene];
    const PaperColumns& columns = row.*clock.columns;
    const std::vector<double> collision = collisionPercent(columns);
    const std::vector<double> overhead = overheadPercent(columns);
    return Row()
        .column("scene", scene.name)
        .column("method", row.method)
        .column("clock", clock.name)
        .column("width", result.width)
        .column("height", result.height)
        .column("triangles", scene.triangles)
        .column("poses", scene.poses)
        .column("survivors", row.survivors)
        .column("hits", row.hits)
        .column("samples", columns.rendering.size())
        .add("mesh_ms", columns.mesh, {""})
        .add("volume_ms", columns.volume, {""})
        .add("collision_ms", columns.collision, {"", "_p10", "_p90"})
        .add("rendering_ms", columns.rendering, {"", "_p10", "_p90"})
        .add("total_ms", columns.total, {"", "_p10", "_p90"})
        .add({"collision_percent", ""}, collision, {""})
        .add({"overhead_percent", ""}, overhead, {""})
        .columns(intervalOf(overhead))
        .member("collision_percent", percentJson(collision))
        .member("overhead_percent", percentJson(overhead));
}

std::optional<std::string> alone(const std::vector<double>& samples) {
    return samples.empty() ? std::nullopt : std::optional(shortNumber(medianOf(samples)));
}

/// "12.3 (11.8-13.1)"
std::optional<std::string> withRange(const std::vector<double>& samples) {
    if (samples.empty()) {
        return std::nullopt;
    }
    const Spread spread = spreadOf(samples);
    return shortNumber(spread.median) + " (" + shortNumber(spread.p10) + "-" + shortNumber(spread.p90) + ")";
}

/// A row of the paper's tables.
Row paperRow(const PaperRow& row, const PaperClock& clock, const PaperResult& result) {
    const PaperColumns& columns = row.*clock.columns;
    const std::vector<double> overhead = overheadPercent(columns);
    Row out;
    out.add("scene", result.scenes[row.scene].name).add("method", row.method);
    if (clock.columns == &PaperRow::gpu) {
        out.add("mesh", alone(columns.mesh)).add("volume", alone(columns.volume));
    }
    return out.add("collision", withRange(columns.collision))
        .add("total rendering", withRange(columns.rendering))
        .add("total", withRange(columns.total))
        .add("collision %", alone(collisionPercent(columns)))
        .add("overhead %", overhead.empty() ? std::nullopt : std::optional(overheadText(overhead)));
}

Row rowOf(const PaperScene& scene) {
    return Row()
        .add("scene", scene.name)
        .add("volume", scene.volume)
        .add("voxels", sizeText(scene.voxels))
        .add("opacity", scene.opacity)
        .add("opaque_share", scene.opaqueShare)
        .add("mesh", scene.mesh)
        .add("triangles", scene.triangles)
        .add("poses", scene.poses)
        .add("step_mm", scene.step);
}

Row rowOf(const LocalizeWay& way) {
    const auto ifFound = [&way](std::uint64_t value) {
        return way.unchecked.empty() ? std::optional(value) : std::nullopt;
    };
    return Row()
        .add({"way", "name"}, way.name)
        .add("queries", way.queries)
        .add("found", ifFound(way.triangles))
        .add("missed", ifFound(way.missed))
        .add("wrong", ifFound(way.wrong))
        .column("samples", way.wall.size())
        .add("wall_ms", way.wall, {"_median", "_p10", "_p90"})
        .add("gpu_ms", way.gpu, {"_median"})
        .add("unchecked", way.unchecked);
}

Row rowOf(const IntegrationPoint& point) {
    return Row()
        .add("entries", point.entries)
        .column("samples", point.wall.size())
        .add("gpu_ms", point.gpu, {"_median"})
        .add("wall_ms", point.wall, {"_median", "_p10", "_p90"});
}

/// Numbers as printed.
Row rowOf(const published::TableLine& row) {
    return Row()
        .column("table", std::to_string(row.table))
        .member("table", row.table)
        .add("scene", row.scene)
        .add({"mesh", "mesh_ms"}, row.mesh)
        .add({"volume", "volume_ms"}, row.volume)
        .add({"collision", "collision_ms"}, row.collision)
        .add({"total rendering", "rendering_ms"}, row.rendering)
        .add({"total", "total_ms"}, row.total)
        .add({"overhead %", "overhead_percent"}, row.overhead);
}

template <class Things> io::Table tableOfAll(const Things& things) {
    return tableOf(cellsOf(things, [](const auto& thing) { return rowOf(thing); }));
}
template <class Things> Json jsonOfAll(const Things& things) {
    return arrayOf(things, [](const auto& thing) { return rowOf(thing).json(); });
}

struct Section {
    std::string title;
    io::Table table;
};

/// Tables like the paper's.
void addPaperTables(const PaperResult& result, std::vector<Section>& sections) {
    for (const PaperClock& clock : kPaperClocks) {
        const auto isTimed = [&](const PaperRow& row) { return !(row.*clock.columns).rendering.empty(); };
        if (std::ranges::any_of(result.rows, isTimed)) {
            sections.push_back(
                {std::string(clock.title) +
                     ", ms: medians, with the 10th and 90th percentile; of the overhead, the "
                     "interval that has the median with a confidence of 95 % or more; an overhead below 0 is noise",
                 tableOf(cellsOf(result.rows, [&](const PaperRow& row) { return paperRow(row, clock, result); }))});
        }
    }
}

/// The paper's columns, as printed, and further ones.
void addOthers(const PaperResult& result, std::vector<Section>& sections) {
    std::string title = "The paper's own tables, average ms per frame as printed";
    for (std::size_t i = 0; i < published::kHardware.size(); ++i) {
        title += concat("; Table ", i + 1, ": ", published::kHardware.at(i));
    }
    sections.push_back({title, tableOfAll(published::kTables)});
    if (!result.series.empty()) {
        sections.push_back({"Sweeps in " + result.scenes.front().name + "; of voxels in the builtin head",
                            seriesTable(result.series)});
    }
    if (!result.polygons.empty()) {
        sections.push_back({concat("Which of ", result.polygonTriangles, " triangles touch, in ",
                                   result.scenes.front().name, ", on ", result.polygonPoses, " poses together"),
                            tableOfAll(result.polygons)});
    }
    if (!result.integration.empty()) {
        sections.push_back({"Computing the pre-integrated table", tableOfAll(result.integration)});
    }
}

/// In CSV as comments, so that its rows are of one table.
void write(std::ostream& out, io::Format format, const Section& section) {
    if (format == io::Format::Text) {
        out << "# " << section.title << '\n';
        io::writeTable(out, format, section.table);
        out << '\n';
        return;
    }
    std::stringstream text;
    text << section.title << '\n';
    io::writeTable(text, format, section.table);
    for (std::string line; std::getline(text, line);) {
        out << "# " << line << '\n';
    }
}

/// In another order than its row.
Json sceneJson(const PaperScene& scene) {
    return {{"name", scene.name},
            {"volume", scene.volume},
            {"mesh", scene.mesh},
            {"voxels", scene.voxels},
            {"voxel_type", scene.voxelType},
            {"triangles", scene.triangles},
            {"opaque_share", rounded(scene.opaqueShare)},
            {"opacity", scene.opacity},
            {"poses", scene.poses},
            {"step_mm", rounded(scene.step)}};
}

Json rowJson(const PaperRow& row, const PaperResult& result) {
    Json json{{"scene", result.scenes[row.scene].name},
              {"method", row.method},
              {"survivors", row.survivors ? Json(rounded(*row.survivors)) : Json()},
              {"hits", row.hits}};
    for (const PaperClock& clock : kPaperClocks) {
        const bool timed = !(row.*clock.columns).rendering.empty();
        json[clock.name] = timed ? rowOf(row, clock, result).json() : Json();
    }
    return json;
}

Output outputOf(const PaperResult& result) {
    Output output{.machine = result.machine, .members = {}, .sentences = paperSummary(result), .notes = result.notes};
    Json& json = output.members;
    json["width"] = result.width;
    json["height"] = result.height;
    json["published"] = {{"pairs_per_s", published::kPairsPerSecond},
                         {"overhead_percent", {published::kOverhead.lo, published::kOverhead.hi}},
                         {"hardware", published::kHardware},
                         {"tables", jsonOfAll(published::kTables)},
                         {"preintegration_ms", published::kIntegrationMilliseconds}};
    json["summary"] = output.sentences;
    json["agrees"] = result.disagreement.empty();
    json["methods"] = arrayOf(result.methods, methodJson);
    json["scenes"] = arrayOf(result.scenes, sceneJson);
    json["tables"] = arrayOf(result.rows, [&](const PaperRow& row) { return rowJson(row, result); });
    json["series"] = seriesJson(result.series, result.machine);
    json["polygons"] = {
        {"triangles", result.polygonTriangles}, {"poses", result.polygonPoses}, {"ways", jsonOfAll(result.polygons)}};
    json["integration"] = jsonOfAll(result.integration);
    return output;
}

} // namespace

Json paperJson(const PaperResult& result) {
    return jsonOf(outputOf(result));
}

void writePaper(std::ostream& out, io::Format format, const PaperResult& result) {
    const Output output = outputOf(result);
    if (format == io::Format::Json) {
        writeOutput(out, format, output);
        return;
    }
    std::vector<Section> sections{
        {concat("Scenes, frames of ", result.width, "x", result.height), tableOfAll(result.scenes)}};
    if (format == io::Format::Text) {
        addPaperTables(result, sections);
    } else {
        std::vector<io::NamedCells> rows;
        for (const PaperRow& row : result.rows) {
            for (const PaperClock& clock : kPaperClocks) {
                rows.push_back(rowOf(row, clock, result).cells());
            }
        }
        io::writeTable(out, format, tableOf(std::move(rows)));
    }
    addOthers(result, sections);
    for (const Section& section : sections) {
        write(out, format, section);
    }
    writeFindings(out, output);
}

} // namespace voxtact::lab
