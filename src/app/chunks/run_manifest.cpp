// SPDX-License-Identifier: MIT
#include "app/chunks/run_manifest.h"

#include "app/chunks/content_hash.h"

#include <nlohmann/json.hpp>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kManifestFormat = 2;
constexpr const char* kFormat = "voxtact_run";
constexpr const char* kCheck = "check";

std::string dump(const Json& json, int indent = -1) {
    // File names may hold any bytes; their hashes tell apart what is replaced here.
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// All but the check.
Json bodyOf(const RunManifest& manifest) {
    Json facts = Json::array();
    for (const auto& [name, value] : manifest.facts) {
        facts.push_back({name, value});
    }
    Json outputs = Json::array();
    for (const RunOutput& output : manifest.outputs) {
        outputs.push_back({{"option", output.option},
                           {"ending", output.ending},
                           {"head", output.head},
                           {"between", output.between},
                           {"tail", output.tail},
                           {"part", output.part},
                           {"targets", output.targets}});
    }
    return {{kFormat, kManifestFormat}, {"chunks", manifest.chunks}, {"facts", facts}, {"outputs", outputs}};
}

/// Of a body that has its check, which text() wrote.
RunManifest manifestOf(const Json& body) {
    RunManifest manifest;
    manifest.chunks = body["chunks"].get<std::uint64_t>();
    for (const Json& fact : body["facts"]) {
        manifest.facts.emplace_back(fact[0].get<std::string>(), fact[1].get<std::string>());
    }
    for (const Json& output : body["outputs"]) {
        manifest.outputs.push_back({output["option"].get<std::string>(), output["ending"].get<std::string>(),
                                    output["head"].get<std::string>(), output["between"].get<std::string>(),
                                    output["tail"].get<std::string>(), output["part"].get<std::string>(),
                                    output["targets"].get<std::vector<std::string>>()});
    }
    return manifest;
}

} // namespace

std::string RunManifest::id() const {
    return hashOf(dump(bodyOf({facts, {}, chunks})));
}

std::vector<const RunOutput*> RunManifest::outputsOf(const std::string& option) const {
    std::vector<const RunOutput*> found;
    for (const RunOutput& output : outputs) {
        if (output.option == option) {
            found.push_back(&output);
        }
    }
    return found;
}

std::string RunManifest::text() const {
    Json body = bodyOf(*this);
    body[kCheck] = hashOf(dump(bodyOf(*this)));
    return dump(body, 1) + "\n";
}

RunManifest RunManifest::asWritten() const {
    return readManifestText(text()).manifest;
}

ReadManifest readManifestText(const std::string& text) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) {
        return {};
    }
    const Json format = json.value(kFormat, Json());
    if (format.is_number_integer() && format != kManifestFormat) {
        return {ManifestState::OfAnotherVersion};
    }
    const Json check = json.value(kCheck, Json());
    json.erase(kCheck);
    if (!check.is_string() || check.get<std::string>() != hashOf(dump(json)) || format != kManifestFormat) {
        return {};
    }
    return {ManifestState::Whole, manifestOf(json)};
}

} // namespace voxtact::app
