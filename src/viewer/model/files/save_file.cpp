// SPDX-License-Identifier: MIT
#include "viewer/model/files/save_file.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "viewer/model/answers/command_text.h"
#include "viewer/model/files/open_file.h"
#include "viewer/model/files/session_file.h"
#include "voxtact/io.h"

#include <array>
#include <fstream>
#include <ostream>
#include <string_view>

namespace voxtact::view {

namespace {

/// `isOne`: tests the kind of an existing file.
template <class IsOne>
Result<void> check(const std::filesystem::path& path, const State& state, const char* kind, const IsOne& isOne) {
    VOXTACT_TRY(state.checkOutput(path));
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored) && !(std::filesystem::is_regular_file(path, ignored) && isOne())) {
        return refuse("'" + path.string() + "' exists and is no " + kind + "; choose another path");
    }
    return {};
}

} // namespace

Result<void> checkSession(const std::filesystem::path& path, const State& state) {
    return check(path, state, "session", [&path] {
        const Result<bool> session = isSession(path);
        return session.ok() && *session;
    });
}

Result<void> checkFunction(const std::filesystem::path& path, const State& state) {
    return check(path, state, "transfer function", [&path] { return io::readTransferFunction(path).ok(); });
}

Result<void> checkPose(const std::filesystem::path& path, const State& state) {
    return check(path, state, "file of poses", [&path] { return io::readPoses(path).ok(); });
}

Result<void> checkPicture(const std::filesystem::path& path, const State& state) {
    if (endingOf(path) != ".png") {
        return refuse("cannot write '" + path.string() + "': the ending must be .png");
    }
    return check(path, state, "picture", [&path] {
        constexpr std::string_view kPng = "\x89PNG\r\n";
        std::array<char, kPng.size()> first{};
        std::ifstream(path, std::ios::binary).read(first.data(), first.size());
        return std::string_view(first.data(), first.size()) == kPng;
    });
}

Result<void> saveSession(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(checkSession(path, state));
    return writeSession(path, state.saved());
}

Result<void> saveFunction(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(checkFunction(path, state));
    return writeTransferFunction(path, state.document);
}

Result<void> savePose(const std::filesystem::path& path, const State& state) {
    VOXTACT_TRY(checkPose(path, state));
    return io::writeFile(path, [&state](std::ostream& out) -> Result<void> {
        out << poseText(state.document.edit.pose()) << "\n";
        return {};
    });
}

} // namespace voxtact::view
