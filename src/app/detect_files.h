// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect_run.h"

#include <iosfwd>

/// The files of `voxtact detect` beside its table.
namespace voxtact::app {

/// pose,triangle,count; with several meshes or volumes also mesh,volume.
void writeTriangles(std::ostream& out, const DetectOptions& options, const DetectRun& run);
/// pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label; with names of labels also label_name, with several meshes or
/// volumes also mesh,volume. World, mm.
void writeContactsCsv(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const DetectRun& run);
/// The same as points with normals and colours: binary little-endian PLY, in the order of the CSV. mesh and volume are
/// numbers, which comments name.
void writeContactsPly(std::ostream& out, const DetectOptions& options, const DetectRun& run);

} // namespace voxtact::app
