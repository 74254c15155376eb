// SPDX-License-Identifier: MIT
#include "io/mesh/gltf_accessor.h"

#include "io/byte_source.h"

#include <algorithm>

namespace voxtact::io {

namespace {

constexpr std::uint64_t kByte = 5120;
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kShort = 5122;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;

/// Returns 0 for an unknown type.
std::size_t bytesOf(std::uint64_t componentType) {
    switch (componentType) {
    case kByte:
    case kUnsignedByte:
        return 1;
    case kShort:
    case kUnsignedShort:
        return 2;
    case kUnsignedInt:
    case kFloat:
        return 4;
    default:
        return 0;
    }
}

bool allows(GltfUse use, std::uint64_t type, bool normalised, bool quantised) {
    const bool isUnsigned = type == kUnsignedByte || type == kUnsignedShort;
    const bool isSigned = type == kByte || type == kShort;
    switch (use) {
    case GltfUse::Positions:
        return type == kFloat || (quantised && (isUnsigned || isSigned));
    case GltfUse::Displacements:
        return type == kFloat || (quantised && isSigned);
    case GltfUse::Indices:
        return (isUnsigned || type == kUnsignedInt) && !normalised;
    case GltfUse::Joints:
        return isUnsigned && !normalised;
    case GltfUse::Weights:
        return type == kFloat || (isUnsigned && normalised);
    case GltfUse::Matrices:
        return type == kFloat;
    }
    return false;
}

std::uint32_t naturalAt(std::string_view bytes, std::size_t offset, std::uint64_t type) {
    return type == kUnsignedByte    ? numberAt<std::uint8_t>(bytes, offset)
           : type == kUnsignedShort ? numberAt<std::uint16_t>(bytes, offset)
                                    : numberAt<std::uint32_t>(bytes, offset);
}

/// True where `count` elements of `bytes` bytes fit, `stride` apart.
bool fits(std::string_view memory, std::uint64_t count, std::uint64_t stride, std::uint64_t bytes) {
    return count == 0 || (bytes <= memory.size() && (count - 1) <= (memory.size() - bytes) / stride);
}

} // namespace

GltfAccessor::GltfAccessor(GltfDocument& document, std::uint64_t index, GltfUse use)
    : name_("accessor " + std::to_string(index)) {
    const GltfJson& json = document.item("accessors", index);
    takeType(document, json, use);
    count_ = neededNatural(json, "count");
    if (count_ == 0) {
        throw GltfRefusal{name_ + " has no elements"};
    }
    const bool hasView = member(json, "bufferView") != nullptr;
    if (!hasView && member(json, "sparse") == nullptr) {
        throw GltfRefusal{name_ + " has no data (compressed by an extension?)"};
    }
    if (hasView) {
        takeBase(document, json);
    }
    if (member(json, "sparse") != nullptr) {
        takeSparse(document, json);
    }
}

void GltfAccessor::takeType(const GltfDocument& document, const GltfJson& json, GltfUse use) {
    const bool isVec4 = use == GltfUse::Joints || use == GltfUse::Weights;
    const char* const type = use == GltfUse::Indices    ? "SCALAR"
                             : use == GltfUse::Matrices ? "MAT4"
                             : isVec4                   ? "VEC4"
                                                        : "VEC3";
    components_ = use == GltfUse::Indices ? 1 : use == GltfUse::Matrices ? 16 : isVec4 ? 4 : 3;
    componentType_ = neededNatural(json, "componentType");
    componentBytes_ = bytesOf(componentType_);
    normalised_ = flag(json, "normalized");
    if (componentBytes_ == 0 || textOf(json, "type") != type ||
        !allows(use, componentType_, normalised_, document.uses("KHR_mesh_quantization"))) {
        throw GltfRefusal{name_ + " is of a type that what it is used for cannot have"};
    }
}

void GltfAccessor::takeBase(GltfDocument& document, const GltfJson& json) {
    const std::uint64_t index = neededNatural(json, "bufferView");
    const std::string_view view = document.view(index);
    const std::uint64_t offset = io::natural(json, "byteOffset", 0);
    const std::size_t bytes = componentBytes_ * components_;
    stride_ = io::natural(document.item("bufferViews", index), "byteStride", bytes);
    constexpr std::uint64_t kMostStride = 4096;
    if (stride_ < bytes || stride_ > kMostStride) {
        throw GltfRefusal{name_ + " has elements that overlap, or lie too far apart"};
    }
    if (offset > view.size() || !fits(view.substr(offset), count_, stride_, bytes)) {
        throw GltfRefusal{name_ + " reaches beyond its buffer"};
    }
    base_ = view.substr(offset);
}

void GltfAccessor::takeSparse(GltfDocument& document, const GltfJson& json) {
    const GltfJson& sparse = *member(json, "sparse");
    const GltfJson* const indices = member(sparse, "indices");
    const GltfJson* const values = member(sparse, "values");
    if (indices == nullptr || values == nullptr) {
        throw GltfRefusal{name_ + " is sparse and has no indices or values"};
    }
    sparseCount_ = neededNatural(sparse, "count");
    sparseType_ = neededNatural(*indices, "componentType");
    if (!allows(GltfUse::Indices, sparseType_, false, false)) {
        throw GltfRefusal{name_ + " is sparse and its indices are not whole numbers"};
    }
    const auto memory = [&](const GltfJson& part, std::size_t bytes) {
        const std::string_view view = document.view(neededNatural(part, "bufferView"));
        const std::uint64_t offset = io::natural(part, "byteOffset", 0);
        if (offset > view.size() || !fits(view.substr(offset), sparseCount_, bytes, bytes)) {
            throw GltfRefusal{name_ + " reaches beyond its buffer"};
        }
        return view.substr(offset);
    };
    sparseIndices_ = memory(*indices, bytesOf(sparseType_));
    sparseValues_ = memory(*values, componentBytes_ * components_);
    for (std::uint64_t i = 0; i < sparseCount_; ++i) {
        if (sparseIndex(i) >= count_ || (i > 0 && sparseIndex(i) <= sparseIndex(i - 1))) {
            throw GltfRefusal{name_ + " is sparse and its indices do not ascend, or are out of range"};
        }
    }
}

std::uint64_t GltfAccessor::sparseIndex(std::uint64_t i) const {
    return naturalAt(sparseIndices_, i * bytesOf(sparseType_), sparseType_);
}

const char* GltfAccessor::find(std::uint64_t element) const {
    std::uint64_t low = 0;
    std::uint64_t high = sparseCount_;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (sparseIndex(middle) < element) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if (low < sparseCount_ && sparseIndex(low) == element) {
        return sparseValues_.data() + low * componentBytes_ * components_;
    }
    return base_.empty() ? nullptr : base_.data() + element * stride_;
}

double GltfAccessor::number(std::uint64_t element, std::size_t component) const {
    const char* const begin = find(element);
    if (begin == nullptr) {
        return 0;
    }
    const std::string_view bytes(begin + component * componentBytes_, componentBytes_);
    // By the specification, 0 and 1, or -1 and 1, are reached exactly.
    switch (componentType_) {
    case kByte:
        return normalised_ ? std::max(numberAt<std::int8_t>(bytes, 0) / 127.0, -1.0) : numberAt<std::int8_t>(bytes, 0);
    case kUnsignedByte:
        return numberAt<std::uint8_t>(bytes, 0) / (normalised_ ? 255.0 : 1.0);
    case kShort:
        return normalised_ ? std::max(numberAt<std::int16_t>(bytes, 0) / 32767.0, -1.0)
                           : numberAt<std::int16_t>(bytes, 0);
    case kUnsignedShort:
        return numberAt<std::uint16_t>(bytes, 0) / (normalised_ ? 65535.0 : 1.0);
    case kUnsignedInt:
        return numberAt<std::uint32_t>(bytes, 0);
    default:
        return static_cast<double>(numberAt<float>(bytes, 0));
    }
}

std::uint32_t GltfAccessor::natural(std::uint64_t element, std::size_t component) const {
    const char* const begin = find(element);
    const std::string_view bytes(begin, begin == nullptr ? 0 : componentBytes_ * components_);
    return begin == nullptr ? 0 : naturalAt(bytes, component * componentBytes_, componentType_);
}

Vec3 GltfAccessor::vector(std::uint64_t element) const {
    return {number(element, 0), number(element, 1), number(element, 2)};
}

Mat4 GltfAccessor::matrix(std::uint64_t element) const {
    Mat4 matrix{};
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        matrix[i] = number(element, i);
    }
    return matrix;
}

} // namespace voxtact::io
