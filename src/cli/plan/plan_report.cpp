// SPDX-License-Identifier: MIT
#include "cli/plan/plan_colours.h"
#include "cli/plan/plan_run.h"
#include "cli/version.h"
#include "core/base/escaped.h"
#include "core/base/text.h"
#include "core/base/text_stream.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <numeric>
#include <ostream>

namespace voxtact::app {

namespace {

constexpr std::size_t kRanked = 25;
/// Maximum dots of a map: more would hide each other.
constexpr std::size_t kMaxDots = 8000;
constexpr double kDisc = 240; ///< pixels, the radius of a half of the map

using Rounding = double (*)(double);

/// `round`: std::floor and std::ceil keep a bound a bound.
std::string fixed(double value, int digits, Rounding round = std::round) {
    const double scale = std::pow(10.0, digits);
    TextStream out;
    out << std::fixed << std::setprecision(digits) << round(value * scale) / scale + 0.0; // 0, not -0
    return out.str();
}

std::string colourText(const Rgb& colour) {
    TextStream out;
    out << "#" << std::hex << std::setfill('0');
    for (const std::uint8_t component : colour) {
        out << std::setw(2) << static_cast<unsigned>(component);
    }
    return out.str();
}

/// Draws one hemisphere of directions, seen along z from outside; the radius grows with the angle to z.
void writeHalf(std::ostream& out, const TargetPlan& plan, double maximum, bool upper) {
    const PlanAnswer& answer = plan.answer;
    const std::size_t step = answer.paths.size() / kMaxDots + 1;
    const Vec3& target = plan.target.at;
    const double size = std::max(
        2.0, 0.9 * kDisc * std::sqrt(8.0 / static_cast<double>(std::min(answer.directions / step, kMaxDots) + 1)));
    const double middle = kDisc + 10;
    out << "<figure><svg width=\"" << 2 * middle << "\" height=\"" << 2 * middle << "\"><circle cx=\"" << middle
        << "\" cy=\"" << middle << "\" r=\"" << kDisc << "\" fill=\"#f4f4f4\" stroke=\"#999\"/>\n";
    for (std::size_t i = 0; i < answer.paths.size(); i += step) {
        const PlannedPath& path = answer.paths[i];
        const double x = path.position[0] - target[0];
        const double y = path.position[1] - target[1];
        const double z = (upper ? 1 : -1) * (path.position[2] - target[2]);
        const double flat = std::hypot(x, y);
        if (z < 0) {
            continue;
        }
        const double far = flat > 0 ? kDisc * std::atan2(flat, z) / (std::acos(0.0) * flat) : 0;
        out << "<circle cx=\"" << fixed(middle + (upper ? 1 : -1) * far * x, 1) << "\" cy=\""
            << fixed(middle + far * y, 1) << "\" r=\"" << fixed(size / 2, 1) << "\" fill=\""
            << colourText(planColour(path, maximum)) << "\"><title>" << path.entry << ": "
            << fixed(path.clearance.lower, 2, std::floor) << " mm</title></circle>\n";
    }
    out << "</svg><figcaption>"
        << (upper ? "entries above the target, seen from above" : "entries below the target, seen from below")
        << "</figcaption></figure>\n";
}

Rounding roundingOf(const std::string& column) {
    return column == "lower" ? Rounding{std::floor} : column == "upper" ? Rounding{std::ceil} : Rounding{std::round};
}

void writeCell(std::ostream& out, const io::Cell& cell, Rounding round) {
    if (const auto* text = std::get_if<std::string>(&cell)) {
        out << inHtml(*text);
    } else if (const auto* real = std::get_if<double>(&cell)) {
        out << (std::isfinite(*real) ? fixed(*real, 2, round) : number(*real));
    } else if (const auto* whole = std::get_if<std::uint64_t>(&cell)) {
        out << *whole;
    } else if (const auto* word = std::get_if<io::NumberWord>(&cell)) {
        out << word->word;
    }
}

void writeRows(std::ostream& out, const io::Table& table, std::span<const std::size_t> rows) {
    out << "<table><tr>";
    for (const std::string& column : table.columns) {
        out << "<th>" << column << "</th>";
    }
    out << "</tr>\n";
    for (const std::size_t row : rows) {
        out << "<tr>";
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            out << "<td>";
            writeCell(out, table.cell(row, column), roundingOf(table.columns[column]));
            out << "</td>";
        }
        out << "</tr>\n";
    }
    out << "</table>\n";
}

/// For one target or all.
void writeRanking(std::ostream& out, const PlanInputs& inputs, std::span<const TargetPlan> plans) {
    std::vector<std::size_t> rows;
    for (const ChosenPath& best : rankedPaths(plans, kRanked)) {
        auto row = static_cast<std::size_t>(best.path - best.plan->answer.paths.data());
        for (const TargetPlan* plan = plans.data(); plan != best.plan; ++plan) {
            row += plan->answer.paths.size();
        }
        rows.push_back(row);
    }
    writeRows(out, planTable(inputs, plans, false), rows);
}

void writeList(std::ostream& out, const std::vector<std::string>& notes) {
    out << "<ul>\n";
    for (const std::string& note : notes) {
        out << "<li>" << inHtml(note) << "</li>\n";
    }
    out << "</ul>\n";
}

std::string placeText(const PlanTarget& target) {
    return "(" + fixed(target.at[0], 2) + ", " + fixed(target.at[1], 2) + ", " + fixed(target.at[2], 2) + ")";
}

void writeMaps(std::ostream& out, const TargetPlan& plan, double maximum) {
    writeHalf(out, plan, maximum, true);
    writeHalf(out, plan, maximum, false);
}

void writeKey(std::ostream& out, double maximum) {
    out << "<p>Red: unsafe. Grey: undecided. Safe by distance: ";
    constexpr int kSteps = 5;
    for (int i = 0; i <= kSteps; ++i) {
        const double share = static_cast<double>(i) / kSteps;
        out << "<span style=\"border-left:1em solid " << colourText(viridis(share)) << ";padding:0 1em 0 .3em\">"
            << number(std::round(100 * share * maximum) / 100) << (i == kSteps ? " mm and more" : " mm") << "</span>";
    }
    out << "</p>\n";
}

/// RFC 4648, for data URLs in the page.
std::string base64(std::string_view bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    constexpr unsigned kBits = 6;
    constexpr std::uint32_t kMask = 63;
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            out += k > bytes.size() - i ? '=' : kDigits[group >> (kBits * (3 - k)) & kMask];
        }
    }
    return out;
}

