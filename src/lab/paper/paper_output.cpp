// SPDX-License-Identifier: MIT
#include "lab/paper/paper_output.h"

#include "lab/compare/compare_output.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <sstream>

namespace voxtact::lab {

namespace {

using Json = nlohmann::ordered_json;

struct NamedClock {
    const char* name;
    const char* title;
    PaperColumns PaperRow::*columns;
};
constexpr NamedClock kClocks[] = {
    {"gpu", "By GPU timestamps", &PaperRow::gpu},
    {"wall", "By wall clock, from the submission to the end of the wait", &PaperRow::wall}};

/// A row of CSV.
io::NamedCells fullCells(const PaperRow& row, const NamedClock& clock, const PaperResult& result) {
    const PaperScene& scene = result.scenes[row.scene];
    const PaperColumns& columns = row.*clock.columns;
    io::NamedCells cells{{"scene", scene.name},
                         {"method", row.method},
                         {"clock", std::string(clock.name)},
                         {"width", std::uint64_t{result.width}},
                         {"height", std::uint64_t{result.height}},
                         {"triangles", std::uint64_t{scene.triangles}},
                         {"poses", std::uint64_t{scene.poses}},
                         {"survivors", rounded(row.survivors)},
                         {"hits", std::uint64_t{row.hits}},
                         {"samples", std::uint64_t{row.wall.rendering.size()}},
                         {"mesh_ms", cellOf(columns.mesh, &Spread::median)},
                         {"volume_ms", cellOf(columns.volume, &Spread::median)}};
    const std::pair<std::string, const std::vector<double>*> times[] = {
        {"collision_ms", &columns.collision}, {"rendering_ms", &columns.rendering}, {"total_ms", &columns.total}};
    for (const auto& [name, samples] : times) {
        cells.emplace_back(name, cellOf(*samples, &Spread::median));
        cells.emplace_back(name + "_p10", cellOf(*samples, &Spread::p10));
        cells.emplace_back(name + "_p90", cellOf(*samples, &Spread::p90));
    }
    const std::vector<double> overhead = overheadPercent(columns);
    const std::optional<MedianInterval> interval = medianInterval(overhead, kConfidence);
    cells.emplace_back("collision_percent", cellOf(collisionPercent(columns), &Spread::median));
    cells.emplace_back("overhead_percent", cellOf(overhead, &Spread::median));
    cells.emplace_back("overhead_low", interval ? io::Cell(rounded(interval->low)) : io::Cell());
    cells.emplace_back("overhead_high", interval ? io::Cell(rounded(interval->high)) : io::Cell());
    cells.emplace_back("confidence", interval ? io::Cell(rounded(interval->confidence)) : io::Cell());
    return cells;
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
    return samples.empty() ? io::Cell() : io::Cell(shortNumber(spreadOf(samples).median));
}

io::Cell withInterval(const std::vector<double>& samples) {
    return samples.empty() ? io::Cell() : io::Cell(overheadText(samples));
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
    cells.emplace_back("overhead %", withInterval(overheadPercent(columns)));
    return cells;
}

bool hasTimes(const NamedClock& clock, const PaperResult& result) {
    return std::ranges::any_of(result.rows,
                               [&](const PaperRow& row) { return !(row.*clock.columns).rendering.empty(); });
}

io::NamedCells sceneCells(const PaperScene& scene) {
    return {{"scene", scene.name},
            {"volume", scene.volume},
            {"voxels", sizeText(scene.voxels)},
            {"opacity", scene.opacity},
            {"opaque_share", rounded(scene.opaqueShare)},
            {"mesh", scene.mesh},
            {"triangles", std::uint64_t{scene.triangles}},
            {"poses", std::uint64_t{scene.poses}},
            {"step_mm", rounded(scene.step)}};
}

io::NamedCells wayCells(const LocalizeWay& way) {
    const bool found = way.unchecked.empty();
    const auto ifFound = [found](std::uint64_t value) { return found ? io::Cell(value) : io::Cell(); };
    return {{"way", way.name},
            {"queries", cellOf(way.queries)},
            {"found", ifFound(way.triangles)},
            {"missed", ifFound(way.missed)},
            {"wrong", ifFound(way.wrong)},
            {"samples", std::uint64_t{way.wall.size()}},
            {"wall_ms_median", cellOf(way.wall, &Spread::median)},
            {"wall_ms_p10", cellOf(way.wall, &Spread::p10)},
            {"wall_ms_p90", cellOf(way.wall, &Spread::p90)},
            {"gpu_ms_median", cellOf(way.gpu, &Spread::median)},
            {"unchecked", way.unchecked}};
}

io::NamedCells integrationCells(const IntegrationPoint& point) {
    return {{"entries", std::uint64_t{point.entries}},
            {"samples", std::uint64_t{point.wall.size()}},
            {"gpu_ms_median", cellOf(point.gpu, &Spread::median)},
            {"wall_ms_median", cellOf(point.wall, &Spread::median)},
            {"wall_ms_p10", cellOf(point.wall, &Spread::p10)},
            {"wall_ms_p90", cellOf(point.wall, &Spread::p90)}};
}

io::NamedCells publishedCells(const published::Row& row) {
    return {{"table", std::to_string(row.table)},
            {"scene", std::string(row.scene)},
            {"mesh", row.mesh},
            {"volume", row.volume},
            {"collision", row.collision},
            {"total rendering", row.rendering},
            {"total", row.total},
            {"overhead %", row.overhead}};
}

struct Section {
    std::string title;
    io::Table table;
};

/// The tables like the paper's.
std::vector<Section> paperSections(const PaperResult& result) {
    std::vector<Section> sections;
    for (const NamedClock& clock : kClocks) {
        if (hasTimes(clock, result)) {
            sections.push_back(
                {std::string(clock.title) +
                     ", ms: medians, with the 10th and 90th percentile; of the overhead, the "
                     "interval that has the median with a confidence of 95 % or more; an overhead below 0 is noise",
                 tableOf(rowsOf(result.rows, [&](const PaperRow& row) { return paperCells(row, clock, result); }))});
        }
    }
    return sections;
}

/// As the paper prints them, for comparison.
Section publishedSection() {
    std::string title = "The paper's own tables, average ms a frame as printed";
    for (std::size_t i = 0; i < published::kHardware.size(); ++i) {
        title += "; Table " + std::to_string(i + 1) + ": " + published::kHardware.at(i);
    }
    return {title, tableOf(rowsOf(published::kTables, publishedCells))};
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
                            tableOf(rowsOf(result.polygons, wayCells))});
    }
    if (!result.integration.empty()) {
        sections.push_back({"Making the pre-integrated table", tableOf(rowsOf(result.integration, integrationCells))});
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
            rows.push_back(fullCells(row, clock, result));
        }
    }
    return rows;
}

