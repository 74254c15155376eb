// SPDX-License-Identifier: MIT
#include "viewer/reporter.h"

#include "viewer/model/answers/command_text.h"
#include "viewer/model/answers/report.h"
#include "voxtact/io.h"

#include <ostream>

namespace voxtact::view {

Reporter::Seen Reporter::look(const State& state) {
    Seen seen;
    seen.revision = state.answer ? state.answer->revision : 0;
    seen.measured = state.distances ? state.distances->revision : 0;
    seen.areas = state.distances && state.distances->hasAreas();
    seen.chosen = state.document.edit.chosen;
    seen.settled = state.settled();
    seen.error = state.error;
    seen.question = state.question ? state.question->title : "";
    seen.field = state.field;
    seen.step = state.loading ? state.loading->step : "";
    seen.loaded = state.loaded.has_value();
    seen.chartFrom = state.chartRange().lo;
    seen.chartTo = state.chartRange().hi;
    seen.saving = state.saving.has_value();
    seen.comparing = state.comparing;
    seen.comparison = state.comparison.serial();
    seen.compared = state.comparison.answered();
    seen.notes = state.notes;
    seen.offers = state.offers.size();
    seen.status = state.status;
    return seen;
}

Result<void> Reporter::write(const State& state) {
    Seen seen = look(state);
    if (path_.empty() || seen == seen_) {
        return {};
    }
    seen_ = std::move(seen);
    StateReport report;
    report.answer = state.answer ? &*state.answer : nullptr;
    report.times = &state.times;
    report.document = &state.document;
    report.measures = state.distances ? &*state.distances : nullptr;
    report.labels = state.labelsOrNull();
    report.device = state.answeredBy;
    if (state.answer) {
        for (const Instrument& instrument : state.document.edit.instruments) {
            report.commands.push_back(commandFor(state.document, instrument, state.method, state.deviceOption));
        }
    }
    const Pane& pane = state.picture;
    report.picture = {pane.corner[0], pane.corner[1], pane.size[0], pane.size[1]};
    report.chart = {state.chart.corner[0], state.chart.corner[1], state.chart.size[0], state.chart.size[1]};
    report.chartRange = state.chartRange();
    report.direction = state.camera.direction;
    report.cube = state.cube;
    report.error = state.error;
    report.question = state.question ? &*state.question : nullptr;
    report.field = state.field;
    report.loading = state.loading ? &*state.loading : nullptr;
    report.loaded = state.loaded ? &*state.loaded : nullptr;
    report.saving = state.saving ? std::optional(state.saving->share) : std::nullopt;
    report.comparison = state.comparing ? &state.comparison : nullptr;
    report.notes = state.notes;
    for (const Offer& offer : state.offers) {
        report.notes.push_back(offer.text);
    }
    report.status = state.status;
    report.frame = state.frame;
    report.frameTimes = &state.frameTimes;
    report.settled = seen_.settled;
    return io::writeFile(path_, [&](std::ostream& out) -> Result<void> {
        out << reportText(report);
        return {};
    });
}

} // namespace voxtact::view
