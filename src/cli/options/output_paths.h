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

/// A file or folder of volumes as the user names it: its path, and behind a '#' which of its images is meant (a frame,
/// the UID of a series). A path that is there as it stands has no such part.
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

/// Files that a header (.hdr, .nhdr, .mhd, .gltf) may refer to in its folder, and that need not be there; no
/// format is read strictly.
[[nodiscard]] Result<std::vector<std::filesystem::path>> filesNamedIn(const std::filesystem::path& header);

/// Refuses outputs that cannot be written, two that are one file or standard output ("-"), one that is an input by
/// whatever name: a link, another spelling, a file of a DICOM folder, the file of voxels or buffers that a header
/// names; and, after keepExisting(true), one that exists. Empty paths are not examined.
[[nodiscard]] Result<void> checkOutputs(const std::vector<NamedPath>& outputs, const std::vector<NamedPath>& inputs);
/// Sets whether checkOutputs() refuses existing files: without --force.
void keepExisting(bool keep) noexcept;
/// Returns true if a path that checkOutputs() accepted is a file.
[[nodiscard]] bool writesFiles() noexcept;

} // namespace voxtact::app
