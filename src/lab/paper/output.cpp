// SPDX-License-Identifier: MIT
#include "lab/compare/output.h"
#include "lab/paper/paper.h"

#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

struct NamedClock {
    const char* name;
    const char* title;
    PaperColumns PaperRow::*columns;
};
constexpr NamedClock kClocks[] = {
    {"gpu", "By GPU timestamps", &PaperRow::gpu},
    {"wall", "By wall clock, from the submission to the end of the wait", &PaperRow::wall}};

/// Percents, with the interval of their median.
Row& addPercents(const std::string& name, const std::vector<double>& percents, bool intervalInColumns, Row& row) {
    const std::optional<MedianInterval> interval = medianInterval(percents, kConfidence);
    row.add({(name + "_percent").c_str(), ""}, percents, {""});
    Json json = spreadJson(percents);
    const std::pair<const char*, double MedianInterval::*> parts[] = {
        {"low", &MedianInterval::low}, {"high", &MedianInterval::high}, {"confidence", &MedianInterval::confidence}};
    for (const auto& [part, value] : parts) {
        const auto known = interval ? std::optional((*interval).*value) : std::nullopt;
        if (!json.is_null()) {
            json[part] = known ? Json(rounded(*known)) : Json();
        }
        if (intervalInColumns) {
            const bool whole = std::string_view(part) == "confidence";
            row.add({whole ? part : (name + "_" + part).c_str(), ""}, known);
        }
    }
    return row.member((name + "_percent").c_str(), std::move(json));
}

/// A row of CSV; of JSON what the clock says.
Row rowOf(const PaperRow& row, const NamedClock& clock, const PaperResult& result) {
    const PaperScene& scene = result.scenes[row.scene];
    const PaperColumns& columns = row.*clock.columns;
    Row out;
    out.add({"scene", ""}, scene.name)
        .add({"method", ""}, row.method)
        .add({"clock", ""}, clock.name)
        .add({"width", ""}, result.width)
        .add({"height", ""}, result.height)
        .add({"triangles", ""}, scene.triangles)
        .add({"poses", ""}, scene.poses)
        .add({"survivors", ""}, row.survivors)
        .add({"hits", ""}, row.hits)
        .add({"samples", ""}, row.wall.rendering.size())
        .add("mesh_ms", columns.mesh, {""})
        .add("volume_ms", columns.volume, {""})
        .add("collision_ms", columns.collision, {"", "_p10", "_p90"})
        .add("rendering_ms", columns.rendering, {"", "_p10", "_p90"})
        .add("total_ms", columns.total, {"", "_p10", "_p90"});
    addPercents("collision", collisionPercent(columns), false, out);
    addPercents("overhead", overheadPercent(columns), true, out);
    return out;
}

/// "12.3 (11.8-13.1)"
io::Cell withRange(const std::vector<double>& samples) {
    if (samples.empty()) {
        return {};
    }
    const Spread spread = spreadOf(samples);
    return shortNumber(spread.median) + " (" + shortNumber(spread.p10) + "-" + shortNumber(spread.p90) + ")";
}

io::Cell alone(const std::vector<double>& samples) {
    return samples.empty() ? io::Cell() : io::Cell(shortNumber(medianOf(samples)));
}

/// A row of the paper's tables.
io::NamedCells paperCells(const PaperRow& row, const NamedClock& clock, const PaperResult& result) {
    const PaperColumns& columns = row.*clock.columns;
    io::NamedCells cells{{"scene", result.scenes[row.scene].name}, {"method", row.method}};
    if (clock.columns == &PaperRow::gpu) {
        cells.emplace_back("mesh", alone(columns.mesh));
        cells.emplace_back("volume", alone(columns.volume));
    }
    cells.emplace_back("collision", withRange(columns.collision));
    cells.emplace_back("total rendering", withRange(columns.rendering));
    cells.emplace_back("total", withRange(columns.total));
    cells.emplace_back("collision %", alone(collisionPercent(columns)));
    const std::vector<double> overhead = overheadPercent(columns);
    cells.emplace_back("overhead %", overhead.empty() ? io::Cell() : io::Cell(overheadText(overhead)));
    return cells;
}

bool hasTimes(const NamedClock& clock, const PaperResult& result) {
    return std::ranges::any_of(result.rows,
                               [&](const PaperRow& row) { return !(row.*clock.columns).rendering.empty(); });
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
        .add({"samples", ""}, way.wall.size())
        .add("wall_ms", way.wall, {"_median", "_p10", "_p90"})
        .add("gpu_ms", way.gpu, {"_median"})
        .add("unchecked", way.unchecked);
}

Row rowOf(const IntegrationPoint& point) {
    return Row()
        .add("entries", point.entries)
        .add({"samples", ""}, point.wall.size())
        .add("gpu_ms", point.gpu, {"_median"})
        .add("wall_ms", point.wall, {"_median", "_p10", "_p90"});
}

/// Numbers as printed.
Row rowOf(const published::Row& row) {
    return Row()
        .add({"table", ""}, std::to_string(row.table))
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
    return tableOf(things, [](const auto& thing) { return rowOf(thing); });
}
template <class Things> Json jsonOfAll(const Things& things) {
    return arrayOf(things, [](const auto& thing) { return rowOf(thing).json(); });
}

