// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <string>

namespace voxtact::view {

/// Reads members and keeps the first error; later members are then meaningless.
class SessionReader {
  public:
    using Json = nlohmann::ordered_json;

    explicit SessionReader(const Json& root) : root_(&root) {}

    [[nodiscard]] const std::string& wrong() const { return wrong_; }
    void refuse(const std::string& member, const std::string& why) {
        wrong_ = wrong_.empty() ? member + ": " + why : wrong_;
    }

    /// Sets an error that names the member.
    void refuse(const std::string& why) { wrong_ = wrong_.empty() ? why : wrong_; }

    /// The member "a.b", or null.
    [[nodiscard]] const Json* find(const std::string& path) {
        const Json* at = root_;
        for (std::size_t begin = 0; begin <= path.size();) {
            const std::size_t end = std::min(path.find('.', begin), path.size());
            if (!at->is_object()) {
                refuse(path.substr(0, begin == 0 ? 0 : begin - 1), "is not an object");
                return nullptr;
            }
            const auto member = at->find(path.substr(begin, end - begin));
            if (member == at->end() || member->is_null()) {
                return nullptr;
            }
            at = &*member;
            begin = end + 1;
        }
        return at;
    }
    std::string text(const std::string& path, const std::string& standard) {
        const Json* json = find(path);
        if (json != nullptr && !json->is_string()) {
            refuse(path, "is not a text");
            return standard;
        }
        return json == nullptr ? standard : json->get<std::string>();
    }
    double number(const std::string& path, const Json* json) {
        if (json == nullptr || !json->is_number()) {
            refuse(path, json == nullptr ? "is missing" : "is not a number");
            return 0;
        }
        return json->get<double>();
    }
    double number(const std::string& path, double standard) {
        const Json* json = find(path);
        return json == nullptr ? standard : number(path, json);
    }
    /// Reads N numbers.
    template <std::size_t N> std::array<double, N> numbers(const std::string& path, const Json& json) {
        std::array<double, N> out{};
        if (!json.is_array() || json.size() != N) {
            refuse(path, "is not an array of " + std::to_string(N) + " numbers");
            return out;
        }
        for (std::size_t i = 0; i < N; ++i) {
            out[i] = number(path + "[" + std::to_string(i) + "]", &json[i]);
        }
        return out;
    }
    /// Calls `use` with the name and value of each element of an array that may be missing.
    template <class Use> void each(const std::string& path, Use&& use) {
        const Json* json = find(path);
        if (json != nullptr && !json->is_array()) {
            refuse(path, "is not an array");
            return;
        }
        for (std::size_t i = 0; json != nullptr && i < json->size() && wrong_.empty(); ++i) {
            use(path + "[" + std::to_string(i) + "]", (*json)[i]);
        }
    }

  private:
    const Json* root_;
    std::string wrong_;
};

} // namespace voxtact::view
