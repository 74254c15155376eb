// SPDX-License-Identifier: MIT
#include "bench/measure/machine.h"

#include "oracle/oracle.h"
#include "vulkan/own/timed_commands.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace voxtact::lab {

namespace {

std::string cpuName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
            return line.substr(line.find(": ") + 2);
        }
    }
    return "unknown";
}

/// Fills the driver's properties.
VkDriverId describeDriver(const device::Session& session, Machine& machine) {
    const auto getProperties =
        device::instanceFunction<PFN_vkGetPhysicalDeviceProperties2>(session, "vkGetPhysicalDeviceProperties2");
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    getProperties(session.device.physical().handle, &properties);
    machine.driver = driver.driverName;
    machine.driverVersion = driver.driverInfo;
    return driver.driverID;
}

bool floatFilterForced() {
    const char* const tuning = std::getenv("GALLIVM_PERF");
    return tuning != nullptr && std::string_view(tuning).find("no_aos_sampling") != std::string_view::npos;
}

/// NVIDIA's GH100, of which all cards have device numbers from 0x2300 on.
bool isHopper(const device::PhysicalDevice& physical) {
    return physical.vendor == 0x10DE && (physical.deviceId & 0xFF00U) == 0x2300U;
}

} // namespace

Machine describeHost(const Provenance& provenance) {
    Machine machine;
    machine.provenance = provenance;
    machine.cpu = cpuName();
    machine.cpuThreads = std::max(1U, std::thread::hardware_concurrency());
    return machine;
}

Machine describeMachine(const device::Session& session, ScalarType type, const Provenance& provenance) {
    const device::PhysicalDevice& physical = session.device.physical();
    Machine machine = describeHost(provenance);
    machine.device = physical.name;
    machine.deviceType = device::deviceTypeName(physical.type);
    machine.api = device::apiVersionText(physical.apiVersion);
    const bool llvmpipe = describeDriver(session, machine) == VK_DRIVER_ID_MESA_LLVMPIPE;
    const bool inEightBits = llvmpipe && type == ScalarType::UInt8 && !floatFilterForced();
    machine.filterError = inEightBits ? oracle::kEightBitFilterError : 0;
    machine.filter =
        inEightBits ? "llvmpipe filters a uint8 volume in 8-bit arithmetic (GALLIVM_PERF=no_aos_sampling: in float)"
        : llvmpipe  ? "llvmpipe filters this volume in float"
                    : "the device's sampler; its weights may have as few as 8 fraction bits";
    if (llvmpipe) {
        machine.notes.emplace_back("llvmpipe is a rasteriser on the CPU: the methods of the device and cpu share the "
                                   "same cores");
        machine.notes.emplace_back(
            "a query counts one draw, so query and query-any split a batch into one draw per pair; "
            "atomic and subgroup draw a batch at once");
    }
    if (isHopper(physical)) {
        machine.notes.emplace_back("on this GPU only two TPCs (4 of 132 multiprocessors) run vertex and fragment "
                                   "shaders: query, query-any, atomic and subgroup use a small part of the GPU, "
                                   "compute uses all of it");
    }
    if (!session.device.hasTimestamps()) {
        machine.notes.emplace_back("the queue has no timestamps: no GPU times");
    }
    return machine;
}

void noteMissedTimes(const device::Session& session, std::vector<std::string>& notes) {
    if (session.device.missedTimestamps()) {
        notes.emplace_back("timestamps of the device went backwards, or did not move: those samples have no GPU time");
    }
}

} // namespace voxtact::lab
