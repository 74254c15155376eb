// SPDX-License-Identifier: MIT
#include "view/state.h"

#include "view/model/histogram.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace voxtact::view {

namespace {

constexpr std::size_t kBins = 256;
constexpr auto kRest = std::chrono::milliseconds(200);

auto parts(const Camera& camera) {
    return std::tuple(camera.target, camera.direction.azimuth, camera.direction.elevation, camera.halfHeight);
}

Vec3 middleOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

} // namespace

State::State(Given opened)
    : volume(std::move(opened.volume)), mesh(std::move(opened.mesh)), labels(std::move(opened.labels)),
      values(opened.values), deviceOption(std::move(opened.deviceOption)), deviceName(std::move(opened.deviceName)),
      document(std::move(opened.document)), window(opened.values) {
    // The volume was checked when it was read.
    texture_from_world = textureFromWorld(volume.grid).value();
    histogram = view::histogram(volume.view(), document.domain, kBins);
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
    if (other || moved) {
        changed_ = Clock::now();
    }
    // A new answer paints other triangles.
    if (other || moved || answered != seen_.answer) {
        ++pictureRevision;
        fineShare = 0;
    }
    seen_ = {document.edit, method, camera, picture.extent, answered};
}

void State::command(const std::function<void(Edit&)>& change, const std::string& merge) {
    const Edit before = document.edit;
    change(document.edit);
    history.add(before, document.edit, merge);
}

/// The volume becomes that of the edit.
void State::drillAndFill() {
    std::ranges::move(holes_.bring(volume, document.edit.holes), std::back_inserter(writes));
}

void State::drill(const Vec3& centre) {
    drillAndFill();
    Result<Hole> hole = holeOf(volume.view(), {centre, drillRadius}, values.lo);
    if (!hole.ok()) {
        complain(hole.error().text);
        return;
    }
    if (hole->before == hole->after) {
        say("nothing to drill there: no voxel changes");
        return;
    }
    holes_.add(std::move(*hole));
    command([](Edit& edit) { ++edit.holes; });
}

void State::undo() {
    history.undo(document.edit);
    curvePoint.reset();
}

void State::redo() {
    history.redo(document.edit);
    curvePoint.reset();
}

void State::takePose(std::size_t number) {
    if (number >= document.poses.size()) {
        return;
    }
    document.pose = number;
    command([&](Edit& edit) { edit.world_from_object = document.poses[number]; }, "poses");
}

bool State::atRest() const {
    return Clock::now() - changed_ >= kRest;
}

Document State::saved() const {
    Document out = document;
    out.method = method;
    out.camera = camera;
    out.cursor = cursor;
    return out;
}

} // namespace voxtact::view
