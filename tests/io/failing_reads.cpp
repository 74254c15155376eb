// SPDX-License-Identifier: MIT
// With it, <unistd.h> has a body for read().
#undef _FORTIFY_SOURCE
#include "failing_reads.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/syscall.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

struct Failing {
    std::string folder;
    std::atomic<std::int64_t> left = 0; ///< reads until one fails
    std::atomic<std::int64_t> failures = 0;
    bool forGood = false;
};

std::atomic<Failing*> failing = nullptr;
std::atomic<bool> noLinks = false;

bool isIn(int file, std::string_view folder) {
    std::array<char, 4096> target{};
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    const ssize_t length = ::readlink(link.c_str(), target.data(), target.size());
    return length > 0 && std::string_view(target.data(), static_cast<std::size_t>(length)).starts_with(folder);
}

} // namespace

FailingReads::FailingReads(std::filesystem::path folder, std::int64_t number, bool forGood) {
    auto* const begun = new Failing;
    begun->folder = std::filesystem::canonical(folder).string() + "/";
    begun->left = number;
    begun->forGood = forGood;
    failing = begun;
}

FailingReads::~FailingReads() {
    delete failing.exchange(nullptr);
}

std::int64_t FailingReads::failures() const {
    return failing.load()->failures;
}

FailingLinks::FailingLinks() {
    noLinks = true;
}

FailingLinks::~FailingLinks() {
    noLinks = false;
}

} // namespace voxtact::test

extern "C" __attribute__((visibility("default"))) int link(const char* from, const char* to) noexcept {
    if (voxtact::test::noLinks) {
        errno = EPERM;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}

/// Stands in for that of the C library, which the streams of the standard library call.
extern "C" __attribute__((visibility("default"))) ssize_t read(int file, void* to, std::size_t bytes) {
    voxtact::test::Failing* const now = voxtact::test::failing;
    if (now != nullptr && voxtact::test::isIn(file, now->folder)) {
        const std::int64_t left = now->left--;
        if (left == 0 || (left < 0 && now->forGood)) {
            ++now->failures;
            errno = EIO;
            return -1;
        }
    }
    return ::syscall(SYS_read, file, to, bytes);
}
