// SPDX-License-Identifier: MIT
#include "viewer/model/answers/report.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace voxtact::view {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity, so it is a string.
Json orInfinite(double value) {
    return std::isinf(value) ? Json("inf") : Json(value);
}

/// Returns null if it belongs to another question or mesh.
const MeshMeasures* measuredOf(const StateReport& report, std::size_t mesh) {
    const LiveMeasures* live = report.measures;
    return live != nullptr && live->revision == report.answer->revision ? live->of(mesh) : nullptr;
}

/// Area or overlap; null until it is measured.
template <class Measure> Json measureJson(const std::optional<Measure>& measure) {
    if (!measure) {
        return nullptr;
    }
    const Bounds& bounds = measure->bounds;
    return {{"lo", bounds.lower}, {"hi", orInfinite(bounds.upper)}, {"end", toString(measure->end)}};
}

/// Null until it is measured.
Json distanceJson(const StateReport& report, std::size_t mesh) {
    const MeshMeasures* measured = measuredOf(report, mesh);
    if (measured == nullptr) {
        return nullptr;
    }
    const PairDistance* pair = &measured->pair;
    Json json{
        {"lo", orInfinite(pair->bounds.lower)}, {"hi", orInfinite(pair->bounds.upper)}, {"end", toString(pair->end)}};
    if (pair->closest) {
        json["triangle"] = pair->closest->triangle;
        json["mesh"] = pair->closest->mesh;
        json["volume"] = pair->closest->volume;
    }
    return json;
}

Json labelsJson(const Labels& labels, const MeshAnswer& answer) {
    Json json = Json::array();
    for (const LabelCount& touched : answer.labels) {
        json.push_back({{"label", touched.label}, {"name", nameOf(labels, touched.label)}, {"count", touched.count}});
    }
    return json;
}

/// Adds one mesh.
void addMesh(Json& json, const StateReport& report, const MeshAnswer& answer) {
    json["touch"] = hitNumber(answer.pair);
    json["count"] = answer.pair.count;
    json["exact"] = answer.pair.exactness == Exactness::Exact ? 1 : 0;
    json["method"] = toString(answer.pair.method);
    json["projection"] = toString(answer.pair.projection);
    const Mat4& pose = answer.instrument.world_from_object;
    json["pose"] = Json::array();
    for (std::size_t i = 0; i < pose.size(); ++i) {
        json["pose"].push_back(pose[4 * (i % 4) + i / 4]);
    }
    json["triangles"] = answer.triangles.size();
    json["contacts"] = answer.contactsFound;
    json["distance"] = distanceJson(report, answer.instrument.mesh);
    const MeshMeasures* measured = measuredOf(report, answer.instrument.mesh);
    json["area"] = measured == nullptr ? Json() : measureJson(measured->area);
    json["overlap"] = measured == nullptr ? Json() : measureJson(measured->overlap);
    if (report.labels != nullptr) {
        json["labels"] = labelsJson(*report.labels, answer);
    }
}

/// Writes all instruments in their current state, and the members of an answer, if any.
Json meshesJson(const StateReport& report) {
    Json out = Json::array();
    const Document& document = *report.document;
    for (std::size_t i = 0; i < document.edit.instruments.size(); ++i) {
        const Instrument& instrument = document.edit.instruments[i];
        if (instrument.mesh >= document.sources.meshes.size()) {
            continue; // empty document
        }
        Json json{
            {"mesh", document.sources.meshes[instrument.mesh].path}, {"shown", instrument.shown}, {"touch", nullptr}};
        const MeshAnswer* answer = report.answer == nullptr ? nullptr : report.answer->of(instrument.mesh);
        if (answer != nullptr) {
            addMesh(json, report, *answer);
        }
        json["command"] = i < report.commands.size() ? report.commands[i] : "";
        out.push_back(std::move(json));
    }
    return out;
}

