// SPDX-License-Identifier: MIT
#include "cli/output/interrupt.h"

#include <array>
#include <csignal>

namespace voxtact::app {

namespace {

struct Signal {
    int number;
    const char* name;
};

constexpr std::array<Signal, 3> kSignals{{{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}};
constexpr int kSignalStatus = 128;

volatile std::sig_atomic_t caught = 0;
std::atomic<bool> flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler of signals may set it");

extern "C" void noteSignal(int number) {
    caught = number;
    flag = true;
}

} // namespace

InterruptGuard::InterruptGuard() noexcept {
    caught = 0;
    flag = false;
    for (const Signal& signal : kSignals) {
        struct sigaction old {};
        // Signals that the caller ignores (nohup, a background job) stay ignored.
        if (::sigaction(signal.number, nullptr, &old) == 0 && old.sa_handler == SIG_DFL) {
            struct sigaction action {};
            action.sa_handler = noteSignal;
            action.sa_flags = static_cast<int>(SA_RESETHAND); // no SA_RESTART: interrupts a read from standard input
            ::sigemptyset(&action.sa_mask);
            ::sigaction(signal.number, &action, nullptr);
        }
    }
}

InterruptGuard::~InterruptGuard() {
    for (const Signal& signal : kSignals) {
        struct sigaction current {};
        if (::sigaction(signal.number, nullptr, &current) == 0 && current.sa_handler == noteSignal) {
            std::signal(signal.number, SIG_DFL);
        }
    }
}

bool interrupted() noexcept {
    return caught != 0;
}

const std::atomic<bool>& interruptFlag() noexcept {
    return flag;
}

Outcome interruptOutcome(const std::string& what) {
    std::string name = "a signal";
    for (const Signal& signal : kSignals) {
        name = signal.number == caught ? signal.name : name;
    }
    return {kSignalStatus + static_cast<int>(caught), "interrupted by " + name + ": " + what};
}

} // namespace voxtact::app
