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

/// Options of several commands. One function per group adds them to a command.
namespace voxtact::app {

/// A command of the program: the parser of its options, and the function to run afterwards.
struct Command {
    CLI::App* parser = nullptr;
    std::function<Outcome()> run;
};

struct MeshOptions {
    std::vector<std::string> sources; ///< paths, or builtin:NAME
    std::string space;                ///< lps or ras; empty: as the file states, else LPS
    double scale = 1;
    double deflection = kDefaultDeflection; ///< mm; of STEP and IGES
};

struct TransferFunctionOptions {
    std::filesystem::path path;
    std::optional<std::string> opacity;
    const char* opacityOption = "--opacity"; ///< the option that gave `opacity`
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
    std::optional<CountingMethod> count;  ///< empty: auto
    std::optional<Projection> projection; ///< empty: determined by the other options
    std::optional<std::uint32_t> samplesPerVoxel;
    std::optional<double> resolution;
    std::optional<Filter> filter; ///< empty: defaultFilter()
    Boundary boundary = Boundary::Auto;
};

/// A label map, and the file of its names.
struct LabelOptions {
    std::filesystem::path path;
    std::filesystem::path names;
};

struct DeviceChoice {
    std::string wanted; ///< empty: the default device
    bool validate = false;
    std::string cache; ///< a folder, "off", or empty: the user's cache folder
};

/// Maximum threads: more would only wait for each other.
constexpr std::uint32_t kMaxThreads = 1024;

struct WholeRange {
    std::uint32_t least = 0;
    std::uint32_t most = UINT32_MAX;
};
/// Adds an option for a whole number; `standard`: its default, if any.
void addWholeNumber(CLI::App& parser, const char* option, const std::function<void(std::uint32_t)>& store,
                    const WholeRange& range, const std::string& help, std::optional<std::uint32_t> standard);
/// Adds an option that stores to a variable; its value is the default.
void addWholeNumber(CLI::App& parser, const char* option, std::uint32_t& value, std::uint32_t least,
                    const std::string& help);
/// Adds --seed: any 64-bit whole number.
void addSeed(CLI::App& parser, std::uint64_t& seed);
/// Adds an option for a finite number that is `usable`; `range`: the usable numbers, in words.
void addNumber(CLI::App& parser, const char* option, const std::function<void(double)>& store, const std::string& help,
               const std::function<bool(double)>& usable, const char* range, const char* standard);
/// Adds the option of a number in the table of facts.
void addFact(CLI::App& parser, const Fact& fact, const std::function<void(double)>& store);
/// The group of options that only --help-all lists.
inline constexpr const char* kRareOptions = "Rare options";
void setRare(CLI::App& parser, const char* option);
/// Refuses empty text, which would mean the default: an unset shell variable must not.
[[nodiscard]] std::string refuseEmpty(const std::string& text);
/// Adds an option for a path, which must not be empty.
void addPath(CLI::App& parser, const char* option, std::filesystem::path& path, const std::string& help);
void addVolumeOption(CLI::App& parser, std::vector<std::string>& sources);
/// Adds --resample: VolumeReadOptions::resample.
void addResampleOption(CLI::App& parser, bool& resample);
void addMeshOptions(CLI::App& parser, MeshOptions& options, bool required = true);
void addTransferFunctionOptions(CLI::App& parser, TransferFunctionOptions& options);
/// Adds --tf-domain and --tf-size: the table that pixel projections and pictures sample.
void addTableOptions(CLI::App& parser, TransferFunctionOptions& options);
/// Adds an option for degrees.
void addDegrees(CLI::App& parser, const char* option, std::optional<double>& value, const std::string& help);
/// Adds an option for a colour RRGGBB; stores channels from 0 to 1.
void addColour(CLI::App& parser, const char* option, std::array<double, 3>& colour, const std::string& help);
/// Adds an option for one of `names`.
void addName(CLI::App& parser, const char* option, std::string& name, const std::vector<const char*>& names,
             const std::string& help);
/// Receives the text of an option; returns the error of an unusable text.
using UseText = std::function<std::optional<std::string>(const std::string&)>;
/// Adds an option that may be given once.
void addText(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type);
/// Adds a repeatable option; receives its texts in order.
void addTexts(CLI::App& parser, const char* option, const UseText& use, const std::string& help, const char* type);
/// Parses a colour RRGGBB to channels from 0 to 1; empty if the text is none.
[[nodiscard]] std::optional<std::array<double, 3>> parseColour(const std::string& text);
/// Parses all of a text as a finite number; empty if it is none.
[[nodiscard]] std::optional<double> parseFinite(std::string_view text);
/// Parses LO:HI, two finite numbers with LO below HI.
[[nodiscard]] std::optional<ValueRange> parseRange(std::string_view text);
/// Adds --size; `standard`: its default.
void addSize(CLI::App& parser, const std::function<void(const VkExtent2D&)>& store, const std::string& help,
             const std::string& standard = "512x512");
/// Adds an option for lps or ras; default: lps.
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
