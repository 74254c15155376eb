// SPDX-License-Identifier: MIT
// The arguments that the subcommands share, one a line of the input.
#include "cli/options/shared_options.h"
#include "fuzz.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace {

struct Everything {
    std::vector<std::string> volumes;
    voxtact::app::MeshOptions mesh;
    voxtact::app::TransferFunctionOptions transfer;
    voxtact::app::ViewOptions view;
    voxtact::app::MethodOptions method;
    voxtact::app::DeviceChoice device;
    voxtact::app::OutputOptions output;
    std::uint64_t seed = 0;
    bool progress = false;
};

void declare(CLI::App& parser, Everything& all) {
    using namespace voxtact::app;
    addVolumeOption(parser, all.volumes);
    addMeshOptions(parser, all.mesh, false);
    addTransferFunctionOptions(parser, all.transfer);
    addTableOptions(parser, all.transfer);
    addPosesOptions(parser, all.view);
    addCameraOptions(parser, all.view);
    addMethodOptions(parser, all.method);
    addDeviceOptions(parser, all.device);
    addOutputOptions(parser, all.output);
    addSeed(parser, all.seed);
    addProgressOption(parser, all.progress);
}

std::vector<std::string> linesOf(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Everything all;
    CLI::App parser("", "voxtact");
    declare(parser, all);
    std::vector<std::string> arguments = linesOf({reinterpret_cast<const char*>(data), size});
    // CLI11 takes them from the back.
    std::reverse(arguments.begin(), arguments.end());
    try {
        parser.parse(arguments);
    } catch (const CLI::ParseError&) {
        return 0;
    }
    voxtact::fuzz::require(all.transfer.tableSize.value_or(2) >= 2, "a table has two entries");
    voxtact::fuzz::require(all.transfer.threshold >= 0 && all.transfer.threshold <= 1, "a threshold is from 0 to 1");
    voxtact::fuzz::require(all.view.size.width > 0 && all.view.size.height > 0, "a viewport has pixels");
    voxtact::fuzz::require(all.mesh.scale > 0, "a mesh has a size");
    return 0;
}
