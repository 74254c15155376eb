// SPDX-License-Identifier: MIT
#include "bench/measure/columns.h"

#include <algorithm>
#include <ostream>
#include <string_view>

namespace voxtact::lab {

namespace {

double partOf(const Spread& spread, std::string_view part) {
    return part == "_p10"   ? spread.p10
           : part == "_p90" ? spread.p90
           : part == "_min" ? spread.min
           : part == "_max" ? spread.max
                            : spread.median;
}

Json cellJson(const io::Cell& cell) {
    if (const auto* const whole = std::get_if<std::uint64_t>(&cell)) {
        return *whole;
    }
    if (const auto* const real = std::get_if<double>(&cell)) {
        return *real;
    }
    const auto* const text = std::get_if<std::string>(&cell);
    return text == nullptr ? Json() : Json(*text);
}

/// The machine's, then those of the measurement.
std::vector<std::string> allNotes(const Output& output) {
    std::vector<std::string> notes = output.machine.notes;
    notes.insert(notes.end(), output.notes.begin(), output.notes.end());
    return notes;
}

} // namespace

Json spreadJson(const std::vector<double>& samples) {
    if (samples.empty()) {
        return nullptr;
    }
    const Spread spread = spreadOf(samples);
    return {{"median", rounded(spread.median)}, {"min", rounded(spread.min)}, {"max", rounded(spread.max)},
            {"p10", rounded(spread.p10)},       {"p90", rounded(spread.p90)}, {"samples", arrayOf(samples, rounded)}};
}

Row& Row::addCell(const Names& names, io::Cell cell) {
    if (!names.member.empty()) {
        json_[names.member] = cellJson(cell);
    }
    if (!names.column.empty()) {
        cells_.emplace_back(names.column, std::move(cell));
    }
    return *this;
}

Row& Row::add(const Names& names, const std::vector<double>& samples, std::initializer_list<const char*> parts) {
    for (const char* const part : parts) {
        cells_.emplace_back(names.column + part,
                            samples.empty() ? io::Cell() : io::Cell(rounded(partOf(spreadOf(samples), part))));
    }
    return names.member.empty() ? *this : member(names.member.c_str(), spreadJson(samples));
}

Row& Row::columns(const Row& others) {
    cells_.insert(cells_.end(), others.cells_.begin(), others.cells_.end());
    return *this;
}

Row& Row::member(const char* name, Json value) {
    json_[name] = std::move(value);
    return *this;
}

io::Table tableOf(std::vector<io::NamedCells> rows, const io::NamedCells& none) {
    io::Table table;
    for (const auto& [name, cell] : rows.empty() ? none : rows.front()) {
        table.columns.push_back(name);
    }
    table.rows = rows.size();
    table.cell = [rows = std::move(rows)](std::size_t row, std::size_t column) { return rows[row][column].second; };
    return table;
}

io::Table tableWithout(std::span<const char* const> columns, std::vector<io::NamedCells> rows) {
    for (io::NamedCells& row : rows) {
        std::erase_if(row, [&](const auto& cell) { return std::ranges::find(columns, cell.first) != columns.end(); });
    }
    return tableOf(std::move(rows));
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

Json jsonOf(const Output& output) {
    const Provenance& provenance = output.machine.provenance;
    Json json{{"voxtact", provenance.version},
              {"git_revision", provenance.gitRevision},
              {"command", provenance.command},
              {"machine", machineJson(output.machine)}};
    json.update(output.members);
    json["notes"] = allNotes(output);
    return json;
}

void writeFindings(std::ostream& out, const Output& output) {
    const Machine& machine = output.machine;
    for (const std::string& sentence : output.sentences) {
        out << "# " << sentence << '\n';
    }
    if (!machine.device.empty()) {
        out << "# device " << machine.device << ", driver " << machine.driver << " " << machine.driverVersion << ", ";
    } else {
        out << "# no device, ";
    }
    out << "cpu " << machine.cpu << ", " << machine.cpuThreads << " threads\n";
    if (!machine.filter.empty()) {
        out << "# " << machine.filter << '\n';
    }
    for (const std::string& note : allNotes(output)) {
        out << "# " << note << '\n';
    }
}

void writeOutput(std::ostream& out, io::Format format, const Output& output) {
    if (format == io::Format::Json) {
        out << jsonOf(output).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
        return;
    }
    io::writeTable(out, format, output.table);
    if (!output.about.empty()) {
        out << "# " << output.about << '\n';
    }
    writeFindings(out, output);
}

} // namespace voxtact::lab
