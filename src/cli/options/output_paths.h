// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"

#include <filesystem>
#include <string>
#include <vector>

/// Checks before any work that a command's outputs are none of its inputs.
namespace voxtact::app {

/// A path, and the option that names it: "--output".
struct NamedPath {
    std::string option;
    std::filesystem::path path;
};

/// A file or folder of volumes as in an option: its path, and after a '#' the selected image (a frame, or the UID of a
/// series). The whole text is the path if it exists.
struct NamedImage {
    std::filesystem::path path;
    std::string which; ///< empty: the only one
};
[[nodiscard]] NamedImage namedImage(const std::string& source);

/// Adds a file or folder that is read, without the part after '#'; skips builtins, standard input and empty paths.
void addInput(std::vector<NamedPath>& inputs, const char* option, const std::filesystem::path& path);
/// The files and folders that the options read.
[[nodiscard]] std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes);
[[nodiscard]] std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes,
                                                const TransferFunctionOptions& transferFunction,
                                                const ViewOptions& view, const LabelOptions& labels = {});

/// Returns files that a header (.hdr, .nhdr, .mhd, .gltf) may refer to; they need not exist. Reads headers leniently.
[[nodiscard]] Result<std::vector<std::filesystem::path>> filesNamedIn(const std::filesystem::path& header);

/// Refuses outputs that cannot be written, two outputs to one file or to standard output ("-"), and an output that is
/// an input under any name: a link, another spelling, a file of a DICOM folder, a data file of a header. After
/// keepExisting(true), also refuses existing files. Ignores empty paths.
[[nodiscard]] Result<void> checkOutputs(const std::vector<NamedPath>& outputs, const std::vector<NamedPath>& inputs);
/// Sets whether checkOutputs() refuses existing files: without --force.
void keepExisting(bool keep) noexcept;
/// Returns true if a path that checkOutputs() accepted is a file.
[[nodiscard]] bool writesFiles() noexcept;

} // namespace voxtact::app
