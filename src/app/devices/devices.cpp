// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/detect/auto_method.h"
#include "app/options/open_session.h"
#include "app/options/output_paths.h"
#include "app/version.h"
#include "core/base/try.h"
#include "voxtact/detector.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace voxtact::app {

namespace {

constexpr const char* kDevicesFooter =
    R"(One row a device and counting method, cpu (the host) among them; one row, without a method, for a device that
cannot be used. Columns:
  index,name,type,api,driver   the device; subgroup_size: invocations in a subgroup
  default                      1: what a command takes without --device
  method                       the counting method
  available,trusted            the device can do it; and it counted a known number of fragments right, and its
                               arithmetic is the host's where exactness rests on it (self-test)
  verdict                      what the self-test counted and compared, or why the method cannot be used
  pairs_per_s                  on a small scene; measured once and remembered, see --cache
  auto                         1: what --count auto takes on this device but in the projection conservative

Example:
  voxtact devices --format text)";

const std::vector<std::string> kColumns{"index",         "name",        "type",   "api",       "driver",
                                        "subgroup_size", "default",     "method", "available", "trusted",
                                        "verdict",       "pairs_per_s", "auto"};

struct DevicesOptions {
    DeviceChoice device;
    OutputOptions output;
};

struct DeviceRow {
    device::PhysicalDevice device;
    bool standard = false;
    std::optional<MethodSpeed> speed; ///< nothing: the device cannot be used
    std::string reason;               ///< why not
    bool chosen = false;
};

/// What is known of each method, and which one --count auto takes.
struct Judgement {
    std::vector<MethodSpeed> speeds;
    std::optional<CountingMethod> chosen;
};

/// The self-test is run each time, since it is what this command is asked for; speeds are remembered.
Result<Judgement> judge(const device::VulkanInstance& instance, const device::PhysicalDevice& physical,
                        const DeviceChoice& choice) {
    const Result<device::Session> session =
        device::openSessionOn(instance, physical, pipelineStore(choice, physical), nullptr);
    VOXTACT_TRY(session);
    Result<MeasuredMethods> measured = measuredMethods(*session, std::nullopt, choice);
    VOXTACT_TRY(measured);
    if (!measured->fresh) {
        const Result<std::vector<SelfTestVerdict>> verdicts = selfTest(session->context, session->device.queueAccess());
        VOXTACT_TRY(verdicts);
        // The device's methods come first, in the order of its verdicts.
        std::transform(verdicts->begin(), verdicts->end(), measured->speeds.begin(), measured->speeds.begin(),
                       [](const SelfTestVerdict& verdict, const MethodSpeed& speed) {
                           return MethodSpeed{verdict, speed.pairsPerSecond};
                       });
    }
    const auto chosen = fastest(measured->speeds, {}, session->context.maxViewport());
    return Judgement{std::move(measured->speeds), chosen};
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
        const Result<Judgement> judgement = judge(instance, device, choice);
        if (!judgement.ok()) {
            rows.push_back({device, isStandard, std::nullopt, judgement.error().text, false});
            continue;
        }
        for (const MethodSpeed& speed : judgement->speeds) {
            rows.push_back({device, isStandard, speed, {}, speed.verdict.method == judgement->chosen});
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
        return row.speed ? io::Cell(std::string(toString(row.speed->verdict.method))) : io::Cell();
    case 8:
        return flag(row.speed && row.speed->verdict.available);
    case 9:
        return flag(row.speed && row.speed->verdict.trusted);
    case 10:
        return row.speed ? row.speed->verdict.text : row.reason;
    case 11:
        return row.speed && row.speed->pairsPerSecond > 0 ? io::Cell(std::round(row.speed->pairsPerSecond))
                                                          : io::Cell();
    default:
        return flag(row.chosen);
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
    CLI::App* parser = program.add_subcommand("devices", "what devices there are and which methods each can do");
    parser->footer(kDevicesFooter);
    addDeviceOptions(*parser, options->device);
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runDevices(*options); }};
}

} // namespace voxtact::app
