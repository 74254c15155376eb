// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>

#include <stdexcept>
#include <string>
#include <vector>

namespace voxtact::step {

/// Why a file cannot be used: a clause, in one line.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The shapes of a file, in millimetres.
struct CadShape {
    TopoDS_Shape shape;
    std::vector<std::string> notes;
};

/// By the ending: IGES if it begins with .ig, else STEP. Throws Refusal, and what OpenCASCADE throws.
[[nodiscard]] CadShape readShape(const std::string& path);

} // namespace voxtact::step
