// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>

namespace voxtact::step {

/// How far a triangulation is from the faces that it stands for.
struct Deflection {
    double bound = 0;      ///< mm: no point of a face is farther from the triangles
    int unprovenFaces = 0; ///< whose share of the bound is twice the largest of some samples
};

/// Of a shape whose faces are all triangulated. `wanted`, mm: a tenth of it may be lost to bounds that are not sharp.
///
/// The distance from a triangle is sampled on the part of the surface that has its parameters, and what it can be
/// between the samples follows from bounds of the second derivatives. At the boundary, the region between an edge and
/// its chords is added. A face counts as proven if its triangles cover just what its chords enclose: if these are their
/// boundary, and no triangle is turned. A face ends at its curves of parameters; those in space may be off by a
/// tolerance.
[[nodiscard]] Deflection deflectionOf(const TopoDS_Shape& shape, double wanted);

} // namespace voxtact::step