/// Writes all targets together, then each target.
void writeTargets(std::ostream& out, const PlanInputs& inputs, std::span<const TargetPlan> plans, double maximum) {
    const io::Table table = targetTable(inputs, plans);
    std::vector<std::size_t> rows(plans.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    out << "<h2>Targets</h2>\n";
    writeRows(out, table, rows);
    out << "<h2>Safest paths of all targets</h2>\n";
    writeRanking(out, inputs, plans);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const std::span<const TargetPlan> one = plans.subspan(i, 1);
        out << "<h2 id=\"target-" << i + 1 << "\">Target " << inHtml(one[0].target.name) << ", "
            << placeText(one[0].target) << "</h2>\n";
        writeList(out, planNotes(inputs, one));
        writeMaps(out, one[0], maximum);
        writeKey(out, maximum);
        writeRanking(out, inputs, one);
    }
}

} // namespace

void writePlanReport(std::ostream& out, const PlanInputs& inputs, std::span<const TargetPlan> plans, double maximum,
                     std::string_view png) {
    const bool several = plans.size() > 1;
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Paths to "
        << (several ? "targets" : "a target")
        << "</title>\n<style>"
           "body{font:15px/1.4 sans-serif;margin:2em;max-width:80em}table{border-collapse:collapse;font-size:13px}"
           "td,th{border:1px solid #ccc;padding:2px 6px;text-align:right}figure{display:inline-block;margin:0 1em 1em "
           "0}"
           "figcaption{text-align:center}</style></head><body>\n<h1>Paths to "
        << (several ? std::to_string(plans.size()) + " targets" : placeText(plans.front().target))
        << "</h1>\n<p>World millimetres, LPS. A safe path provably keeps more than " << number(inputs.task.margin)
        << " mm.</p>\n";
    std::vector<std::string> notes = inputs.notes;
    std::ranges::move(planNotes(inputs, plans), std::back_inserter(notes));
    writeList(out, notes);
    if (!png.empty()) {
        out << "<p><img alt=\"the best path, from outside and cut open\" style=\"max-width:100%\" "
               "src=\"data:image/png;base64,"
            << base64(png) << "\"></p>\n";
    }
    if (several) {
        writeTargets(out, inputs, plans, maximum);
    } else {
        out << "<h2>Entries</h2>\n";
        writeMaps(out, plans.front(), maximum);
        writeKey(out, maximum);
        out << "<h2>Safest paths</h2>\n";
        writeRanking(out, inputs, plans);
    }
    out << "<p>voxtact " << inHtml(programVersion()) << "</p>\n</body></html>\n";
}

} // namespace voxtact::app
