// SPDX-License-Identifier: MIT
#include "child.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace voxtact::test {

namespace {

constexpr int kPatience = 120000; // milliseconds; machines may be busy

std::array<int, 2> makePipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error("no pipe");
    }
    return ends;
}

} // namespace

Child::Child(const Arguments& arguments, std::uint64_t longestFile) : errors_(std::tmpfile()) {
    const std::array<int, 2> in = makePipe();
    const std::array<int, 2> out = makePipe();
    if (errors_ == nullptr) {
        throw std::runtime_error("no temporary file");
    }
    std::vector<std::string> words{VOXTACT_PROGRAM};
    const Arguments all = withForce(arguments);
    words.insert(words.end(), all.begin(), all.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
        ::dup2(in[0], STDIN_FILENO);
        ::dup2(out[1], STDOUT_FILENO);
        ::dup2(::fileno(errors_), STDERR_FILENO);
        std::signal(SIGINT, SIG_DFL); // a runner in the background may have it ignored
        if (longestFile > 0) {
            const rlimit limit{longestFile, longestFile};
            ::setrlimit(RLIMIT_FSIZE, &limit);
        }
        setCaches();
        ::execv(VOXTACT_PROGRAM, pointers.data());
        ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    input_ = in[1];
    output_ = out[0];
    std::signal(SIGPIPE, SIG_IGN);
}

Child::~Child() {
    closeInput();
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    ::close(output_);
    static_cast<void>(std::fclose(errors_));
}

void Child::write(const std::string& text) const {
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t written = ::write(input_, text.data() + at, text.size() - at);
        if (written <= 0) {
            throw std::runtime_error("the program does not read");
        }
        at += static_cast<std::size_t>(written);
    }
}

void Child::closeInput() {
    if (input_ >= 0) {
        ::close(input_);
        input_ = -1;
    }
}

bool Child::readSome(int milliseconds) {
    pollfd ready{output_, POLLIN, 0};
    std::array<char, 65536> part{};
    if (::poll(&ready, 1, milliseconds) != 1) {
        return false;
    }
    const ssize_t got = ::read(output_, part.data(), part.size());
    text_.append(part.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    return got > 0;
}

std::vector<std::string> Child::lines(std::size_t count) {
    while (static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')) < count && readSome(kPatience)) {
    }
    return linesOf(text_);
}

void Child::signal(int number) const {
    ::kill(process_, number);
}

Ran Child::end() {
    while (readSome(kPatience)) {
    }
    int state = 0;
    rusage usage{};
    ::wait4(process_, &state, 0, &usage);
    process_ = -1;
    mostMemory_ = usage.ru_maxrss;
    Ran ran;
    ran.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    ran.out = text_;
    std::rewind(errors_);
    std::array<char, 4096> part{};
    while (const std::size_t got = std::fread(part.data(), 1, part.size(), errors_)) {
        ran.err.append(part.data(), got);
    }
    return ran;
}

} // namespace voxtact::test
