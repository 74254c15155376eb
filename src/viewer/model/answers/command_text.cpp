// SPDX-License-Identifier: MIT
#include "viewer/model/answers/command_text.h"

#include "core/base/text.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace voxtact::view {

namespace {

constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=+@%";

std::string sourceWord(const std::string& source) {
    std::error_code failed;
    const bool builtin = source.starts_with("builtin:");
    const std::filesystem::path absolute = std::filesystem::absolute(source, failed);
    return shellWord(builtin || failed ? source : absolute.string());
}

/// Parts of the document that the command ignores.
std::string commentsOf(const Document& document) {
    const std::size_t holes = document.edit.holes;
    const std::string without =
        holes == 0   ? ""
        : holes == 1 ? "# for the volume in the file, without the drilled hole\n"
                     : "# for the volume in the file, without the " + std::to_string(holes) + " drilled holes\n";
    const std::uint32_t coarser = document.sources.coarser;
    const std::string copy = coarser == 1 ? ""
                                          : "# for the volume in the file, not for its copy that is coarser by " +
                                                std::to_string(coarser) + "\n";
    return copy + without;
}

std::string filesText(const Sources& sources, const MeshSource& mesh) {
    std::string text = " --volume " + sourceWord(sources.volume) + " --mesh " + sourceWord(mesh.path);
    if (mesh.space != "lps") {
        text += " --mesh-space " + mesh.space;
    }
    if (mesh.scale != 1) {
        text += " --mesh-scale " + number(mesh.scale);
    }
    if (!sources.labels.empty()) {
        text += " --label-counts --labels " + sourceWord(sources.labels);
    }
    if (!sources.labelNames.empty()) {
        text += " --label-names " + sourceWord(sources.labelNames);
    }
    return text;
}

std::string lineFor(const Document& document, const Instrument& instrument, const MethodChoice& method,
                    const std::string& device) {
    std::string curve;
    for (const ControlPoint& point : document.edit.curve) {
        curve += (curve.empty() ? "" : ",") + number(point.value) + ":" + number(point.opacity);
    }
    std::string text = "echo '" + poseText(instrument.world_from_object) + "' | voxtact count" +
                       filesText(document.sources, document.sources.meshes[instrument.mesh]);
    // With '=': a value may begin with a minus sign.
    text += " --poses - --opacity=" + curve + " --tf-domain=" + number(document.domain.lo) + ":" +
            number(document.domain.hi) + " --tf-size " + std::to_string(document.tableSize) + " --opacity-threshold " +
            number(document.edit.threshold) + " --projection " + toString(method.projection) + " --method " +
            toString(method.count);
    if (!device.empty() && method.count != CountingMethod::Cpu) {
        text += " --device " + shellWord(device);
    }
    return text;
}

} // namespace

std::string shellWord(const std::string& text) {
    if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) {
        return text;
    }
    std::string word = "'";
    for (const char letter : text) {
        word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    }
    return word + "'";
}

std::string poseText(const Mat4& world_from_object) {
    std::string text;
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            text += (text.empty() ? "" : " ") + number(world_from_object[4 * column + row]);
        }
    }
    return text;
}

std::string commandFor(const Document& document, const Instrument& instrument, const MethodChoice& method,
                       const std::string& device) {
    return commentsOf(document) + lineFor(document, instrument, method, device);
}

std::string copyAsCommand(const Document& document, const MethodChoice& method, const std::string& device) {
    std::string text;
    for (const Instrument& instrument : document.edit.instruments) {
        text += (text.empty() ? "" : "\n") + lineFor(document, instrument, method, device);
    }
    return commentsOf(document) + text;
}

} // namespace voxtact::view