/// Samples of percents, with the interval of their median.
Json percentJson(const std::vector<double>& samples) {
    Json json = spreadJson(samples);
    if (json.is_null()) {
        return json;
    }
    const std::optional<MedianInterval> interval = medianInterval(samples, kConfidence);
    json["low"] = interval ? Json(rounded(interval->low)) : Json();
    json["high"] = interval ? Json(rounded(interval->high)) : Json();
    json["confidence"] = interval ? Json(rounded(interval->confidence)) : Json();
    return json;
}

Json columnsJson(const PaperColumns& columns) {
    if (columns.rendering.empty()) {
        return nullptr;
    }
    return {{"mesh_ms", spreadJson(columns.mesh)},
            {"volume_ms", spreadJson(columns.volume)},
            {"collision_ms", spreadJson(columns.collision)},
            {"rendering_ms", spreadJson(columns.rendering)},
            {"total_ms", spreadJson(columns.total)},
            {"collision_percent", percentJson(collisionPercent(columns))},
            {"overhead_percent", percentJson(overheadPercent(columns))}};
}

Json paperSceneJson(const PaperScene& scene) {
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

Json publishedJson(const published::Row& row) {
    return {{"table", row.table},
            {"scene", row.scene},
            {"mesh_ms", row.mesh},
            {"volume_ms", row.volume},
            {"collision_ms", row.collision},
            {"rendering_ms", row.rendering},
            {"total_ms", row.total},
            {"overhead_percent", row.overhead}};
}

Json rowJson(const PaperRow& row, const PaperResult& result) {
    return {{"scene", result.scenes[row.scene].name},
            {"method", row.method},
            {"survivors", rounded(row.survivors)},
            {"hits", row.hits},
            {"gpu", columnsJson(row.gpu)},
            {"wall", columnsJson(row.wall)}};
}

Json wayJson(const LocalizeWay& way) {
    const auto ifFound = [&way](std::uint64_t value) { return way.unchecked.empty() ? Json(value) : Json(); };
    return {{"name", way.name},
            {"queries", way.queries ? Json(*way.queries) : Json()},
            {"found", ifFound(way.triangles)},
            {"missed", ifFound(way.missed)},
            {"wrong", ifFound(way.wrong)},
            {"wall_ms", spreadJson(way.wall)},
            {"gpu_ms", spreadJson(way.gpu)},
            {"unchecked", way.unchecked}};
}

template <class Things, class JsonOf> Json arrayOf(const Things& things, JsonOf jsonOf) {
    Json array = Json::array();
    for (const auto& thing : things) {
        array.push_back(jsonOf(thing));
    }
    return array;
}

} // namespace

Json paperJson(const PaperResult& result) {
    Json json = provenanceJson(result.machine);
    json["machine"] = machineJson(result.machine);
    json["width"] = result.width;
    json["height"] = result.height;
    json["published"] = {{"pairs_per_s", published::kPairsPerSecond},
                         {"overhead_percent", {published::kOverhead.lo, published::kOverhead.hi}},
                         {"hardware", published::kHardware},
                         {"tables", arrayOf(published::kTables, publishedJson)},
                         {"preintegration_ms", published::kIntegrationMilliseconds}};
    json["summary"] = paperSummary(result);
    json["agrees"] = result.disagreement.empty();
    json["scenes"] = arrayOf(result.scenes, paperSceneJson);
    json["tables"] = arrayOf(result.rows, [&](const PaperRow& row) { return rowJson(row, result); });
    json["series"] = arrayOf(result.series, [&](const Series& series) { return seriesJson(series, result.machine); });
    json["polygons"] = {{"triangles", result.polygonTriangles},
                        {"poses", result.polygonPoses},
                        {"ways", arrayOf(result.polygons, wayJson)}};
    json["integration"] = arrayOf(result.integration, [](const IntegrationPoint& point) {
        return Json{{"entries", point.entries}, {"gpu_ms", spreadJson(point.gpu)}, {"wall_ms", spreadJson(point.wall)}};
    });
    json["notes"] = allNotes(result.machine, result.notes);
    return json;
}

void writePaper(std::ostream& out, io::Format format, const PaperResult& result) {
    if (format == io::Format::Json) {
        out << paperJson(result).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    const Section scenes{"Scenes, frames of " + std::to_string(result.width) + "x" + std::to_string(result.height),
                         tableOf(rowsOf(result.scenes, sceneCells))};
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
    for (const std::string& sentence : paperSummary(result)) {
        out << "# " << sentence << '\n';
    }
    writeMachine(out, result.machine, result.notes);
}

} // namespace voxtact::lab
