// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "vulkan/own/session.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace voxtact::lab {

/// Provenance of the numbers: machine and command.
struct Provenance {
    std::string version;
    std::string gitRevision;
    std::string command;
};

/// Progress of long work.
struct Steps {
    std::function<void(std::uint64_t total)> begin;     ///< before the first
    std::function<void(std::uint64_t steps)> step;      ///< called with the number of steps done since the last call
    std::function<void(const std::string& what)> doing; ///< what the following steps are
};

/// The machine of the numbers.
struct Machine {
    Provenance provenance;
    std::string device;
    std::string deviceType;
    std::string driver;
    std::string driverVersion;
    std::string api;
    std::string cpu;
    std::uint32_t cpuThreads = 0;
    std::string filter;             ///< the arithmetic of the hardware filter, in words
    double filterError = 0;         ///< by which it is off, in stored units, in addition to its weights
    std::vector<std::string> notes; ///< notes on the times
};

/// Without a device.
[[nodiscard]] Machine describeHost(const Provenance& provenance);
[[nodiscard]] Machine describeMachine(const device::Session& session, ScalarType type, const Provenance& provenance);
/// When all is measured: a note where the device's clock has failed meanwhile.
void noteMissedTimes(const device::Session& session, std::vector<std::string>& notes);

} // namespace voxtact::lab
