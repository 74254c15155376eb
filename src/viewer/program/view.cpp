// SPDX-License-Identifier: MIT
#include "cli/draw/font.h"
#include "cli/options/open_session.h"
#include "cli/output/standard_streams.h"
#include "core/base/try.h"
#include "viewer/program/view_notes.h"
#include "viewer/program/view_options.h"
#include "viewer/window.h"
#include "voxtact/render.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

/// Without a window, a dialog cannot name the faulty file.
Error noDisplay(const ViewerOptions& options, const Error& error) {
    view::Progress progress;
    const Result<Opened> opened = openDocument(options, progress);
    return opened.ok() ? error : opened.error();
}

bool isCertifyingGpu(const device::Session& session) {
    return session.device.physical().type != VK_PHYSICAL_DEVICE_TYPE_CPU &&
           session.context.supports(CountingMethod::Compute, Projection::Certified);
}

view::WindowDesc windowDesc(const ViewerOptions& options) {
    view::WindowDesc desc;
    desc.size = {options.size.width, options.size.height};
    desc.font = {kFont, kFontBytes};
    desc.light = [](const Grid& grid) { return lightingNamed("soft", grid).value_or(Lighting{}); };
    desc.mayWrite = checkWindowOutput;
    desc.notes = windowNotes;
    desc.offers = windowOffers;
    desc.tell = printNoteOnce;
    desc.reportState = options.reportState;
    desc.frames = options.frames;
    desc.maxSide = options.maxSide;
    desc.method = [](const device::Session& session) {
        return view::MethodChoice{isCertifyingGpu(session) ? CountingMethod::Compute : CountingMethod::Cpu,
                                  Projection::Certified};
    };
    return desc;
}

/// Adds readers of the files, and the default method.
void addReaders(view::WindowDesc& desc, const ViewerOptions& options, const std::string& device) {
    const auto given = [device, standard = desc.method](Result<Opened> files,
                                                        const device::Session& session) -> Result<view::Given> {
        VOXTACT_TRY(files);
        view::Given out{std::move(files->volume),
                        std::move(files->meshes),
                        std::move(files->labels),
                        files->values,
                        files->document,
                        1,
                        std::move(files->read),
                        device,
                        {}};
        out.document.method = out.document.method ? *out.document.method : standard(session);
        return out;
    };
    desc.first = [options, given](const device::Session& session, view::Progress& progress) {
        return given(openDocument(options, progress), session);
    };
    desc.open = [given](const view::Wanted& wanted, const device::Session& session, view::Progress& progress) {
        return given(openWanted(wanted, progress), session);
    };
}

/// A session opens in the window, which asks for missing files.
Result<void> addSession(view::WindowDesc& desc, const ViewerOptions& options) {
    if (options.session.empty()) {
        return {};
    }
    Result<view::Document> document = sessionOf(options);
    VOXTACT_TRY(document);
    desc.first = nullptr;
    desc.opened = view::Wanted{view::FileKind::Session, std::move(*document), options.session.string()};
    return {};
}

/// The validation's messages are complete once everything on the device has ended.
Result<void> show(const ViewerOptions& options, Outcome& invalid) {
    view::WindowDesc desc = windowDesc(options);
    DeviceChoice choice = options.device;
    choice.wanted = choice.wanted == "cpu" ? "" : choice.wanted;
    addReaders(desc, options, choice.wanted);
    VOXTACT_TRY(addSession(desc, options));
    const Result<std::unique_ptr<view::Display>> display = view::Display::open();
    if (!display.ok()) {
        return noDisplay(options, display.error());
    }
    std::vector<std::shared_ptr<const device::ValidationMessages>> messages;
    desc.session = [&]() -> Result<std::unique_ptr<device::Session>> {
        Result<device::Session> session =
            openSession(choice, {(*display)->instanceExtensions(), (*display)->deviceExtensions()});
        VOXTACT_TRY(session);
        messages.push_back(session->instance.messages());
        return std::make_unique<device::Session>(std::move(*session));
    };
    VOXTACT_TRY(view::runWindow(**display, desc));
    for (const auto& said : messages) {
        if (Outcome outcome = validationOutcome(*said); outcome.status != 0) {
            invalid = std::move(outcome);
        }
    }
    return {};
}

Outcome runView(const ViewerOptions& options) {
    VOXTACT_TRY(checkViewerOptions(options));
    Outcome invalid;
    VOXTACT_TRY(show(options, invalid));
    return invalid;
}

} // namespace

Command addView(CLI::App& program) {
    auto options = std::make_shared<ViewerOptions>();
    CLI::App* parser = program.add_subcommand("view", "open a window with volume, meshes and live answers");
    addViewerOptions(*parser, *options);
    return {parser, [options] { return runView(*options); }};
}

} // namespace voxtact::app
