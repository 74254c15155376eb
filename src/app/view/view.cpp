// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/detect/auto_method.h"
#include "app/draw/font.h"
#include "app/options/open_session.h"
#include "app/view/view_options.h"
#include "core/base/try.h"
#include "view/window.h"
#include "voxtact/render.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

view::WindowDesc windowDesc(const ViewerOptions& options, const Grid& grid) {
    view::WindowDesc desc;
    desc.size = {options.size.width, options.size.height};
    desc.font = {kFont, kFontBytes};
    desc.light = lightingNamed("soft", grid).value_or(Lighting{});
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
        const view::MethodChoice standard{conservativeMethod(*session, {}), Projection::Conservative};
        opened.document.method = opened.document.method.value_or(standard);
        const auto given = [&](Opened files) -> view::Given {
            return {std::move(files.volume), std::move(files.mesh), std::move(files.labels),        files.values,
                    files.document,          choice.wanted,         session->device.physical().name};
        };
        view::State state(given(std::move(opened)));
        view::WindowDesc desc = windowDesc(options, state.volume.grid);
        desc.open = [&](const view::Wanted& wanted) -> Result<view::Given> {
            Result<Opened> files = openWanted(wanted);
            VOXTACT_TRY(files);
            files->document.method = files->document.method.value_or(standard);
            return given(std::move(*files));
        };
        return view::runWindow(**display, *session, state, desc);
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
