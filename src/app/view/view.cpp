// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/detect/auto_method.h"
#include "app/draw/font.h"
#include "app/options/open_session.h"
#include "app/render/device_picture.h"
#include "app/view/view_options.h"
#include "core/base/try.h"
#include "view/window.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

view::WindowDesc windowDesc(const ViewerOptions& options, const Grid& grid) {
    view::WindowDesc desc;
    desc.size = {options.size.width, options.size.height};
    desc.font = {kFont, kFontBytes};
    desc.light = lightingOf("soft", grid);
    desc.reportState = options.reportState;
    desc.frames = options.frames;
    return desc;
}

/// The validation's messages are complete once everything on the device has ended.
Result<void> show(const ViewerOptions& options, Opened opened, Outcome& invalid) {
    const Result<std::unique_ptr<view::Display>> display = view::Display::open();
    VOXTACT_TRY(display);
    DeviceChoice choice = options.device;
    choice.wanted = choice.wanted == "cpu" ? "" : choice.wanted;
    std::shared_ptr<const device::ValidationMessages> messages;
    Result<void> shown = [&]() -> Result<void> {
        const Result<device::Session> session =
            openSession(choice, {(*display)->instanceExtensions(), (*display)->deviceExtensions()});
        VOXTACT_TRY(session);
        messages = session->instance.messages();
        if (!opened.document.method) {
            opened.document.method = view::MethodChoice{conservativeMethod(*session, {}), Projection::Conservative};
        }
        view::State state({std::move(opened.volume), std::move(opened.mesh), std::move(opened.labels), opened.values,
                           opened.document, choice.wanted, session->device.physical().name});
        return view::runWindow(**display, *session, state, windowDesc(options, state.volume.grid));
    }();
    if (shown.ok()) {
        invalid = validationOutcome(*messages);
    }
    return shown;
}

Outcome runView(const ViewerOptions& options) {
    VOXTACT_TRY(checkViewerOptions(options));
    Result<Opened> opened = openDocument(options);
    VOXTACT_TRY(opened);
    Outcome invalid;
    VOXTACT_TRY(show(options, std::move(*opened), invalid));
    return invalid;
}

} // namespace

Command addView(CLI::App& program) {
    auto options = std::make_shared<ViewerOptions>();
    CLI::App* parser = program.add_subcommand("view", "a window: volume, mesh and answer while they change");
    addViewerOptions(*parser, *options);
    return {parser, [options] { return runView(*options); }};
}

} // namespace voxtact::app
