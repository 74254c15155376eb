// SPDX-License-Identifier: MIT
#include "app/detect/speed_cache.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <thread>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

/// A home folder may be shared by machines with the same driver: these tell them apart as well as may be.
Json machineOf(const device::PhysicalDevice& device) {
    return {{"device", device.name},
            {"driver", device.driver},
            {"vendor", device.vendor},
            {"device_id", device.deviceId},
            {"processors", std::thread::hardware_concurrency()}};
}

Json toJson(const MethodSpeed& speed) {
    return {{"method", toString(speed.verdict.method)},
            {"available", speed.verdict.available},
            {"trusted", speed.verdict.trusted},
            {"verdict", speed.verdict.text},
            {"pairs_per_s", speed.pairsPerSecond}};
}

/// Throws Json::exception for what is missing or of another type.
std::optional<MethodSpeed> fromJson(const Json& json) {
    const auto method = countingMethodFromName(json.at("method").get<std::string>());
    const auto rate = json.at("pairs_per_s").get<double>();
    if (!method || !std::isfinite(rate) || rate < 0) {
        return std::nullopt;
    }
    return MethodSpeed{{*method, json.at("available").get<bool>(), json.at("trusted").get<bool>(),
                        json.at("verdict").get<std::string>()},
                       rate};
}

} // namespace

SpeedCache::SpeedCache(const CacheFolder& folder, const device::PhysicalDevice& device, const std::string& measured)
    : folder_(folder), device_(device), name_("speeds-" + cacheKey(device) + "-" + measured) {}

std::optional<std::vector<MethodSpeed>> SpeedCache::read() const {
    const std::optional<std::string> text = folder_.read(name_);
    if (!text) {
        return std::nullopt;
    }
    try {
        const Json json = Json::parse(*text);
        if (json.at("machine") != machineOf(device_)) {
            return std::nullopt;
        }
        std::vector<MethodSpeed> speeds;
        for (const Json& entry : json.at("methods")) {
            std::optional<MethodSpeed> speed = fromJson(entry);
            if (!speed) {
                return std::nullopt;
            }
            speeds.push_back(std::move(*speed));
        }
        return speeds;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

void SpeedCache::write(const std::vector<MethodSpeed>& speeds) const {
    Json json{{"machine", machineOf(device_)}, {"methods", Json::array()}};
    for (const MethodSpeed& speed : speeds) {
        json["methods"].push_back(toJson(speed));
    }
    // A driver's texts may hold any bytes.
    folder_.write(name_, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

} // namespace voxtact::app