struct Section {
    std::string title;
    io::Table table;
};

/// The tables like the paper's.
std::vector<Section> paperSections(const PaperResult& result) {
    std::vector<Section> sections;
    for (const NamedClock& clock : kClocks) {
        if (!hasTimes(clock, result)) {
            continue;
        }
        std::vector<io::NamedCells> rows;
        for (const PaperRow& row : result.rows) {
            rows.push_back(paperCells(row, clock, result));
        }
        sections.push_back(
            {std::string(clock.title) +
                 ", ms: medians, with the 10th and 90th percentile; of the overhead, the "
                 "interval that has the median with a confidence of 95 % or more; an overhead below 0 is noise",
             tableOf(std::move(rows))});
    }
    return sections;
}

/// As the paper prints them, for comparison.
Section publishedSection() {
    std::string title = "The paper's own tables, average ms a frame as printed";
    for (std::size_t i = 0; i < published::kHardware.size(); ++i) {
        title += "; Table " + std::to_string(i + 1) + ": " + published::kHardware.at(i);
    }
    return {title, tableOfAll(published::kTables)};
}

/// What there is beside those.
std::vector<Section> otherSections(const PaperResult& result) {
    std::vector<Section> sections;
    if (!result.series.empty()) {
        sections.push_back({"Sweeps in " + result.scenes.front().name + "; of voxels in the builtin head",
                            seriesTable(result.series)});
    }
    if (!result.polygons.empty()) {
        sections.push_back({"Which of " + std::to_string(result.polygonTriangles) + " triangles touch, in " +
                                result.scenes.front().name + ", on " + std::to_string(result.polygonPoses) +
                                " poses together",
                            tableOfAll(result.polygons)});
    }
    if (!result.integration.empty()) {
        sections.push_back({"Making the pre-integrated table", tableOfAll(result.integration)});
    }
    return sections;
}

void writeText(std::ostream& out, const std::vector<Section>& sections) {
    for (const Section& section : sections) {
        out << "# " << section.title << '\n';
        io::writeTable(out, io::Format::Text, section.table);
        out << '\n';
    }
}

/// As comments, so that the rows are of one table.
void writeCommented(std::ostream& out, const std::vector<Section>& sections) {
    std::ostringstream text;
    for (const Section& section : sections) {
        text << section.title << '\n';
        io::writeTable(text, io::Format::Csv, section.table);
    }
    std::istringstream lines(text.str());
    for (std::string line; std::getline(lines, line);) {
        out << "# " << line << '\n';
    }
}

std::vector<io::NamedCells> fullRows(const PaperResult& result) {
    std::vector<io::NamedCells> rows;
    for (const PaperRow& row : result.rows) {
        for (const NamedClock& clock : kClocks) {
            rows.push_back(rowOf(row, clock, result).cells());
        }
    }
    return rows;
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
              {"survivors", rounded(row.survivors)},
              {"hits", row.hits}};
    for (const NamedClock& clock : kClocks) {
        const bool timed = !(row.*clock.columns).rendering.empty();
        json[clock.name] = timed ? rowOf(row, clock, result).json() : Json();
    }
    return json;
}

} // namespace

Json paperJson(const PaperResult& result) {
    Json json = headJson(result.machine);
    json["width"] = result.width;
    json["height"] = result.height;
    json["published"] = {{"pairs_per_s", published::kPairsPerSecond},
                         {"overhead_percent", {published::kOverhead.lo, published::kOverhead.hi}},
                         {"hardware", published::kHardware},
                         {"tables", jsonOfAll(published::kTables)},
                         {"preintegration_ms", published::kIntegrationMilliseconds}};
    json["summary"] = paperSummary(result);
    json["agrees"] = result.disagreement.empty();
    json["scenes"] = arrayOf(result.scenes, [](const PaperScene& scene) { return sceneJson(scene); });
    json["tables"] = arrayOf(result.rows, [&](const PaperRow& row) { return rowJson(row, result); });
    json["series"] = seriesJson(result.series, result.machine);
    json["polygons"] = {
        {"triangles", result.polygonTriangles}, {"poses", result.polygonPoses}, {"ways", jsonOfAll(result.polygons)}};
    json["integration"] = jsonOfAll(result.integration);
    json["notes"] = allNotes({result.machine, {}, result.notes});
    return json;
}

void writePaper(std::ostream& out, io::Format format, const PaperResult& result) {
    if (format == io::Format::Json) {
        writeJson(out, paperJson(result));
        return;
    }
    const Section scenes{"Scenes, frames of " + std::to_string(result.width) + "x" + std::to_string(result.height),
                         tableOfAll(result.scenes)};
    if (format == io::Format::Text) {
        writeText(out, {scenes});
        writeText(out, paperSections(result));
        writeText(out, {publishedSection()});
        writeText(out, otherSections(result));
    } else {
        io::writeTable(out, format, tableOf(fullRows(result)));
        writeCommented(out, {scenes, publishedSection()});
        writeCommented(out, otherSections(result));
    }
    writeFindings(out, {result.machine, paperSummary(result), result.notes});
}

} // namespace voxtact::lab
