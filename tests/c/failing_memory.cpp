// SPDX-License-Identifier: MIT
// The program's operator new, which fails on demand. A file of its own: compilers that see through it complain.
#include "failing_memory.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

/// Allocations until one fails; below 0 none does.
std::atomic<std::int64_t> untilFailure{-1};
/// All that follow fail too.
std::atomic<bool> forGood{false};
std::atomic<std::uint64_t> failed{0};

void* allocate(std::size_t size, std::size_t alignment) {
    std::int64_t left = untilFailure.load();
    while (left >= 0 && !untilFailure.compare_exchange_weak(left, left == 0 && forGood.load() ? 0 : left - 1)) {
    }
    if (left == 0) {
        ++failed;
        throw std::bad_alloc();
    }
    const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
    void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

} // namespace

void* operator new(std::size_t size) {
    return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace voxtact::test {

FailingMemory::FailingMemory(std::int64_t number, bool all) {
    failed = 0;
    forGood = all;
    untilFailure = number;
}

void FailingMemory::end() const {
    untilFailure = -1;
}

std::uint64_t FailingMemory::failures() const {
    return failed;
}

} // namespace voxtact::test
