// SPDX-License-Identifier: MIT
#include "view/model/report.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace voxtact::view {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: it is a word there.
Json millimetres(double value) {
    return std::isinf(value) ? Json("inf") : Json(value);
}

/// Null where it is of another question than the answer.
Json clearanceJson(const LiveClearance* live, std::uint64_t revision) {
    if (live == nullptr || live->revision != revision) {
        return nullptr;
    }
    const PairClearance& pair = live->pair;
    Json json{{"lo", millimetres(pair.bounds.lo)}, {"hi", millimetres(pair.bounds.hi)}, {"end", toString(pair.end)}};
    if (pair.closest) {
        json["triangle"] = pair.closest->triangle;
        json["mesh"] = pair.closest->mesh;
        json["volume"] = pair.closest->volume;
    }
    return json;
}

/// What only an answer has.
void addAnswer(Json& json, const StateReport& report) {
    const LiveAnswer& answer = *report.answer;
    json["hit"] = hitNumber(answer.pair);
    json["count"] = answer.pair.count;
    json["exact"] = answer.pair.exactness == Exactness::Exact ? 1 : 0;
    json["method"] = toString(answer.pair.method);
    json["projection"] = toString(answer.pair.projection);
    json["pose"] = Json::array();
    for (std::size_t i = 0; i < answer.world_from_object.size(); ++i) {
        json["pose"].push_back(answer.world_from_object[4 * (i % 4) + i / 4]);
    }
    json["triangles"] = answer.triangles.size();
    json["contacts"] = answer.contactsFound;
    json["clearance"] = clearanceJson(report.clearance, answer.revision);
    if (report.labels != nullptr) {
        json["labels"] = Json::array();
        for (const LabelCount& touched : answer.labels) {
            json["labels"].push_back(
                {{"label", touched.label}, {"name", nameOf(*report.labels, touched.label)}, {"count", touched.count}});
        }
    }
    json["device"] = report.device;
    json["milliseconds"] = answer.milliseconds;
    json["p50_ms"] = report.times->percentile(0.5);
    json["p99_ms"] = report.times->percentile(0.99);
    json["answers"] = answer.revision;
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
    json["hit"] = nullptr;
    if (report.answer != nullptr) {
        addAnswer(json, report);
    }
    json["holes"] = report.document->edit.holes;
    json["coarser"] = report.document->sources.coarser;
    json["threshold"] = report.document->edit.threshold;
    json["points"] = Json::array();
    for (const ControlPoint& point : report.document->edit.curve) {
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
    json["loading"] = loadingJson(report.loading);
    json["loaded"] = loadingJson(report.loaded);
    json["saving"] = report.saving ? Json(*report.saving) : Json();
    json["status"] = report.status;
    json["command"] = report.command;
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace voxtact::view
