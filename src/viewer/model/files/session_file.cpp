// SPDX-License-Identifier: MIT
#include "viewer/model/files/session_file.h"

#include "core/base/try.h"
#include "io/text/small_file.h"
#include "io/text/twice_said.h"
#include "viewer/model/files/session_reader.h"
#include "viewer/model/files/session_shown.h"
#include "viewer/model/files/source_paths.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxtact::view {

namespace {

using Json = SessionReader::Json;

constexpr int kVersion = 1;
constexpr const char* kMark = "voxtact_session";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20U;
/// mm: maximum distance of a camera with usable matrices.
constexpr double kFarthest = 1e12;
/// Maximum distance relative to the camera's height.
constexpr double kFarthestInHeights = 1e8;
/// For larger angles, doubles have no meaningful fractions of a degree.
constexpr double kMostDegrees = 1e9;

/// Row by row, like pose files.
Mat4 readPose(SessionReader& reader, const std::string& name, const Json& json) {
    const std::array<double, 16> rows = reader.numbers<16>(name, json);
    Mat4 pose{};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        pose[4 * (i % 4) + i / 4] = rows[i];
    }
    if (reader.wrong().empty()) {
        if (const Result<void> affine = checkAffine(pose, name); !affine.ok()) {
            reader.refuse(affine.error().text);
        }
    }
    return pose;
}

Json poseJson(const Mat4& pose) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < pose.size(); ++i) {
        rows.push_back(pose[4 * (i % 4) + i / 4]);
    }
    return rows;
}

void readSources(SessionReader& reader, Sources& sources) {
    sources.volume = reader.text("volume", "");
    const double coarser = reader.number("volume_coarser", 1.0);
    constexpr double kMostCoarser = 1024;
    if (!(coarser >= 1 && coarser <= kMostCoarser && coarser == std::floor(coarser))) {
        reader.refuse("volume_coarser", "is not a whole number from 1 to 1024");
        return;
    }
    sources.coarser = static_cast<std::uint32_t>(coarser);
    sources.labels = reader.text("labels", "");
    sources.labelNames = reader.text("label_names", "");
    if (sources.labels.empty() && !sources.labelNames.empty()) {
        reader.refuse("label_names", "needs a label map, but labels is missing");
    }
    if (sources.volume.empty()) {
        reader.refuse("volume", "is missing");
    }
}

/// Reads an object with the members mesh, mesh_space and mesh_scale; `at`: its name with a dot, or empty.
MeshSource readMesh(SessionReader& reader, const std::string& at) {
    MeshSource mesh;
    mesh.path = reader.text(at + "mesh", "");
    mesh.space = reader.text(at + "mesh_space", "lps");
    mesh.scale = reader.number(at + "mesh_scale", 1.0);
    if (mesh.path.empty()) {
        reader.refuse(at + "mesh", "is missing");
    }
    if (mesh.space != "lps" && mesh.space != "ras") {
        reader.refuse(at + "mesh_space", "is neither lps nor ras");
    }
    if (!(mesh.scale > 0) || !std::isfinite(mesh.scale)) {
        reader.refuse(at + "mesh_scale", "is not a positive number");
    }
    return mesh;
}

void writeMesh(Json& json, const MeshSource& mesh) {
    json["mesh"] = mesh.path;
    json["mesh_space"] = mesh.space;
    json["mesh_scale"] = mesh.scale;
}

