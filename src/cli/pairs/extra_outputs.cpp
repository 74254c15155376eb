// SPDX-License-Identifier: MIT
#include "cli/pairs/extra_outputs.h"

#include "cli/options/label_words.h"
#include "cli/options/shared_options.h"
#include "cli/pairs/pair_output.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::app {

struct ExtraAnswers {
    std::uint64_t triangles = 0; ///< touched ones
    std::uint64_t contacts = 0;  ///< found, kept or not
    std::uint64_t seen = 0;      ///< contacts whose depth is known
    double depth = 0;            ///< of the deepest of these, mm
    std::optional<Box> bounds;
    std::vector<LabelCount> labels;
};

namespace {

ExtraAnswers& keptOf(Row& row) {
    if (!row.extra) {
        row.extra = std::make_shared<ExtraAnswers>();
    }
    return *row.extra;
}

/// A column of rows with additional answers.
struct AnswerColumn {
    std::string name;
    std::function<io::Cell(const ExtraAnswers&)> cell;
};

io::Cell depthOf(const ExtraAnswers& row) {
    return row.contacts > 0 && row.seen == row.contacts ? io::Cell(rounded(row.depth, 1e6)) : io::Cell();
}

/// Returns the touched labels, without the background unless it is the only one.
std::vector<io::NamedCount> labelsOf(const std::map<std::int32_t, std::string>& names, const ExtraAnswers& row) {
    const bool onlyBackground =
        std::all_of(row.labels.begin(), row.labels.end(), [](const LabelCount& entry) { return entry.label == 0; });
    std::vector<io::NamedCount> counts;
    for (const LabelCount& entry : row.labels) {
        if (entry.label != 0 || onlyBackground) {
            counts.push_back({entry.label, labelName(names, entry.label), entry.count});
        }
    }
    std::stable_sort(counts.begin(), counts.end(),
                     [](const io::NamedCount& a, const io::NamedCount& b) { return a.count > b.count; });
    return counts;
}

AnswerColumn boundColumn(bool upper, std::size_t axis) {
    return {std::string(upper ? "max_" : "min_") + "xyz"[axis], [upper, axis](const ExtraAnswers& row) {
                return row.bounds ? io::Cell(rounded((upper ? row.bounds->hi : row.bounds->lo)[axis], 1e6))
                                  : io::Cell();
            }};
}

void keepContacts(const BatchAnswer& answer, std::span<const std::uint32_t> batch, std::span<Row> rows,
                  PairOutput& output) {
    for (const Contact& contact : answer.contacts) {
        Row& row = rows[batch[contact.pair]];
        ExtraAnswers& kept = keptOf(row);
        ++kept.contacts;
        ++kept.seen;
        kept.depth = std::max(kept.depth, contact.depth);
        static_cast<void>(output.keepContact(row, contact));
    }
    output.countContacts(answer.contactsFound);
    // Each passing fragment is a contact: the pair's count is also right for a truncated list.
    if (answer.contactsFound > answer.contacts.size()) {
        for (const std::uint32_t number : batch) {
            Row& row = rows[number];
            ExtraAnswers& kept = keptOf(row);
            kept.contacts = std::max(kept.contacts, row.timed.answer.count);
        }
    }
}

std::vector<AnswerColumn> columnsOf(const Outputs& outputs, const std::map<std::int32_t, std::string>& names) {
    std::vector<AnswerColumn> columns;
    if (outputs.triangles) {
        columns.push_back({"triangles", [](const ExtraAnswers& row) { return row.triangles; }});
    }
    if (outputs.contacts) {
        columns.push_back({"contacts", [](const ExtraAnswers& row) { return row.contacts; }});
        columns.push_back({"depth", depthOf});
    }
    if (outputs.labels) {
        columns.push_back({"labels", [&names](const ExtraAnswers& row) { return labelsOf(names, row); }});
    }
    if (outputs.bounds) {
        for (const bool upper : {false, true}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                columns.push_back(boundColumn(upper, axis));
            }
        }
    }
    return columns;
}

} // namespace

Outputs ExtraOptions::outputs() const {
    Outputs outputs = asked;
    outputs.contacts = !contacts.empty();
    outputs.triangles = !triangles.empty();
    outputs.maxDepth = maxDepth.value_or(kDefaultMaxDepth);
    return outputs;
}

void addExtraOptions(CLI::App& parser, ExtraOptions& options) {
    addPath(parser, "--contacts", options.contacts, "file of contacts: .csv, .ply, .vtp, .mrk.json");
    addPath(parser, "--triangles", options.triangles, "CSV file of touched triangles");
    parser.add_flag("--bounds", options.asked.bounds, "add the world bounding box of the passing fragments");
    parser.add_flag("--label-counts", options.asked.labels, "add the number of passing fragments per label");
    addFact(parser, factOf("count", "max_depth"), [&options](double depth) { options.maxDepth = depth; });
    addWholeNumber(
        parser, "--max-contacts", [&options](std::uint32_t max) { options.maxContacts = max; }, {.least = 1},
        "contacts: keep at most N; warn if truncated", kDefaultMaxContacts);
    setRare(parser, "--max-depth");
    setRare(parser, "--max-contacts");
}

void keepExtra(const BatchAnswer& answer, std::span<const std::uint32_t> batch, std::span<Row> rows,
               PairOutput& output) {
    for (const TouchedTriangle& touched : answer.triangles) {
        Row& row = rows[batch[touched.pair]];
        ++keptOf(row).triangles;
        output.addTriangle(row, touched);
    }
    keepContacts(answer, batch, rows, output);
    for (std::size_t pair = 0; pair < answer.bounds.size(); ++pair) {
        if (answer.bounds[pair]) {
            keptOf(rows[batch[pair]]).bounds = answer.bounds[pair];
        }
    }
    for (const LabelCount& label : answer.labels) {
        keptOf(rows[batch[label.pair]]).labels.push_back(label);
    }
}

std::optional<Box> boundsOf(const KeptExtra& kept) {
    return kept ? kept->bounds : std::nullopt;
}

std::vector<ExtraColumn> extraColumns(const Outputs& outputs, const std::map<std::int32_t, std::string>& names) {
    std::vector<ExtraColumn> columns;
    for (AnswerColumn& column : columnsOf(outputs, names)) {
        columns.push_back({column.name, [cell = std::move(column.cell)](const KeptExtra& kept) {
                               static const ExtraAnswers kNothing;
                               return cell(kept ? *kept : kNothing);
                           }});
    }
    return columns;
}

double rounded(double value, double parts) {
    return std::round(value * parts) / parts;
}

} // namespace voxtact::app
