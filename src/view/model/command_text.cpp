// SPDX-License-Identifier: MIT
#include "view/model/command_text.h"

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

std::string copyAsCommand(const Document& document, const MethodChoice& method, const std::string& device) {
    const Sources& sources = document.sources;
    std::string curve;
    for (const ControlPoint& point : document.edit.curve) {
        curve += (curve.empty() ? "" : ",") + number(point.value) + ":" + number(point.opacity);
    }
    const std::size_t holes = document.edit.holes;
    const std::string without = holes == 0   ? ""
                                : holes == 1 ? "# of the volume as it was read, without the hole that was drilled\n"
                                             : "# of the volume as it was read, without the " + std::to_string(holes) +
                                                   " holes that were drilled\n";
    const std::string copy = sources.coarser == 1 ? ""
                                                  : "# of the volume as it is in the file, not of its copy that is "
                                                    "coarser by " +
                                                        std::to_string(sources.coarser) + "\n";
    std::string text = copy + without + "echo '" + poseText(document.edit.world_from_object) +
                       "' | voxtact detect --volume " + sourceWord(sources.volume) + " --mesh " +
                       sourceWord(sources.mesh);
    if (sources.meshSpace != "lps") {
        text += " --mesh-space " + sources.meshSpace;
    }
    if (sources.meshScale != 1) {
        text += " --mesh-scale " + number(sources.meshScale);
    }
    if (!sources.labels.empty()) {
        text += " --labels " + sourceWord(sources.labels);
    }
    if (!sources.labelNames.empty()) {
        text += " --label-names " + sourceWord(sources.labelNames);
    }
    // With '=': a value may begin with a minus sign.
    text += " --poses - --opacity=" + curve + " --tf-domain=" + number(document.domain.lo) + ":" +
            number(document.domain.hi) + " --tf-size " + std::to_string(document.tableSize) + " --threshold " +
            number(document.edit.threshold) + " --projection " + toString(method.projection) + " --count " +
            toString(method.count);
    if (!device.empty() && method.count != CountingMethod::Cpu) {
        text += " --device " + shellWord(device);
    }
    return text;
}

} // namespace voxtact::view
