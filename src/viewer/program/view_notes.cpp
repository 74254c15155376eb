// SPDX-License-Identifier: MIT
#include "viewer/program/view_notes.h"

#include "cli/options/opacity_notes.h"
#include "cli/options/placement.h"
#include "cli/output/size_note.h"
#include "voxtact/looks.h"

namespace voxtact::app {

namespace {

/// By the curve, whatever its source.
std::string noteOfPreset(const view::State& state) {
    for (const LookPreset& preset : lookPresets()) {
        const Result<Look> look = lookNamed(preset.name, state.values);
        if (look.ok() && view::sameCurve(look->opacity, state.document.edit.curve)) {
            return presetNote(preset.name, state.values);
        }
    }
    return {};
}

} // namespace

std::vector<std::string> windowNotes(const view::State& state) {
    const view::Document& document = state.document;
    std::vector<std::string> notes;
    if (std::string said = noteOfPreset(state); !said.empty()) {
        notes.push_back(std::move(said));
    }
    for (const std::string& said : opacityNotes({document.edit.curve, document.domain, document.tableSize},
                                                state.values, document.edit.threshold, document.sources.volume, true)) {
        notes.push_back(said);
    }
    // A mesh of a suspicious size usually has another unit than stated.
    for (const view::Instrument& instrument : document.edit.instruments) {
        const std::string said =
            sizeNote(state.bounds[instrument.mesh], instrument.world_from_object, state.volume.grid);
        if (!said.empty()) {
            notes.push_back("the mesh " + document.sources.meshes[instrument.mesh].path + " " + said);
        }
    }
    return notes;
}

std::vector<view::Offer> windowOffers(const view::State& state) {
    std::vector<view::Offer> offers;
    for (const view::Instrument& instrument : state.document.edit.instruments) {
        const view::MeshSource& given = state.document.sources.meshes[instrument.mesh];
        const MeshOptions options{.sources = {}, .space = given.space, .scale = given.scale};
        const ReadMesh read{given.path, options, state.bounds[instrument.mesh], {&instrument.world_from_object, 1}};
        if (placementOf(read, state.volume.grid).distance == 0) {
            continue;
        }
        const std::vector<OtherReading> others = otherReadings(read, state.volume.grid);
        if (others.empty()) {
            continue;
        }
        const OtherReading& best = others.front();
        view::Document document = state.saved();
        view::MeshSource& source = document.sources.meshes[instrument.mesh];
        source.space = best.space.empty() ? given.space : best.space;
        source.scale = best.scale;
        offers.push_back({"the mesh " + given.path + " does not come near the volume; " + toText(best),
                          "read it with " + best.options,
                          {view::FileKind::Session, std::move(document), given.path}});
    }
    return offers;
}

} // namespace voxtact::app
