// SPDX-License-Identifier: MIT
#include "lab/measure/columns.h"

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

Json jsonOf(const io::Cell& cell) {
    if (const auto* const whole = std::get_if<std::uint64_t>(&cell)) {
        return *whole;
    }
    if (const auto* const real = std::get_if<double>(&cell)) {
        return *real;
    }
    const auto* const text = std::get_if<std::string>(&cell);
    return text == nullptr ? Json() : Json(*text);
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
        json_[names.member] = jsonOf(cell);
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

Json headJson(const Machine& machine) {
    return {{"voxtact", machine.provenance.version},
            {"git_revision", machine.provenance.gitRevision},
            {"command", machine.provenance.command},
            {"machine", machineJson(machine)}};
}

std::vector<std::string> allNotes(const Findings& findings) {
    std::vector<std::string> notes = findings.machine.notes;
    notes.insert(notes.end(), findings.notes.begin(), findings.notes.end());
    return notes;
}

void writeJson(std::ostream& out, const Json& json) {
    out << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void writeFindings(std::ostream& out, const Findings& findings) {
    for (const std::string& sentence : findings.sentences) {
        out << "# " << sentence << '\n';
    }
    const Machine& machine = findings.machine;
    if (!machine.device.empty()) {
        out << "# device " << machine.device << ", driver " << machine.driver << " " << machine.driverVersion << ", ";
    } else {
        out << "# no device, ";
    }
    out << "cpu " << machine.cpu << ", " << machine.cpuThreads << " threads\n";
    if (!machine.filter.empty()) {
        out << "# " << machine.filter << '\n';
    }
    for (const std::string& note : allNotes(findings)) {
        out << "# " << note << '\n';
    }
}

} // namespace voxtact::lab