/// Adds the members that only an answer has.
void addAnswer(Json& json, const StateReport& report, const MeshAnswer& chosen) {
    addMesh(json, report, chosen);
    const LiveAnswer& answer = *report.answer;
    json["device"] = report.device;
    json["milliseconds"] = answer.milliseconds;
    json["p50_ms"] = report.times->percentile(0.5);
    json["p99_ms"] = report.times->percentile(0.99);
    json["answers"] = answer.revision;
}

/// Answers of all methods for the chosen mesh. Null if hidden, empty until they match the question.
Json comparisonJson(const StateReport& report) {
    if (report.comparison == nullptr) {
        return nullptr;
    }
    Json out = Json::array();
    const Edit& edit = report.document->edit;
    if (!report.comparison->isOf(edit)) {
        return out;
    }
    for (const ComparedMethod& compared : report.comparison->methods()) {
        Json json{{"method", toString(compared.method.count)},
                  {"projection", toString(compared.method.projection)},
                  {"filter", toString(defaultFilter(compared.method.count))},
                  {"refused", compared.refused},
                  {"touch", nullptr}};
        if (const MeshAnswer* answer = compared.answer ? compared.answer->of(edit.instrument().mesh) : nullptr) {
            json["touch"] = hitNumber(answer->pair);
            json["count"] = answer->pair.count;
            json["exact"] = answer->pair.exactness == Exactness::Exact ? 1 : 0;
            json["triangles"] = answer->triangles.size();
            json["milliseconds"] = compared.answer->milliseconds;
        }
        out.push_back(std::move(json));
    }
    return out;
}

Json loadingJson(const Loading* loading) {
    if (loading == nullptr) {
        return nullptr;
    }
    Json json{{"seconds", loading->seconds}, {"frames", loading->frames}, {"longest_frame_ms", loading->longestFrame}};
    if (!loading->step.empty()) {
        json["step"] = loading->step;
    }
    return json;
}

Json questionJson(const Question* question) {
    if (question == nullptr) {
        return nullptr;
    }
    Json json{{"title", question->title}, {"text", question->text}, {"buttons", question->buttons}};
    json["files"] = Json::array();
    for (const MissingFile& file : question->files) {
        json["files"].push_back({{"name", file.name}, {"path", file.path}});
    }
    return json;
}

} // namespace

std::string reportText(const StateReport& report) {
    Json json;
    json["touch"] = nullptr;
    const Edit& edit = report.document->edit;
    if (const MeshAnswer* chosen = report.answer == nullptr ? nullptr : report.answer->of(edit.instrument().mesh)) {
        addAnswer(json, report, *chosen);
    }
    json["chosen"] = edit.chosen;
    json["meshes"] = meshesJson(report);
    json["methods"] = comparisonJson(report);
    json["holes"] = edit.holes;
    json["coarser"] = report.document->sources.coarser;
    json["threshold"] = edit.threshold;
    json["points"] = Json::array();
    for (const ControlPoint& point : edit.curve) {
        json["points"].push_back({point.value, point.opacity});
    }
    json["frame"] = report.frame;
    json["frame_ms"] = report.frameTimes->percentile(0.5);
    json["frame_times"] = Json::array();
    for (const double milliseconds : report.frameTimes->last()) {
        json["frame_times"].push_back(std::round(10 * milliseconds) / 10);
    }
    json["picture"] = report.picture;
    json["azimuth"] = report.direction.azimuth;
    json["elevation"] = report.direction.elevation;
    json["cube"] = report.cube ? Json{report.cube->middle[0], report.cube->middle[1], report.cube->half} : Json();
    json["chart"] = report.chart;
    json["chart_range"] = {report.chartRange.lo, report.chartRange.hi};
    json["settled"] = report.settled;
    json["error"] = report.error;
    json["question"] = questionJson(report.question);
    json["field"] = report.field ? Json(*report.field) : Json();
    json["loading"] = loadingJson(report.loading);
    json["loaded"] = loadingJson(report.loaded);
    json["saving"] = report.saving ? Json(*report.saving) : Json();
    json["notes"] = report.notes;
    json["status"] = report.status;
    json["command"] = edit.chosen < report.commands.size() ? report.commands[edit.chosen] : "";
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace voxtact::view
