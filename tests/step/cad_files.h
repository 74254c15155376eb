// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <TopoDS_Shape.hxx>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace voxtact::test {

/// A shape whose surface is known without OpenCASCADE's triangulation.
struct CadCase {
    std::string name;
    TopoDS_Shape shape;
    std::vector<Vec3> samples;                ///< points of the surface
    std::function<double(const Vec3&)> off{}; ///< distance of a point from the surface; empty: not known in closed form
};

/// A cylinder, cone, sphere and torus, with samples in closed form; two B-spline patches, one rational, and a pierced
/// cylinder as it is and as NURBS, sampled where the faces are.
[[nodiscard]] std::vector<CadCase> cadCases();
[[nodiscard]] CadCase sphereCase(double radius);

/// By the ending, in millimetres or inches.
void writeCad(const std::filesystem::path& path, const TopoDS_Shape& shape, bool inches = false);

} // namespace voxtact::test
