// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/shared_options.h"

#include <filesystem>
#include <string>
#include <vector>

/// What a command writes must be nothing that it reads: found out before any work is done.
namespace voxtact::app {

/// A path, and the option that names it: "--output".
struct NamedPath {
    std::string option;
    std::filesystem::path path;
};

/// Adds a file or folder that is read; builtins, standard input and empty paths are none.
void addInput(std::vector<NamedPath>& inputs, const char* option, const std::filesystem::path& path);
/// The files and folders that the options read.
[[nodiscard]] std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes);
[[nodiscard]] std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes,
                                                const TransferFunctionOptions& transferFunction,
                                                const ViewOptions& view);

/// Refuses outputs that cannot be written, two that are one file, and one that is an input by whatever name: a
/// link, another spelling, a file of a DICOM folder, the file of voxels or buffers that a header names. Empty paths are
/// not looked at.
[[nodiscard]] Result<void> checkOutputs(const std::vector<NamedPath>& outputs, const std::vector<NamedPath>& inputs);

} // namespace voxtact::app
