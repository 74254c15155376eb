// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace voxtact::io {

/// A callback for nlohmann's parser that finds duplicate members of an object, of which a parser keeps the last one.
/// Changes nothing.
template <class Json> class TwiceSaid {
  public:
    bool operator()(typename Json::parse_event_t event, const Json& parsed) {
        if (event == Json::parse_event_t::object_start) {
            names_.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            names_.pop_back();
        } else if (event == Json::parse_event_t::key &&
                   !names_.back().insert(parsed.template get<std::string>()).second) {
            found_ = found_.value_or(parsed.template get<std::string>());
        }
        return true;
    }
    /// The first such name.
    [[nodiscard]] const std::optional<std::string>& found() const noexcept { return found_; }

  private:
    std::vector<std::set<std::string>> names_; ///< of the objects that are open
    std::optional<std::string> found_;
};

} // namespace voxtact::io