void readFunction(SessionReader& reader, Document& document) {
    const std::string name = "transfer_function";
    reader.each(name + ".points", [&](const std::string& at, const Json& json) {
        const auto [value, opacity] = reader.numbers<2>(at, json);
        document.edit.curve.push_back({value, opacity});
    });
    reader.each(name + ".colours", [&](const std::string& at, const Json& json) {
        const auto [value, red, green, blue] = reader.numbers<4>(at, json);
        document.edit.colours.push_back({value, {red, green, blue}});
        for (const double channel : {red, green, blue}) {
            if (!(channel >= 0 && channel <= 1)) {
                reader.refuse(at, "a colour's channel is not in 0..1");
            }
        }
        const std::size_t count = document.edit.colours.size();
        if (count > 1 && !(document.edit.colours[count - 2].value <= value)) {
            reader.refuse(at, "its value is below the previous one");
        }
    });
    if (const Json* json = reader.find(name + ".domain"); json != nullptr) {
        const auto [lo, hi] = reader.numbers<2>(name + ".domain", *json);
        document.domain = {lo, hi};
    }
    const double size = reader.number(name + ".size", double{kDefaultTableSize});
    constexpr double kMaxEntries = 1024; // a picture's table
    if (!(size >= 2 && size <= kMaxEntries && size == std::floor(size))) {
        reader.refuse(name + ".size", "is not a whole number from 2 to 1024");
        return;
    }
    document.tableSize = static_cast<std::uint32_t>(size);
    document.edit.threshold = reader.number(name + ".threshold", kDefaultThreshold);
    if (!(document.edit.threshold >= 0 && document.edit.threshold <= 1)) {
        reader.refuse(name + ".threshold", "is not in 0..1");
    }
    if (!reader.wrong().empty()) {
        return;
    }
    const auto table = sampleTable({document.edit.curve, document.domain, document.tableSize});
    if (!table.ok()) {
        reader.refuse(name, table.error().text);
    }
}

/// The single mesh of a session, or the chosen one, for programs that read only one.
void readInstrument(SessionReader& reader, Document& document) {
    document.sources.meshes = {readMesh(reader, "")};
    if (const Json* json = reader.find("instrument.pose"); json != nullptr) {
        document.edit.pose() = readPose(reader, "instrument.pose", *json);
    }
    reader.each("instrument.poses",
                [&](const std::string& at, const Json& json) { document.poses.push_back(readPose(reader, at, json)); });
    const double number = reader.number("instrument.pose_number", 0.0);
    const auto poses = static_cast<double>(document.poses.size());
    if (!(number >= 0 && number == std::floor(number) && (number < poses || number == 0))) {
        reader.refuse("instrument.pose_number", "is not an index of instrument.poses");
        return;
    }
    document.pose = static_cast<std::size_t>(number);
}

/// Reads an element of `meshes`, only from its own members.
Instrument readMember(SessionReader& reader, const std::string& at, const Json& json, Document& document) {
    SessionReader member(json);
    Instrument out;
    if (!json.is_object()) {
        reader.refuse(at, "is not an object");
        return out;
    }
    out.mesh = document.sources.meshes.size();
    document.sources.meshes.push_back(readMesh(member, ""));
    if (const Json* pose = member.find("pose"); pose != nullptr) {
        out.world_from_object = readPose(member, "pose", *pose);
    } else {
        member.refuse("pose", "is missing");
    }
    const Json* shown = member.find("shown");
    if (shown != nullptr && !shown->is_boolean()) {
        member.refuse("shown", "is neither true nor false");
    } else {
        out.shown = shown == nullptr || shown->get<bool>();
    }
    if (!member.wrong().empty()) {
        reader.refuse(at, member.wrong());
    }
    return out;
}

/// Several instruments replace the single one.
void readInstruments(SessionReader& reader, Document& document) {
    const Json* meshes = reader.find("meshes");
    if (meshes == nullptr || !reader.wrong().empty()) {
        return;
    }
    document.sources.meshes.clear();
    document.edit.instruments.clear();
    reader.each("meshes", [&](const std::string& at, const Json& json) {
        document.edit.instruments.push_back(readMember(reader, at, json, document));
    });
    if (document.edit.instruments.empty()) {
        reader.refuse("meshes", "is empty");
        return;
    }
    const double chosen = reader.number("chosen", 0.0);
    if (!(chosen >= 0 && chosen == std::floor(chosen) &&
          chosen < static_cast<double>(document.edit.instruments.size()))) {
        reader.refuse("chosen", "is not an index of meshes");
        return;
    }
    document.edit.chosen = static_cast<std::size_t>(chosen);
}

