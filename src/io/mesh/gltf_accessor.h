// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/gltf_document.h"

#include <array>

namespace voxtact::io {

/// Purpose of an accessor; selects the types that it may have.
enum class GltfUse {
    Positions,     ///< VEC3 of floats; with KHR_mesh_quantization also of whole numbers
    Displacements, ///< of morph targets: the same, whole numbers with a sign
    Indices,       ///< SCALAR of whole numbers without a sign
    Joints,        ///< VEC4 of whole numbers without a sign
    Weights,       ///< VEC4 of floats, or of normalised whole numbers
    Matrices       ///< MAT4 of floats
};

/// The elements of an accessor, sparse or not, read where they lie; everything is checked when it is made. The document
/// must outlive it.
class GltfAccessor {
  public:
    GltfAccessor(GltfDocument& document, std::uint64_t index, GltfUse use);

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// A component of an element that exists.
    [[nodiscard]] double number(std::uint64_t element, std::size_t component) const;
    [[nodiscard]] std::uint32_t natural(std::uint64_t element, std::size_t component) const;
    [[nodiscard]] Vec3 vector(std::uint64_t element) const;
    [[nodiscard]] Mat4 matrix(std::uint64_t element) const;
    /// True where all elements have memory of their own in the file.
    [[nodiscard]] bool isStored() const noexcept { return !base_.empty(); }

  private:
    void takeType(const GltfDocument& document, const GltfJson& json, GltfUse use);
    void takeBase(GltfDocument& document, const GltfJson& json);
    void takeSparse(GltfDocument& document, const GltfJson& json);
    /// The bytes of the element; none: it is zero.
    [[nodiscard]] const char* find(std::uint64_t element) const;
    [[nodiscard]] std::uint64_t sparseIndex(std::uint64_t i) const;

    std::string name_;
    std::uint64_t componentType_ = 0;
    std::size_t componentBytes_ = 0;
    std::size_t components_ = 0;
    bool normalised_ = false;
    std::uint64_t count_ = 0;
    std::string_view base_;
    std::uint64_t stride_ = 0;
    std::uint64_t sparseCount_ = 0;
    std::uint64_t sparseType_ = 0;
    std::string_view sparseIndices_;
    std::string_view sparseValues_;
};

} // namespace voxtact::io
