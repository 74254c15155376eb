// SPDX-License-Identifier: MIT
#pragma once

#include "cli/output/outcome.h"
#include "cli/output/output.h"
#include "core/facts/facts.h"
#include "voxtact/data.h"
#include "voxtact/io.h"
#include "voxtact/methods.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

/// The options that several commands have, and what they mean: one function a group adds them to a command.
namespace voxtact::app {

/// A command of the program: what parses its options, and what runs once they are parsed.
struct Command {
    CLI::App* parser = nullptr;
    std::function<Outcome()> run;
};

struct MeshOptions {
    std::vector<std::string> sources; ///< paths, or builtin:NAME
    std::string space;                ///< lps or ras; empty: what the file says, else LPS
    double scale = 1;
    double deflection = kDefaultDeflection; ///< mm; of STEP and IGES
};

struct TransferFunctionOptions {
    std::filesystem::path path;
    std::optional<std::string> opacity;
    const char* opacityOption = "--opacity"; ///< that `opacity` was given by
    std::optional<ValueRange> domain;
    std::optional<std::uint32_t> tableSize;
    double threshold = kDefaultThreshold;
};

struct ViewOptions {
    std::filesystem::path poses{};
    std::string posesSpace = "lps";
    io::PoseFormat posesFormat = io::PoseFormat::Matrix;
    std::filesystem::path camera{};
    VkExtent2D size{512, 512};
    bool sizeGiven = false;
};

struct MethodOptions {
    std::optional<CountingMethod> count;  ///< nothing: auto
    std::optional<Projection> projection; ///< nothing: the one that the other options leave
    std::optional<std::uint32_t> samplesPerVoxel;
    std::optional<double> resolution;
    std::optional<Filter> filter; ///< nothing: defaultFilter()
    Boundary boundary = Boundary::Auto;
};

/// A label map, and what names its labels.
struct LabelOptions {
    std::filesystem::path path;
    std::filesystem::path names;
};

struct DeviceChoice {
    std::string wanted; ///< empty: the default device
    bool validate = false;
    std::string cache; ///< a folder, "off", or empty: the user's cache folder
};

/// More only wait for each other.
constexpr std::uint32_t kMaxThreads = 1024;

struct WholeRange {
    std::uint32_t least = 0;
    std::uint32_t most = UINT32_MAX;
};
/// A whole number, as an option; with a default, or without.
void addWholeNumber(CLI::App& parser, const char* option, const std::function<void(std::uint32_t)>& store,
                    const WholeRange& range, const std::string& help, std::optional<std::uint32_t> standard);
/// Adds an option that stores to a variable; its value is the default.
void addWholeNumber(CLI::App& parser, const char* option, std::uint32_t& value, std::uint32_t least,
                    const std::string& help);
/// --seed: any whole number that has 64 bits.
void addSeed(CLI::App& parser, std::uint64_t& seed);
/// A finite number that is `usable`, as an option; `range` says in words which are.
void addNumber(CLI::App& parser, const char* option, const std::function<void(double)>& store, const std::string& help,
               const std::function<bool(double)>& usable, const char* range, const char* standard);
/// A number of the table of facts, as the option of its name.
void addFact(CLI::App& parser, const Fact& fact, const std::function<void(double)>& store);
/// The group of options that only --help-all lists.
inline constexpr const char* kRareOptions = "Rare options";
void setRare(CLI::App& parser, const char* option);
/// A check of options whose empty text would mean the default: a shell variable that is not set must not.
[[nodiscard]] std::string refuseEmpty(const std::string& text);
/// A path, as an option, with that check.
void addPath(CLI::App& parser, const char* option, std::filesystem::path& path, const std::string& help);
void addVolumeOption(CLI::App& parser, std::vector<std::string>& sources);
/// --resample: VolumeReadOptions::resample.
void addResampleOption(CLI::App& parser, bool& resample);
void addMeshOptions(CLI::App& parser, MeshOptions& options, bool required = true);
void addTransferFunctionOptions(CLI::App& parser, TransferFunctionOptions& options);
/// --tf-domain and --tf-size: of the table that pixel projections and pictures sample.
void addTableOptions(CLI::App& parser, TransferFunctionOptions& options);
/// A number of degrees, as an option.
void addDegrees(CLI::App& parser, const char* option, std::optional<double>& value, const std::string& help);
/// A colour RRGGBB, as an option; each channel then from 0 to 1.
void addColour(CLI::App& parser, const char* option, std::array<double, 3>& colour, const std::string& help);
/// Adds an option for one of `names`.
void addName(CLI::App& parser, const char* option, std::string& name, const std::vector<const char*>& names,
             const std::string& help);
/// Receives the text of an option; returns the error of an unusable text.
using UseText = std::function<std::optional<std::string>(const std::string&)>;
/// An option that is given once.
void addText(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type);
/// One that may be given several times: its texts in their order.
void addTexts(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type);
/// A colour RRGGBB, each channel then from 0 to 1; nothing where the text is none.
[[nodiscard]] std::optional<std::array<double, 3>> parseColour(const std::string& text);
/// Parses all of a text as a finite number; empty if it is none.
[[nodiscard]] std::optional<double> parseFinite(std::string_view text);
/// LO:HI, two finite numbers with LO below HI.
[[nodiscard]] std::optional<ValueRange> parseRange(std::string_view text);
/// --size; `standard`: what it is unless given.
void addSize(CLI::App& parser, const std::function<void(const VkExtent2D&)>& store, const std::string& help,
             const std::string& standard = "512x512");
/// lps or ras, as an option; the default is lps.
void addSpace(CLI::App& parser, const char* option, std::string& space, const std::string& help,
              const char* standard = "lps");
void addPosesOptions(CLI::App& parser, ViewOptions& options);
void addCameraOptions(CLI::App& parser, ViewOptions& options);
void addMethodOptions(CLI::App& parser, MethodOptions& options);
void addDeviceOptions(CLI::App& parser, DeviceChoice& options);
void addThreadsOption(CLI::App& parser, std::uint32_t& threads);
void addLabelOptions(CLI::App& parser, LabelOptions& options);
void addOutputOptions(CLI::App& parser, OutputOptions& options);
void addProgressOption(CLI::App& parser, bool& shown);

} // namespace voxtact::app
