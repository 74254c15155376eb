// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/options/open_session.h"
#include "cli/options/output_paths.h"
#include "cli/version.h"
#include "core/base/try.h"
#include "voxtact/detector.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace voxtact::app {

namespace {

constexpr const char* kDevicesFooter =
    R"(Output: one row per device and counting method
  index,name,type,api,driver,subgroup_size
  default     1: used without --device
  available   1: the device supports the method
  trusted     1: the self-test passed
  verdict     result of the self-test, or the missing feature

Example:
  voxtact devices --format text)";

const std::vector<std::string> kColumns{"index",   "name",   "type",      "api",     "driver", "subgroup_size",
                                        "default", "method", "available", "trusted", "verdict"};

struct DevicesOptions {
    DeviceChoice device;
    OutputOptions output;
};

struct DeviceRow {
    device::PhysicalDevice device;
    bool standard = false;
    std::optional<SelfTestVerdict> verdict; ///< empty: the device is unusable
    std::string reason;                     ///< why the device is unusable
};

Result<std::vector<SelfTestVerdict>> judge(const device::VulkanInstance& instance,
                                           const device::PhysicalDevice& physical, const DeviceChoice& choice) {
    const Result<device::Session> session =
        device::openSessionOn(instance, physical, pipelineStore(choice, physical), nullptr);
    VOXTACT_TRY(session);
    Result<std::vector<SelfTestVerdict>> verdicts = selfTest(session->context, session->device.queueAccess());
    VOXTACT_TRY(verdicts);
    verdicts->push_back({CountingMethod::Cpu, true, true, "the host engine"});
    return verdicts;
}

Result<std::vector<DeviceRow>> listDevices(const device::VulkanInstance& instance, const DeviceChoice& choice) {
    const Result<std::vector<device::PhysicalDevice>> devices = instance.devices();
    VOXTACT_TRY(devices);
    const Result<device::PhysicalDevice> standard = device::chooseDevice(*devices, "");
    const Result<device::PhysicalDevice> chosen = device::chooseDevice(*devices, choice.wanted);
    VOXTACT_TRY(chosen);
    std::vector<DeviceRow> rows;
    for (const device::PhysicalDevice& device : *devices) {
        if (!choice.wanted.empty() && device.index != chosen->index) {
            continue;
        }
        const bool isStandard = device.index == standard->index;
        const Result<std::vector<SelfTestVerdict>> verdicts = judge(instance, device, choice);
        if (!verdicts.ok()) {
            rows.push_back({device, isStandard, std::nullopt, verdicts.error().text});
            continue;
        }
        for (const SelfTestVerdict& verdict : *verdicts) {
            rows.push_back({device, isStandard, verdict, {}});
        }
    }
    return rows;
}

io::Cell cellOf(const DeviceRow& row, std::size_t column) {
    const auto flag = [](bool on) { return std::uint64_t{on ? 1U : 0U}; };
    switch (column) {
    case 0:
        return std::uint64_t{row.device.index};
    case 1:
        return row.device.name;
    case 2:
        return std::string(device::deviceTypeName(row.device.type));
    case 3:
        return device::apiVersionText(row.device.apiVersion);
    case 4:
        return row.device.driver;
    case 5:
        return std::uint64_t{row.device.subgroupSize};
    case 6:
        return flag(row.standard);
    case 7:
        return row.verdict ? io::Cell(std::string(toString(row.verdict->method))) : io::Cell();
    case 8:
        return flag(row.verdict && row.verdict->available);
    case 9:
        return flag(row.verdict && row.verdict->trusted);
    default:
        return row.verdict ? row.verdict->text : row.reason;
    }
}

Outcome runDevices(const DevicesOptions& options) {
    if (const Result<void> writable = checkOutputs({{"--output", options.output.path}}, {}); !writable.ok()) {
        return writable.error();
    }
    std::vector<DeviceRow> rows;
    std::shared_ptr<const device::ValidationMessages> messages;
    {
        const Result<device::VulkanInstance> instance =
            device::VulkanInstance::create({.validate = options.device.validate});
        VOXTACT_TRY(instance);
        messages = instance->messages();
        Result<std::vector<DeviceRow>> listed = listDevices(*instance, options.device);
        VOXTACT_TRY(listed);
        rows = std::move(*listed);
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    io::Table table;
    table.columns = kColumns;
    table.rows = rows.size();
    table.cell = [&](std::size_t row, std::size_t column) { return cellOf(rows[row], column); };
    table.facts = {{"voxtact", programVersion()}};
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        io::writeTable(out, options.output.format(), table);
        return {};
    });
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace

Command addDevices(CLI::App& program) {
    auto options = std::make_shared<DevicesOptions>();
    CLI::App* parser = program.add_subcommand("devices", "list Vulkan devices and their counting methods");
    parser->footer(kDevicesFooter);
    addDeviceOptions(*parser, options->device);
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runDevices(*options); }};
}

} // namespace voxtact::app
