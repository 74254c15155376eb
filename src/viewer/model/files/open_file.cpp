// SPDX-License-Identifier: MIT
#include "viewer/model/files/open_file.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "viewer/model/files/session_file.h"
#include "voxtact/io.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace voxtact::view {

namespace {

constexpr std::array<std::string_view, 12> kMeshEndings{".stl",  ".obj", ".ply",  ".off", ".vtk",  ".vtp",
                                                        ".gltf", ".glb", ".step", ".stp", ".iges", ".igs"};

Result<void> openFunction(const std::filesystem::path& path, State& state) {
    const Result<std::vector<ControlPoint>> points = io::readTransferFunction(path);
    VOXTACT_TRY(points);
    const Result<std::vector<ColourPoint>> colours = io::readColours(path);
    VOXTACT_TRY(colours);
    state.command([&](Edit& edit) {
        edit.curve = *points;
        edit.colours = colours->empty() ? edit.colours : *colours;
    });
    state.curvePoint.reset();
    state.taken.push_back(path.string());
    state.read.push_back(path.string());
    return {};
}

Result<void> openPoses(const std::filesystem::path& path, State& state) {
    Result<std::vector<Mat4>> poses = io::readPoses(path);
    VOXTACT_TRY(poses);
    state.document.poses = std::move(*poses);
    state.takePose(0);
    state.history.end();
    state.taken.push_back(path.string());
    state.read.push_back(path.string());
    return {};
}

/// Returns the document with another volume, or an additional mesh, which becomes an instrument once loaded.
Document withFile(Document document, FileKind kind, const std::string& path) {
    Sources& sources = document.sources;
    if (kind == FileKind::Mesh) {
        sources.meshes.push_back({path, "lps", 1});
    } else {
        // Labels, curve and camera were those of the volume before.
        sources.volume = path;
        sources.labels.clear();
        sources.labelNames.clear();
        document.camera.reset();
        document.cursor.reset();
        document.shown.reset();
        document.edit.holes = 0;
        document.holes.clear();
        sources.coarser = 1;
    }
    return document;
}

/// Several files opened at once do not replace each other.
void want(State& state, FileKind kind, const std::string& path) {
    const bool also = state.wanted && state.wanted->kind != FileKind::Session;
    const FileKind before = also ? state.wanted->kind : kind;
    Document document = withFile(also ? state.wanted->document : state.saved(), kind, path);
    state.wanted = Wanted{before == FileKind::Volume ? before : kind, std::move(document), path};
}

} // namespace

std::string endingOf(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](char letter) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    });
    return ending;
}

Result<FileKind> kindOfFile(const std::filesystem::path& path) {
    const std::string ending = endingOf(path);
    if (std::ranges::find(kMeshEndings, ending) != kMeshEndings.end()) {
        return FileKind::Mesh;
    }
    if (ending == ".json") {
        const Result<bool> session = isSession(path);
        VOXTACT_TRY(session);
        return *session ? FileKind::Session : FileKind::Function;
    }
    return ending == ".txt" ? FileKind::Poses : FileKind::Volume;
}

Result<void> openFile(const std::filesystem::path& path, State& state) {
    const Result<FileKind> kind = kindOfFile(path);
    VOXTACT_TRY(kind);
    if (state.blank && *kind != FileKind::Session && *kind != FileKind::Volume) {
        return refuse("'" + path.string() + "' needs a volume; open a volume or a session first");
    }
    if (*kind == FileKind::Function) {
        return openFunction(path, state);
    }
    if (*kind == FileKind::Poses) {
        return openPoses(path, state);
    }
    if (*kind == FileKind::Session) {
        Result<Document> session = readSession(path);
        VOXTACT_TRY(session);
        state.wanted = Wanted{*kind, std::move(*session), path.string()};
    } else {
        want(state, *kind, path.string());
    }
    return {};
}

void takeDropped(State& state) {
    for (const std::string& path : std::exchange(state.dropped, {})) {
        state.say("opened: " + path);
        if (const Result<void> opened = openFile(path, state); !opened.ok()) {
            state.say({});
            state.complain(opened.error().text);
        }
    }
}

} // namespace voxtact::view