/// Unless there is exactly one visible instrument.
void writeInstruments(Json& json, const Document& document) {
    const Edit& edit = document.edit;
    if (edit.instruments.size() == 1 && edit.instrument().shown) {
        return;
    }
    json["meshes"] = Json::array();
    for (const Instrument& instrument : edit.instruments) {
        Json one;
        writeMesh(one, document.sources.meshes[instrument.mesh]);
        one["pose"] = poseJson(instrument.world_from_object);
        one["shown"] = instrument.shown;
        json["meshes"].push_back(std::move(one));
    }
    json["chosen"] = edit.chosen;
}

void readMethod(SessionReader& reader, Document& document) {
    const std::string count = reader.text("method.count", "auto");
    const std::string projection = reader.text("method.projection", "certified");
    const auto method = countingMethodFromName(count);
    const auto how = projectionFromName(projection);
    if (count != "auto" && !method) {
        reader.refuse("method.count", "is not the name of a counting method");
    } else if (!how) {
        reader.refuse("method.projection", "is not the name of a projection");
    } else if (method) {
        document.method = MethodChoice{*method, *how};
    }
}

void readCamera(SessionReader& reader, Document& document) {
    if (const Json* cursor = reader.find("cursor"); cursor != nullptr) {
        document.cursor = reader.numbers<3>("cursor", *cursor);
    }
    const Json* target = reader.find("camera.target");
    if (target == nullptr) {
        return;
    }
    Camera camera;
    camera.target = reader.numbers<3>("camera.target", *target);
    camera.direction = {reader.number("camera.azimuth", 0.0), reader.number("camera.elevation", 0.0)};
    for (const auto& [name, degrees] : {std::pair("camera.azimuth", camera.direction.azimuth),
                                        std::pair("camera.elevation", camera.direction.elevation)}) {
        if (!(std::abs(degrees) <= kMostDegrees)) {
            reader.refuse(name, "is not from -1e9 to 1e9 degrees");
        }
    }
    camera.halfHeight = reader.number("camera.half_height", camera.halfHeight);
    if (!(camera.halfHeight > 0) || !std::isfinite(camera.halfHeight)) {
        reader.refuse("camera.half_height", "is not a positive number");
    }
    camera.halfHeight = std::clamp(camera.halfHeight, kLeastHalfHeight, kMostHalfHeight);
    for (const double place : camera.target) {
        if (!(std::abs(place) <= kFarthest)) {
            reader.refuse("camera.target", "is beyond 1e12 mm");
        } else if (std::abs(place) > kFarthestInHeights * camera.halfHeight) {
            reader.refuse("camera.target", "is beyond 1e8 times camera.half_height");
        }
    }
    document.camera = camera;
}

} // namespace

Result<Document> parseSession(std::string_view text, const std::string& name) {
    const auto wrong = [&name](const std::string& why) {
        return Error{ErrorCode::Format, 0, "cannot use the session '" + name + "': " + why};
    };
    io::TwiceSaid<Json> twice;
    const Json json = Json::parse(
        text, [&twice](int, Json::parse_event_t event, const Json& parsed) { return twice(event, parsed); }, false);
    if (json.is_discarded()) {
        return wrong("it is not JSON");
    }
    if (twice.found()) {
        return wrong("it has " + Json(*twice.found()).dump(-1, ' ', false, Json::error_handler_t::replace) + " twice");
    }
    SessionReader reader(json);
    const Json* mark = json.is_object() ? reader.find(kMark) : nullptr;
    if (mark == nullptr || !mark->is_number_integer()) {
        return wrong(std::string("it has no number '") + kMark + "', which marks a session");
    }
    if (*mark != kVersion) {
        return wrong(std::string(kMark) + " is not " + std::to_string(kVersion) + ": another version wrote it");
    }
    Document document;
    readSources(reader, document.sources);
    readFunction(reader, document);
    readInstrument(reader, document);
    readInstruments(reader, document);
    readMethod(reader, document);
    readCamera(reader, document);
    readHoles(reader, document);
    readShown(reader, document);
    return reader.wrong().empty() ? Result<Document>(std::move(document)) : wrong(reader.wrong());
}

