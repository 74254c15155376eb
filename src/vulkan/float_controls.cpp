// SPDX-License-Identifier: MIT
#include "vulkan/float_controls.h"

#include <array>
#include <cstddef>

namespace voxtact {

namespace {

// SPIR-V Specification 1.5, sections 2.3, 2.4, 3.6, 3.31 and 3.37.
constexpr std::size_t kHeaderWords = 5;
constexpr std::uint32_t kOpEntryPoint = 15;
constexpr std::uint32_t kOpExecutionMode = 16;
constexpr std::uint32_t kOpCapability = 17;
constexpr std::uint32_t kFloat64 = 10;

struct Control {
    bool FloatControls::*promised;
    std::uint32_t capability;
    std::uint32_t executionMode;
};

constexpr Control kControls[] = {
    {&FloatControls::keepsDenormals, 4464, 4459},  // DenormPreserve
    {&FloatControls::keepsSpecials, 4466, 4461},   // SignedZeroInfNanPreserve
    {&FloatControls::roundsToNearest, 4467, 4462}, // RoundingModeRTE
};

constexpr std::uint32_t instruction(std::uint32_t words, std::uint32_t opcode) {
    return words << 16U | opcode;
}

/// The widths of the floats that a module has.
std::span<const std::uint32_t> widthsOf(std::span<const std::uint32_t> spirv) {
    static constexpr std::array<std::uint32_t, 2> kWidths{32, 64};
    for (std::size_t at = kHeaderWords; at + 1 < spirv.size() && (spirv[at] & 0xffffU) == kOpCapability; at += 2) {
        if (spirv[at + 1] == kFloat64) {
            return kWidths;
        }
    }
    return std::span(kWidths).first(1);
}

/// The entry points' identifiers, and the word behind the last of them, where execution modes may begin.
struct EntryPoints {
    std::vector<std::uint32_t> ids;
    std::size_t end = 0;
};

EntryPoints entryPointsOf(std::span<const std::uint32_t> spirv) {
    EntryPoints out;
    std::size_t words = 0;
    for (std::size_t at = kHeaderWords; at < spirv.size(); at += words) {
        words = spirv[at] >> 16U;
        if (words == 0) {
            break;
        }
        if ((spirv[at] & 0xffffU) == kOpEntryPoint) {
            out.ids.push_back(spirv[at + 2]);
            out.end = at + words;
        } else if (!out.ids.empty()) {
            break;
        }
    }
    return out;
}

} // namespace

std::vector<std::uint32_t> withFloatControls(std::span<const std::uint32_t> spirv, const FloatControls& promised) {
    const EntryPoints entryPoints = entryPointsOf(spirv);
    if (entryPoints.ids.empty()) {
        return {spirv.begin(), spirv.end()};
    }
    std::vector<std::uint32_t> capabilities;
    std::vector<std::uint32_t> modes;
    const std::span<const std::uint32_t> widths = widthsOf(spirv);
    for (const Control& control : kControls) {
        const bool ofDenormals = control.promised == &FloatControls::keepsDenormals;
        if (!(promised.*control.promised) || (ofDenormals && widths.size() > 1)) {
            continue;
        }
        capabilities.insert(capabilities.end(), {instruction(2, kOpCapability), control.capability});
        for (const std::uint32_t id : entryPoints.ids) {
            for (const std::uint32_t width : widths) {
                modes.insert(modes.end(), {instruction(4, kOpExecutionMode), id, control.executionMode, width});
            }
        }
    }
    std::vector<std::uint32_t> out;
    const auto append = [&out](std::span<const std::uint32_t> words) {
        out.insert(out.end(), words.begin(), words.end());
    };
    out.reserve(spirv.size() + capabilities.size() + modes.size());
    append(spirv.first(kHeaderWords));
    append(capabilities);
    append(spirv.subspan(kHeaderWords, entryPoints.end - kHeaderWords));
    append(modes);
    append(spirv.subspan(entryPoints.end));
    return out;
}

} // namespace voxtact
