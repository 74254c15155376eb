// SPDX-License-Identifier: MIT
#include "cli/options/shared_options.h"

#include "cli/output/standard_streams.h"
#include "cli/output/text_for_messages.h"
#include "core/base/text.h"
#include "core/geometry/domain.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace voxtact::app {

namespace {

/// Parses all of `text` as a number; empty if it is none.
template <class Number> std::optional<Number> parseNumber(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return number;
}

std::string quote(std::string_view text) {
    return forMessage(text);
}

[[noreturn]] void refuse(const char* option, const std::string& why) {
    throw CLI::ValidationError(option, why);
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

/// Refuses a name that is not in `available`.
void requireName(const char* option, const std::string& name, const std::vector<std::string>& available) {
    if (std::find(available.begin(), available.end(), name) == available.end()) {
        refuse(option, quote(name) + " is unknown; choose from: " + join(available));
    }
}

/// Parses "lps" or "ras", in any case.
std::string parseSpace(const char* option, const std::string& text) {
    std::string space = CLI::detail::to_lower(text);
    requireName(option, space, {"lps", "ras"});
    return space;
}

template <class Value> std::vector<std::string> namesOf(std::span<const Value> values) {
    std::vector<std::string> names;
    for (const Value value : values) {
        names.emplace_back(toString(value));
    }
    return names;
}

/// Adds an option that `parse` reads; `parse` calls refuse() for unusable text.
CLI::Option* addParsed(CLI::App& parser, const char* option, const std::function<void(const std::string&)>& parse,
                       const std::string& help, const char* type, const char* standard) {
    return parser.add_option_function<std::string>(option, parse, help)->type_name(type)->default_str(standard);
}

/// Refuses text for which `use` returns an error.
std::function<void(const std::string&)> refusing(std::string option, const UseText& use) {
    return [option = std::move(option), use](const std::string& text) {
        if (const std::optional<std::string> wrong = use(text)) {
            refuse(option.c_str(), quote(text) + " " + *wrong);
        }
    };
}

VkExtent2D parseSize(const char* option, const std::string& text) {
    const std::size_t cross = text.find('x');
    if (cross != std::string::npos) {
        const auto width = parseNumber<std::uint32_t>(std::string_view(text).substr(0, cross));
        const auto height = parseNumber<std::uint32_t>(std::string_view(text).substr(cross + 1));
        if (width && height && *width > 0 && *height > 0) {
            return {*width, *height};
        }
    }
    refuse(option, quote(text) + " is not WIDTHxHEIGHT in pixels, each at least 1");
}

ValueRange parseDomain(const char* option, const std::string& text) {
    if (const std::optional<ValueRange> domain = parseRange(text)) {
        if (const Result<void> checked = checkDomain(*domain, "the domain"); !checked.ok()) {
            refuse(option, checked.error().text);
        }
        return *domain;
    }
    refuse(option, quote(text) + " is not LO:HI, two numbers with LO below HI");
}

} // namespace

void setRare(CLI::App& parser, const char* option) {
    parser.get_option(option)->group(kRareOptions);
}

std::string refuseEmpty(const std::string& text) {
    return text.empty() ? "an empty value" : "";
}

void addNumber(CLI::App& parser, const char* option, const std::function<void(double)>& store, const std::string& help,
               const std::function<bool(double)>& usable, const char* range, const char* standard) {
    const auto parse = [option, store, usable, range](const std::string& text) {
        const auto number = parseNumber<double>(text);
        if (!number || !std::isfinite(*number) || !usable(*number)) {
            refuse(option, quote(text) + " is not a number " + range);
        }
        store(*number);
    };
    addParsed(parser, option, parse, help, "NUM", standard);
}

void addFact(CLI::App& parser, const Fact& fact, const std::function<void(double)>& store) {
    std::string option = "--" + std::string(fact.name);
    std::ranges::replace(option, '_', '-');
    const auto parse = [option, &fact, store](const std::string& text) {
        const auto value = parseNumber<double>(text);
        if (!value || !std::isfinite(*value) || !isInRange(fact, *value)) {
            refuse(option.c_str(), quote(text) + " is not a number " + rangeText(fact));
        }
        store(*value);
    };
    addParsed(parser, option.c_str(), parse, std::string(fact.text), "NUM",
              fact.standard ? number(*fact.standard).c_str() : "");
}

void addWholeNumber(CLI::App& parser, const char* option, const std::function<void(std::uint32_t)>& store,
                    const WholeRange& range, const std::string& help, std::optional<std::uint32_t> standard) {
    const auto parse = [option, store, range](const std::string& text) {
        const auto number = parseNumber<std::uint32_t>(text);
        if (!number || *number < range.least || *number > range.most) {
            refuse(option, quote(text) + " is not a whole number from " + std::to_string(range.least) + " to " +
                               std::to_string(range.most));
        }
        store(*number);
    };
    addParsed(parser, option, parse, help, "N", standard ? std::to_string(*standard).c_str() : "");
}

void addWholeNumber(CLI::App& parser, const char* option, std::uint32_t& value, std::uint32_t least,
                    const std::string& help) {
    addWholeNumber(
        parser, option, [&value](std::uint32_t number) { value = number; }, {.least = least}, help, value);
}

void addSeed(CLI::App& parser, std::uint64_t& seed) {
    const auto parse = [&seed](const std::string& text) {
        const auto number = parseNumber<std::uint64_t>(text);
        if (!number) {
            refuse("--seed", quote(text) + " is not a whole number from 0 to 2^64-1");
        }
        seed = *number;
    };
    addParsed(parser, "--seed", parse, "seed of random poses, 0 to 2^64-1", "S", std::to_string(seed).c_str());
}

void addPath(CLI::App& parser, const char* option, std::filesystem::path& path, const std::string& help) {
    parser.add_option(option, path, help)->type_name("PATH")->check(refuseEmpty);
}

void addVolumeOption(CLI::App& parser, std::vector<std::string>& sources) {
    parser.add_option("--volume", sources, "3D image: NIfTI, NRRD, MetaImage, DICOM folder, builtin:NAME; repeatable")
        ->type_name("PATH")
        ->check(refuseEmpty)
        ->allow_extra_args(false)
        ->required();
}

void addResampleOption(CLI::App& parser, bool& resample) {
    parser.add_flag("--resample", resample,
                    "interpolate DICOM slices that are unevenly spaced or sheared instead of refusing them");
    setRare(parser, "--resample");
}

void addMeshOptions(CLI::App& parser, MeshOptions& options, bool required) {
    parser
        .add_option("--mesh", options.sources,
                    "mesh: STL, OBJ, PLY, OFF, VTK, glTF, STEP, IGES, builtin:NAME; repeatable")
        ->type_name("PATH")
        ->check(refuseEmpty)
        ->allow_extra_args(false)
        ->required(required);
    addSpace(parser, "--mesh-space", options.space, "lps or ras; default: as the file states, else lps", "");
    addNumber(
        parser, "--mesh-scale", [&options](double scale) { options.scale = scale; },
        "millimetres per unit of mesh files", [](double scale) { return scale > 0; }, "above 0", "1");
    addFact(parser, factOf("scene", "deflection"), [&options](double mm) { options.deflection = mm; });
    setRare(parser, "--mesh-scale");
    setRare(parser, "--deflection");
}

namespace {

/// Converts V or V:W to points that make only these values opaque.
std::optional<std::string> setIso(const std::string& text, TransferFunctionOptions& options) {
    const std::size_t colon = text.find(':');
    const std::string from = text.substr(0, colon);
    const std::string to = colon == std::string::npos ? std::string() : text.substr(colon + 1);
    const auto lo = parseFinite(from);
    const auto hi = colon == std::string::npos ? lo : parseFinite(to);
    if (!lo || !hi || *lo > *hi) {
        return "is not a value V, or V:W with V <= W";
    }
    options.opacity = from + ":0," + from + ":1" + (to.empty() ? "" : "," + to + ":1," + to + ":0");
    options.opacityOption = "--iso";
    return {};
}

} // namespace

void addTransferFunctionOptions(CLI::App& parser, TransferFunctionOptions& options) {
    addPath(parser, "--transfer-function", options.path, "lines 'value opacity', or JSON; default: a ramp");
    parser.add_option("--opacity", options.opacity, "\"value:opacity,...\", linear between these points")
        ->type_name("LIST")
        ->excludes("--transfer-function");
    addText(
        parser, "--iso", [&options](const std::string& text) { return setIso(text, options); },
        "opaque where value >= V, or V <= value <= W", "V[:W]");
    for (const char* const other : {"--transfer-function", "--opacity"}) {
        parser.get_option("--iso")->excludes(other);
    }
    addFact(parser, factOf("scene", "opacity_threshold"), [&options](double value) { options.threshold = value; });
}

void addTableOptions(CLI::App& parser, TransferFunctionOptions& options) {
    addParsed(
        parser, "--tf-domain",
        [&options](const std::string& text) { options.domain = parseDomain("--tf-domain", text); },
        "value range of the transfer function's table; default: 0:255 for uint8, else the image's range", "LO:HI", "");
    setRare(parser, "--tf-domain");
    addWholeNumber(
        parser, "--tf-size", [&options](std::uint32_t size) { options.tableSize = size; },
        {.least = 2, .most = kMaxTableSize},
        "entries of the transfer function's table; default: 256 for uint8, else 4096", std::nullopt);
    setRare(parser, "--tf-size");
}

void addDegrees(CLI::App& parser, const char* option, std::optional<double>& value, const std::string& help) {
    const auto parse = [option, &value](const std::string& text) {
        const auto number = parseNumber<double>(text);
        if (!number || !(std::abs(*number) <= 360)) {
            refuse(option, quote(text) + " is not a number from -360 to 360");
        }
        value = *number;
    };
    addParsed(parser, option, parse, help, "DEGREES", "");
}

std::optional<std::array<double, 3>> parseColour(const std::string& text) {
    constexpr int kHexadecimal = 16;
    std::array<double, 3> colour{};
    for (std::size_t channel = 0; channel < colour.size(); ++channel) {
        const char* digits = text.data() + 2 * channel;
        unsigned value = 0;
        if (text.size() != 2 * colour.size() ||
            std::from_chars(digits, digits + 2, value, kHexadecimal).ptr != digits + 2) {
            return std::nullopt;
        }
        colour[channel] = value / 255.0;
    }
    return colour;
}

std::optional<double> parseFinite(std::string_view text) {
    const auto number = parseNumber<double>(text);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<ValueRange> parseRange(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
        return std::nullopt;
    }
    const auto lo = parseFinite(text.substr(0, colon));
    const auto hi = parseFinite(text.substr(colon + 1));
    return lo && hi && *lo < *hi ? std::optional<ValueRange>({*lo, *hi}) : std::nullopt;
}

void addColour(CLI::App& parser, const char* option, std::array<double, 3>& colour, const std::string& help) {
    const auto parse = [option, &colour](const std::string& text) {
        const auto parsed = parseColour(text);
        if (!parsed) {
            refuse(option, quote(text) + " is not a colour RRGGBB, six hexadecimal digits");
        }
        colour = *parsed;
    };
    addParsed(parser, option, parse, help, "RRGGBB", "");
}

void addText(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type) {
    addParsed(parser, option, refusing(option, use), help, type, "");
}

void addTexts(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type) {
    const auto parse = [each = refusing(option, use)](const std::vector<std::string>& texts) {
        std::ranges::for_each(texts, each);
    };
    parser.add_option_function<std::vector<std::string>>(option, parse, help)->type_name(type)->allow_extra_args(false);
}

void addName(CLI::App& parser, const char* option, std::string& name, const std::vector<const char*>& names,
             const std::string& help) {
    const auto parse = [option, &name, known = names](const std::string& text) {
        if (std::find(known.begin(), known.end(), text) == known.end()) {
            std::string all;
            for (const char* one : known) {
                all += (all.empty() ? "" : ", ") + std::string(one);
            }
            refuse(option, quote(text) + " is unknown; choose from: " + all);
        }
        name = text;
    };
    addParsed(parser, option, parse, help, "NAME", "");
}

void addSize(CLI::App& parser, const std::function<void(const VkExtent2D&)>& store, const std::string& help,
             const std::string& standard) {
    addParsed(
        parser, "--size", [store](const std::string& text) { store(parseSize("--size", text)); }, help, "WxH",
        standard.c_str());
}

void addSpace(CLI::App& parser, const char* option, std::string& space, const std::string& help, const char* standard) {
    addParsed(
        parser, option, [option, &space](const std::string& name) { space = parseSpace(option, name); }, help, "SPACE",
        standard);
}

void addPosesOptions(CLI::App& parser, ViewOptions& options) {
    addPath(parser, "--poses", options.poses, "4x4 matrices, 16 numbers per line; -: standard input");
    addSpace(parser, "--poses-space", options.posesSpace, "space of the poses: lps or ras");
    addParsed(
        parser, "--poses-format",
        [&options](const std::string& name) {
            requireName("--poses-format", name, namesOf(io::poseFormats()));
            options.posesFormat = *io::poseFormatFromName(name);
        },
        "matrix, or 7 numbers a line, t in mm, unit quaternion: t-xyzw, t-wxyz, xyzw-t, wxyz-t", "F", "matrix");
    setRare(parser, "--poses-space");
    setRare(parser, "--poses-format");
}

void addCameraOptions(CLI::App& parser, ViewOptions& options) {
    addPath(parser, "--camera", options.camera,
            "clip_from_world matrix: 16 numbers, row by row; default: along world -z, framing the volume");
    addSize(
        parser,
        [&options](const VkExtent2D& size) {
            options.size = size;
            options.sizeGiven = true;
        },
        "viewport, pixels");
}

void addMethodOptions(CLI::App& parser, MethodOptions& options) {
    addParsed(
        parser, "--method",
        [&options](const std::string& name) {
            std::vector<std::string> known = namesOf(countingMethods());
            known.emplace_back("auto");
            requireName("--method", name, known);
            options.count = countingMethodFromName(name);
        },
        "query, query-any, atomic, subgroup, compute, cpu, auto", "METHOD", "auto");
    addParsed(
        parser, "--projection",
        [&options](const std::string& name) {
            requireName("--projection", name, namesOf(projections()));
            options.projection = projectionFromName(name);
        },
        "certified, view, two-view, dominant-axis; default: certified if the method supports it", "P", "");
    addWholeNumber(
        parser, "--samples-per-voxel", [&options](std::uint32_t samples) { options.samplesPerVoxel = samples; },
        {.least = 1, .most = kMaxSamplesPerVoxel}, "dominant-axis: samples per voxel side", kDefaultSamplesPerVoxel);
    addFact(parser, factOf("count", "resolution"), [&options](double resolution) { options.resolution = resolution; });
    addParsed(
        parser, "--filter",
        [&options](const std::string& name) {
            requireName("--filter", name, {"hardware", "exact"});
            options.filter = name == "exact" ? Filter::Exact : Filter::Hardware;
        },
        "sampling: hardware (the sampler) or exact (fp32, fixed order); default: exact for compute and cpu, else "
        "hardware",
        "F", "");
    addParsed(
        parser, "--boundary",
        [&options](const std::string& name) {
            requireName("--boundary", name, {"auto", "range", "clamp"});
            options.boundary = name == "range" ? Boundary::Range : name == "clamp" ? Boundary::Clamp : Boundary::Auto;
        },
        "outside the volume: range (tested), clamp (boundary voxels are transparent), auto", "B", "auto");
    for (const char* rare : {"--samples-per-voxel", "--resolution", "--filter", "--boundary"}) {
        setRare(parser, rare);
    }
}

void addDeviceOptions(CLI::App& parser, DeviceChoice& options) {
    parser.add_option("--device", options.wanted, "Vulkan device: index or part of its name")
        ->type_name("INDEX|NAME")
        ->check(refuseEmpty);
    parser.add_flag("--validate", options.validate,
                    "enable validation and synchronization validation; any message fails the run (exit 3)");
    parser
        .add_option("--cache", options.cache,
                    "folder for the pipeline cache, or off; default: $XDG_CACHE_HOME/voxtact, else ~/.cache/voxtact")
        ->type_name("DIR|off")
        ->check(refuseEmpty);
    setRare(parser, "--validate");
    setRare(parser, "--cache");
}

void addThreadsOption(CLI::App& parser, std::uint32_t& threads) {
    addWholeNumber(
        parser, "--threads", [&threads](std::uint32_t number) { threads = number; }, {.least = 0, .most = kMaxThreads},
        "threads of the host engine; 0: all", 0);
}

void addLabelOptions(CLI::App& parser, LabelOptions& options) {
    addPath(parser, "--labels", options.path, "label map, an image of integers");
    addPath(parser, "--label-names", options.names, "lines 'number name'; default: the label map's path with .txt");
    setRare(parser, "--label-names");
}

void addOutputOptions(CLI::App& parser, OutputOptions& options) {
    addPath(parser, "-o,--output", options.path, "output file; -: standard output");
    addParsed(
        parser, "--format",
        [&options](const std::string& name) {
            requireName("--format", name, {"csv", "json", "text"});
            options.formatName = name;
        },
        "csv, json, text; default: csv, on a terminal text", "F", "");
    parser.add_flag_callback("-q,--quiet", silenceNotes, "print no notes");
}

void addProgressOption(CLI::App& parser, bool& shown) {
    shown = true;
    addParsed(
        parser, "--progress",
        [&shown](const std::string& name) {
            requireName("--progress", name, {"auto", "never"});
            shown = name == "auto";
        },
        "progress on standard error: auto or never", "WHEN", "auto");
    setRare(parser, "--progress");
}

} // namespace voxtact::app