std::string sessionText(const Document& document) {
    Json json;
    json[kMark] = kVersion;
    json["volume"] = document.sources.volume;
    if (document.sources.coarser != 1) {
        json["volume_coarser"] = document.sources.coarser;
    }
    writeMesh(json, document.sources.meshes[document.edit.instrument().mesh]);
    if (!document.sources.labels.empty()) {
        json["labels"] = document.sources.labels;
    }
    if (!document.sources.labelNames.empty()) {
        json["label_names"] = document.sources.labelNames;
    }
    Json& function = json["transfer_function"];
    function["points"] = Json::array();
    for (const ControlPoint& point : document.edit.curve) {
        function["points"].push_back({point.value, point.opacity});
    }
    function["colours"] = Json::array();
    for (const auto& [value, colour] : document.edit.colours) {
        function["colours"].push_back({value, colour[0], colour[1], colour[2]});
    }
    function["domain"] = {document.domain.lo, document.domain.hi};
    function["size"] = document.tableSize;
    function["threshold"] = document.edit.threshold;
    Json& instrument = json["instrument"];
    instrument["pose"] = poseJson(document.edit.pose());
    instrument["poses"] = Json::array();
    for (const Mat4& pose : document.poses) {
        instrument["poses"].push_back(poseJson(pose));
    }
    instrument["pose_number"] = document.pose;
    writeInstruments(json, document);
    if (document.method) {
        json["method"] = {{"count", toString(document.method->count)},
                          {"projection", toString(document.method->projection)}};
    }
    if (document.cursor) {
        json["cursor"] = *document.cursor;
    }
    if (document.camera) {
        json["camera"] = {{"target", document.camera->target},
                          {"azimuth", document.camera->direction.azimuth},
                          {"elevation", document.camera->direction.elevation},
                          {"half_height", document.camera->halfHeight}};
    }
    writeShown(json, document);
    // A path that is not UTF-8 would otherwise throw.
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

Result<std::string> textOf(const std::filesystem::path& path, const std::string& what) {
    Result<std::string> text = io::readSmallFile(path, kMostBytes);
    if (!text.ok()) {
        return Error{ErrorCode::File, 0, "cannot read " + what + " '" + path.string() + "': " + text.error().text};
    }
    return text;
}

} // namespace

Result<bool> isSession(const std::filesystem::path& path) {
    const Result<std::string> text = textOf(path, "the file");
    VOXTACT_TRY(text);
    const Json json = Json::parse(*text, nullptr, false);
    return json.is_object() && json.contains(kMark);
}

Result<Document> readSession(const std::filesystem::path& path) {
    const Result<std::string> text = textOf(path, "the session");
    VOXTACT_TRY(text);
    Result<Document> document = parseSession(*text, path.string());
    VOXTACT_TRY(document);
    document->sources = foundFrom(std::move(document->sources), path.parent_path());
    return document;
}

Result<void> writeSession(const std::filesystem::path& path, const Document& document) {
    Document there = document;
    there.sources = seenFrom(std::move(there.sources), path.parent_path());
    return io::writeFile(path, [&there](std::ostream& out) -> Result<void> {
        out << sessionText(there);
        return {};
    });
}

Result<void> writeTransferFunction(const std::filesystem::path& path, const Document& document) {
    return io::writeFile(path, [&document](std::ostream& out) -> Result<void> {
        const Json all = Json::parse(sessionText(document));
        const Json& function = all["transfer_function"];
        Json json;
        json["points"] = function["points"];
        json["colours"] = function["colours"];
        out << json.dump(1) << "\n";
        return {};
    });
}

} // namespace voxtact::view
