// SPDX-License-Identifier: MIT
#include "io/mesh/gltf_document.h"

#include <cmath>

namespace voxtact::io {

namespace {

[[noreturn]] void refuseMember(const char* key, const char* what) {
    throw GltfRefusal{std::string("'") + key + "' is not " + what};
}

/// JSON knows one kind of number: 3.0 is 3.
std::optional<std::uint64_t> asNatural(const GltfJson& value) {
    if (value.is_number_unsigned()) {
        return value.get<std::uint64_t>();
    }
    constexpr double kMost = 9007199254740992; // 2^53
    if (value.is_number_float()) {
        const auto number = value.get<double>();
        if (number >= 0 && number <= kMost && number == std::floor(number)) {
            return static_cast<std::uint64_t>(number);
        }
    }
    return std::nullopt;
}

const GltfJson& emptyList() {
    static const GltfJson kNone = GltfJson::array();
    return kNone;
}

} // namespace

const GltfJson* member(const GltfJson& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

std::optional<std::uint64_t> natural(const GltfJson& object, const char* key) {
    const GltfJson* const value = member(object, key);
    if (value == nullptr) {
        return std::nullopt;
    }
    const std::optional<std::uint64_t> number = asNatural(*value);
    if (!number) {
        refuseMember(key, "a natural number");
    }
    return number;
}

std::uint64_t natural(const GltfJson& object, const char* key, std::uint64_t otherwise) {
    return natural(object, key).value_or(otherwise);
}

std::uint64_t neededNatural(const GltfJson& object, const char* key) {
    const std::optional<std::uint64_t> value = natural(object, key);
    if (!value) {
        throw GltfRefusal{std::string("a '") + key + "' is missing"};
    }
    return *value;
}

std::string textOf(const GltfJson& object, const char* key) {
    const GltfJson* const value = member(object, key);
    if (value != nullptr && !value->is_string()) {
        refuseMember(key, "a text");
    }
    return value == nullptr ? std::string() : value->get<std::string>();
}

bool flag(const GltfJson& object, const char* key) {
    const GltfJson* const value = member(object, key);
    if (value != nullptr && !value->is_boolean()) {
        refuseMember(key, "true or false");
    }
    return value != nullptr && value->get<bool>();
}

std::vector<std::uint64_t> naturals(const GltfJson& object, const char* key) {
    std::vector<std::uint64_t> list;
    const GltfJson* const value = member(object, key);
    if (value == nullptr) {
        return list;
    }
    if (!value->is_array()) {
        refuseMember(key, "a list of natural numbers");
    }
    for (const GltfJson& item : *value) {
        const std::optional<std::uint64_t> number = asNatural(item);
        if (!number) {
            refuseMember(key, "a list of natural numbers");
        }
        list.push_back(*number);
    }
    return list;
}

std::optional<std::vector<double>> numbers(const GltfJson& object, const char* key, std::size_t count) {
    const GltfJson* const value = member(object, key);
    if (value == nullptr) {
        return std::nullopt;
    }
    std::vector<double> list;
    if (!value->is_array()) {
        refuseMember(key, "a list of numbers");
    }
    for (const GltfJson& item : *value) {
        if (!item.is_number() || !std::isfinite(item.get<double>())) {
            refuseMember(key, "a list of numbers");
        }
        list.push_back(item.get<double>());
    }
    if (list.size() != count) {
        throw GltfRefusal{std::string("'") + key + "' has " + std::to_string(list.size()) + " numbers, not " +
                          std::to_string(count)};
    }
    return list;
}

const GltfJson& objects(const GltfJson& object, const char* key) {
    const GltfJson* const value = member(object, key);
    if (value == nullptr) {
        return emptyList();
    }
    if (!value->is_array()) {
        refuseMember(key, "a list");
    }
    for (const GltfJson& item : *value) {
        if (!item.is_object()) {
            refuseMember(key, "a list of objects");
        }
    }
    return *value;
}

} // namespace voxtact::io
