// SPDX-License-Identifier: MIT
#include "viewer/state.h"

#include "viewer/model/files/source_paths.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace voxtact::view {

namespace {

constexpr auto kRest = std::chrono::milliseconds(200);
constexpr auto kFollows = std::chrono::seconds(1);

auto parts(const Camera& camera) {
    return std::tuple(camera.target, camera.direction.azimuth, camera.direction.elevation, camera.halfHeight);
}

Vec3 middleOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

} // namespace

State::State(Given opened)
    : blank(false), volume(std::move(opened.volume)), meshes(std::move(opened.meshes)),
      labels(std::move(opened.labels)), values(opened.values), coarserBy(opened.coarserBy),
      deviceOption(std::move(opened.deviceOption)), deviceName(std::move(opened.deviceName)),
      document(std::move(opened.document)), window(opened.values), read(std::move(opened.read)) {
    // The volume was checked when it was read.
    texture_from_world = textureFromWorld(volume.grid).value();
    for (const MeshData& mesh : meshes) {
        bounds.push_back(checkMesh(mesh.view()).value().bounds); // they were checked, too
    }
    histogram = histogramOf(volume.view(), document.domain);
    if (document.shown) {
        show(*document.shown);
    }
    drillAll(document.holes);
    writes = {}; // there is no copy yet
    method = document.method.value_or(MethodChoice{});
    camera = document.camera.value_or(framing(volume.grid, {20, 15}));
    cursor = document.cursor.value_or(middleOf(volume.grid));
    if (!(window.lo < window.hi)) {
        window = document.domain;
    }
    seen_.edit = document.edit;
    seen_.method = method;
    seen_.camera = camera;
}

void State::update() {
    drillAndFill();
    const bool other = !(document.edit == seen_.edit) || !(method == seen_.method);
    const std::uint64_t answered = answer ? answer->revision : 0;
    const bool moved = parts(camera) != parts(seen_.camera) || picture.extent.width != seen_.extent.width ||
                       picture.extent.height != seen_.extent.height;
    if (other) {
        ++revision;
    }
    if (document.edit.instruments != seen_.edit.instruments) {
        offers.clear();
    }
    if (other || moved) {
        changed_ = Clock::now();
    }
    // A new answer paints other triangles.
    if (other || moved || answered != seen_.answer) {
        ++pictureRevision;
        fineShare = 0;
    }
    seen_ = {document.edit, method, camera, picture.extent, answered};
    // Notes take space: a dragged item must not move under the pointer.
    if (!blank && noted_ != revision && (noted_ == 0 || !itemHeld)) {
        offers = noted_ == 0 && offersOf ? offersOf(*this) : std::move(offers);
        noted_ = revision;
        notes = notesOf ? notesOf(*this) : std::vector<std::string>();
    }
    if (comparing && atRest() && !comparison.isOf(document.edit)) {
        comparison.begin(document.edit, methods);
    }
}

void State::command(const std::function<void(Edit&)>& change, const std::string& merge) {
    const Edit before = document.edit;
    change(document.edit);
    history.add(before, document.edit, merge);
}

void State::step(const std::function<void(Edit&)>& change, const std::string& merge, bool held) {
    const Clock::time_point now = Clock::now();
    if (!held && now - stepped_ > kFollows) {
        history.end();
    }
    stepped_ = now;
    command(change, merge);
}

/// The volume becomes that of the edit.
void State::drillAndFill() {
    bringHoles(document.edit.holes);
}

void State::bringHoles(std::size_t number) {
    for (HoleWrite& write : holes_.bring(volume, number)) {
        recount(histogram, {volume.type, write.hole->box, write.replaced(), write.voxels()});
        writes.add(std::move(write));
    }
}

void State::drill(const Vec3& centre) {
    drillAndFill();
    Result<Hole> hole = holeOf(volume.view(), {centre, drillRadius}, values.lo);
    if (!hole.ok()) {
        complain(hole.error().text);
        return;
    }
    if (hole->before == hole->after) {
        say("drilling there changes no voxel");
        return;
    }
    addHole(std::move(*hole), {centre, drillRadius});
    command([](Edit& edit) { ++edit.holes; });
}

Shown State::shown() const {
    Shown out;
    out.handleAxes = gizmoAxes;
    out.handles = showGizmo;
    out.contacts = showContacts;
    out.logHistogram = logHistogram;
    out.maximised = maximised;
    out.theme = theme;
    out.stepMillimetres = stepMillimetres;
    out.stepDegrees = stepDegrees;
    out.drillRadius = drillRadius;
    out.window = window;
    return out;
}

void State::show(const Shown& what) {
    gizmoAxes = what.handleAxes;
    showGizmo = what.handles;
    showContacts = what.contacts;
    logHistogram = what.logHistogram;
    maximised = what.maximised;
    theme = what.theme;
    stepMillimetres = what.stepMillimetres;
    stepDegrees = what.stepDegrees;
    drillRadius = what.drillRadius;
    window = what.window.value_or(window);
}

/// Discards the filled holes.
void State::addHole(Hole hole, const Ball& ball) {
    balls_.resize(holes_.drilled());
    balls_.push_back(ball);
    holes_.add(std::move(hole));
}

