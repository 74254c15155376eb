// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

/// Structs of the caller's that begin with their size, which a newer or an older header gave them.
namespace voxtact::c {

/// Larger than any struct will be; a larger size is uninitialised memory.
inline constexpr std::size_t kLargestStruct = 4096;

/// Refuses a size that no header has given to a struct of that kind.
void checkStructSize(std::size_t size, std::size_t alignment, const char* what);
/// Refuses members that this library does not know, unless they are zero: they ask for nothing.
void checkUnknownMembers(const std::byte* begin, const std::byte* end, const char* what);

/// A struct with its size and zeros, which stand for the defaults.
template <class T> T zero() noexcept {
    T out{};
    out.struct_size = sizeof out;
    return out;
}

/// A number of the caller's, where 0 stands for the default.
template <class Number> Number orDefault(Number given, Number standard) noexcept {
    return given == 0 ? standard : given;
}

/// A copy of the caller's struct. Members that it does not have are those of `defaults`.
template <class T> T readStruct(const void* given, const T& defaults, const char* what) {
    static_assert(std::is_trivially_copyable_v<T> && offsetof(T, struct_size) == 0);
    std::size_t size = 0;
    std::memcpy(&size, &need(static_cast<const std::byte*>(given), what), sizeof size);
    checkStructSize(size, alignof(T), what);
    T copy = defaults;
    std::memcpy(&copy, given, std::min(size, sizeof copy));
    const auto* bytes = static_cast<const std::byte*>(given);
    checkUnknownMembers(bytes + std::min(size, sizeof copy), bytes + size, what);
    return copy;
}

/// Like readStruct(), with null for the defaults.
template <class T> T readOptions(const T* given, const T& defaults, const char* what) {
    return given == nullptr ? defaults : readStruct(given, defaults, what);
}

/// Copies of the caller's array, whose structs all have the size of the first.
template <class T> std::vector<T> readStructs(const T* given, std::size_t count, const T& defaults, const char* what) {
    std::vector<T> copies;
    if (count == 0) {
        return copies;
    }
    std::size_t stride = 0;
    std::memcpy(&stride, &need(given, what), sizeof stride);
    const auto* bytes = reinterpret_cast<const std::byte*>(given);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string which = std::string(what) + " " + std::to_string(i);
        std::size_t size = 0;
        std::memcpy(&size, bytes + i * stride, sizeof size);
        if (size != stride) {
            refuse(ErrorCode::InvalidArgument, which + ": struct_size is " + std::to_string(size) + ", that of " +
                                                   what + " 0 is " + std::to_string(stride) +
                                                   "; they must be the same");
        }
        copies.push_back(readStruct<T>(bytes + i * stride, defaults, which.c_str()));
    }
    return copies;
}

/// Fills in a caller's struct up to its size; members unknown to the library become zero.
template <class T> void writeStruct(T* out, T value, const char* what) {
    const std::size_t size = need(out, what).struct_size;
    checkStructSize(size, alignof(T), what);
    value.struct_size = size;
    std::memcpy(out, &value, std::min(size, sizeof value));
    if (size > sizeof value) {
        std::memset(reinterpret_cast<std::byte*>(out) + sizeof value, 0, size - sizeof value);
    }
}

} // namespace voxtact::c
