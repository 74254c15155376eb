// SPDX-License-Identifier: MIT
#include "c/structs.h"

namespace voxtact::c {

void checkStructSize(std::size_t size, std::size_t alignment, const char* what) {
    if (size < sizeof(std::size_t) || size > kLargestStruct || size % alignment != 0) {
        refuse(ErrorCode::InvalidArgument, std::string(what) + ": struct_size is " + std::to_string(size) +
                                               ", not the size of a struct; set it to its sizeof");
    }
}

void checkUnknownMembers(const std::byte* begin, const std::byte* end, const char* what) {
    if (std::any_of(begin, end, [](std::byte value) { return value != std::byte{0}; })) {
        refuse(ErrorCode::Unsupported, std::string(what) + " has members that are set and that voxtact " +
                                           vxt_version() +
                                           " does not know; leave them 0, or use the library of that header");
    }
}

} // namespace voxtact::c