/// Drills each hole into the result of the previous ones; then keeps as many as the edit has.
void State::drillAll(const std::vector<Ball>& balls) {
    for (const Ball& ball : balls) {
        Result<Hole> hole = holeOf(volume.view(), ball, values.lo);
        if (!hole.ok()) {
            complain(hole.error().text);
            break;
        }
        addHole(std::move(*hole), ball);
        bringHoles(holes_.drilled() + 1);
    }
    document.edit.holes = std::min(document.edit.holes, balls_.size());
    drillAndFill();
}

void State::drillAnew(const std::vector<Ball>& balls) {
    bringHoles(0);
    holes_ = {};
    balls_.clear();
    drillAll(balls);
}

void State::passOn(State& next, std::optional<FileKind> opened) {
    if (!blank && (opened == FileKind::Mesh || opened == FileKind::Volume)) {
        Document kept = saved();
        kept.sources = next.document.sources;
        if (opened == FileKind::Volume) {
            kept.edit.curve = next.document.edit.curve;
            kept.edit.holes = 0;
            kept.holes.clear();
            kept.edit.colours = next.document.edit.colours;
            kept.domain = next.document.domain;
            kept.tableSize = next.document.tableSize;
        } else {
            next.camera = camera;
            next.cursor = cursor;
            next.window = window;
            next.zoomedRange = zoomedRange;
            next.history = std::move(history);
        }
        next.document = std::move(kept);
        next.placeNewMeshes(document.sources.meshes.size());
        next.method = method;
        next.drillAnew(next.document.holes);
    }
    next.frame = frame;
    next.frameTimes = frameTimes;
    next.keys = std::move(keys);
    next.keystrokes = std::move(keystrokes);
    next.typedAngles = typedAngles;
    next.pointer = std::move(pointer);
    next.dropped = std::move(dropped);
    next.picture.extent = picture.extent;
    next.picture.corner = picture.corner;
    next.picture.size = picture.size;
    for (std::size_t slice = 0; slice < slices.size(); ++slice) {
        next.slices[slice].extent = slices[slice].extent;
    }
    next.error = next.error.empty() ? error : next.error;
    if (!next.document.shown || opened == FileKind::Volume || opened == FileKind::Mesh) {
        Shown kept = shown();
        kept.window = next.window;
        next.show(kept);
    }
    next.helpOpen = helpOpen;
    next.comparing = comparing;
    next.quit = quit;
    next.wanted = std::move(wanted);
    next.recent = std::move(recent);
    next.read.insert(next.read.end(), read.begin(), read.end());
    next.mayWrite = mayWrite;
    next.notesOf = notesOf;
    next.offersOf = offersOf;
}

Result<void> State::checkOutput(const std::filesystem::path& path) const {
    std::vector<std::string> inputs = read;
    Sources sources = document.sources;
    for (const SourceMember& member : membersOf(sources)) {
        inputs.push_back(*member.path);
    }
    return mayWrite ? mayWrite(path, inputs) : Result<void>();
}

Given State::giveBack() {
    Given out;
    out.document = saved();
    static_cast<void>(holes_.bring(volume, 0)); // they are drilled again
    out.volume = std::move(volume);
    out.meshes = std::move(meshes);
    out.labels = std::move(labels);
    out.values = values;
    out.coarserBy = coarserBy;
    out.deviceOption = deviceOption;
    out.read = std::exchange(read, {});
    State next;
    passOn(next, std::nullopt);
    *this = std::move(next);
    return out;
}

void State::undo() {
    history.undo(document.edit);
    curvePoint.reset();
    gizmoDrag.reset();
}

void State::redo() {
    history.redo(document.edit);
    curvePoint.reset();
    gizmoDrag.reset();
}

void State::choose(std::size_t number) {
    if (number < document.edit.instruments.size()) {
        document.edit.chosen = number;
        gizmoDrag.reset();
        history.end();
    }
}

void State::remove(std::size_t number) {
    if (number >= document.edit.instruments.size() || document.edit.instruments.size() == 1) {
        return;
    }
    gizmoDrag.reset();
    command([number](Edit& edit) {
        edit.instruments.erase(edit.instruments.begin() + static_cast<std::ptrdiff_t>(number));
        edit.chosen -= edit.chosen > number || edit.chosen == edit.instruments.size() ? 1 : 0;
    });
}

/// At the position of the chosen instrument.
void State::placeNewMeshes(std::size_t known) {
    if (known >= document.sources.meshes.size()) {
        return;
    }
    command([this, known](Edit& edit) {
        for (std::size_t mesh = known; mesh < document.sources.meshes.size(); ++mesh) {
            edit.instruments.push_back({mesh, edit.pose(), true});
        }
        edit.chosen = edit.instruments.size() - 1;
    });
}

const MeshAnswer* State::chosenAnswer() const {
    return answer ? answer->of(document.edit.instrument().mesh) : nullptr;
}

const MeshMeasures* State::chosenDistance() const {
    return distances ? distances->of(document.edit.instrument().mesh) : nullptr;
}

void State::takePose(std::size_t number, bool held) {
    if (number >= document.poses.size()) {
        return;
    }
    document.pose = number;
    step([&](Edit& edit) { edit.pose() = document.poses[number]; }, "poses", playing || held);
}

double State::seconds() const {
    return std::chrono::duration<double>(Clock::now() - begun_).count();
}

bool State::atRest() const {
    return Clock::now() - changed_ >= kRest;
}

Document State::saved() const {
    Document out = document;
    out.method = method;
    out.camera = camera;
    out.cursor = cursor;
    out.holes = balls_;
    out.shown = shown();
    return out;
}

} // namespace voxtact::view
