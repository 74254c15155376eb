// SPDX-License-Identifier: MIT
#include "view/model/files/save_file.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "view/model/answers/command_text.h"
#include "view/model/files/session_file.h"
#include "voxtact/io.h"

#include <array>
#include <fstream>
#include <ostream>
#include <string_view>

namespace voxtact::view {

namespace {

/// `isOne`: whether a file that is there is of the kind.
template <class IsOne>
Result<void> check(const std::filesystem::path& path, const State& state, const char* kind, const IsOne& isOne) {
    VOXTACT_TRY(state.checkOutput(path));
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored) && !(std::filesystem::is_regular_file(path, ignored) && isOne())) {
        return refuse("'" + path.string() + "' is there already, and is no " + kind + "; choose another path");
    }
    return {};
}

} // namespace

Result<void> saveSession(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(check(path, state, "session", [&path] {
        const Result<bool> session = isSession(path);
        return session.ok() && *session;
    }));
    return writeSession(path, state.saved());
}

Result<void> saveFunction(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(check(path, state, "transfer function", [&path] { return io::readTransferFunction(path).ok(); }));
    return writeTransferFunction(path, state.document);
}

Result<void> savePose(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(check(path, state, "file of poses", [&path] { return io::readPoses(path).ok(); }));
    return io::writeFile(path, [&state](std::ostream& out) -> Result<void> {
        out << poseText(state.document.edit.pose()) << "\n";
        return {};
    });
}

Result<void> checkPicture(const std::filesystem::path& path, const State& state) {
    return check(path, state, "picture", [&path] {
        constexpr std::string_view kPng = "\x89PNG\r\n";
        std::array<char, kPng.size()> first{};
        std::ifstream(path, std::ios::binary).read(first.data(), first.size());
        return std::string_view(first.data(), first.size()) == kPng;
    });
}

} // namespace voxtact::view
