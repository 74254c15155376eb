// SPDX-License-Identifier: MIT
// STEP and IGES: voxtact-step reads and triangulates them in a process of its own.
#include "core/base/escaped.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/mesh/cad_stream.h"
#include "io/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX declares it in no header

namespace voxtact::io {

namespace {

constexpr const char* kConverter = "voxtact-step";

/// Finds the converter in the folder of the library that holds this code, else in that of the program.
std::filesystem::path converterPath() {
    std::error_code ignored;
    std::vector<std::filesystem::path> files{std::filesystem::read_symlink("/proc/self/exe", ignored)};
    Dl_info library{};
    static const char kHere = 0;
    if (dladdr(&kHere, &library) != 0 && library.dli_fname != nullptr) {
        files.insert(files.begin(), library.dli_fname);
    }
    for (const std::filesystem::path& file : files) {
        std::filesystem::path converter = file.parent_path() / kConverter;
        // A relative name would be one in the current folder.
        if (file.is_absolute() && ::access(converter.c_str(), X_OK) == 0) {
            return converter;
        }
    }
    return {};
}

std::string readAll(int pipe) {
    std::string all;
    std::array<char, 65536> piece; // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
    for (;;) {
        const ssize_t count = ::read(pipe, piece.data(), piece.size());
        if (count > 0) {
            all.append(piece.data(), static_cast<std::size_t>(count));
        } else if (count == 0 || errno != EINTR) {
            return all;
        }
    }
}

struct Converted {
    std::string stream;
    int status = 0; ///< as waitpid() has it
};

/// Returns 0, or the errno of the failure.
int runConverter(const std::filesystem::path& program, const std::filesystem::path& file, double deflection,
                 Converted& out) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return errno;
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 3> words{program.string(), file.string(), number(deflection)};
    const std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
    pid_t child = -1;
    const int reason = ::posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (reason == 0) {
        out.stream = readAll(ends[0]);
        while (::waitpid(child, &out.status, 0) < 0 && errno == EINTR) {
        }
    }
    ::close(ends[0]);
    return reason;
}

Error notConverted(const MeshSource& source, const std::string& reason) {
    return cannotRead(source.path, escaped(oneLine(reason)));
}

/// Sizes are checked first: the stream has them all, or is none.
Result<MeshFile> unpacked(const MeshSource& source, const Converted& converted) {
    const std::string& stream = converted.stream;
    CadHeader header;
    constexpr CadHeader kExpected;
    const bool isWhole = stream.size() >= sizeof header;
    if (isWhole) {
        std::memcpy(&header, stream.data(), sizeof header);
    }
    const std::uint64_t most = stream.size();
    if (!isWhole || header.magic != kExpected.magic || header.textBytes > most || header.vertices > most ||
        header.triangles > most ||
        stream.size() != sizeof header + header.textBytes + header.vertices * sizeof(Vec3) +
                             header.triangles * 3 * sizeof(std::uint32_t)) {
        return notConverted(source, WIFSIGNALED(converted.status)
                                        ? "OpenCASCADE crashed on it (signal " +
                                              std::to_string(WTERMSIG(converted.status)) + "); repair the file"
                                        : std::string(kConverter) + " wrote no mesh; is it of another version?");
    }
    const std::string text = stream.substr(sizeof header, header.textBytes);
    if (header.triangles == 0) {
        return notConverted(source, text);
    }
    MeshFile file;
    const char* const vertices = stream.data() + sizeof header + header.textBytes;
    file.vertices.resize(header.vertices);
    std::memcpy(file.vertices.data(), vertices, header.vertices * sizeof(Vec3));
    file.corners.resize(3 * header.triangles);
    std::memcpy(file.corners.data(), vertices + header.vertices * sizeof(Vec3),
                file.corners.size() * sizeof(std::uint32_t));
    if (std::ranges::any_of(file.corners, [&](std::uint32_t corner) { return corner >= header.vertices; })) {
        return notConverted(source, std::string(kConverter) + " wrote numbers of vertices that are not there");
    }
    file.faceSizes.assign(header.triangles, 3);
    file.pointsAndLines = header.looseEdges;
    file.deflection = header.deflection;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        file.notes.push_back(escaped(line));
    }
    return file;
}

/// The readers of OpenCASCADE take the beginning of a file for all of it.
bool isTruncated(std::string_view content, bool isIges) {
    const std::size_t last = content.find_last_not_of(kPadding);
    const std::size_t line = content.find_last_of("\r\n", last);
    const std::string_view end = content.substr(line == std::string_view::npos ? 0 : line + 1);
    // The last line of IGES has its kind, T, in column 73.
    constexpr std::size_t kKind = 72;
    return isIges ? end.size() <= kKind || end[kKind] != 'T' : end.find("END-ISO-10303-21;") == std::string_view::npos;
}

} // namespace

bool isCad(const std::filesystem::path& path) {
    const std::string ending = lowerEnding(path);
    return ending == ".step" || ending == ".stp" || ending == ".iges" || ending == ".igs";
}

Result<MeshFile> readCad(const MeshSource& source) {
    if (!source.other) {
        return cannotRead(source.path, "STEP and IGES are read from files only; write the bytes to one");
    }
    if (isTruncated(source.content, lowerEnding(source.path).starts_with(".ig"))) {
        return cannotRead(source.path, "it is truncated: its end is missing");
    }
    const std::filesystem::path program = converterPath();
    if (program.empty()) {
        return cannotRead(source.path,
                          std::string("STEP and IGES need ") + kConverter +
                              " in the folder of the program or library; build it with -DVOXTACT_BUILD_STEP=ON "
                              "(Debian: libocct-data-exchange-dev)");
    }
    Converted converted;
    if (const int reason = runConverter(program, source.path, source.deflection, converted); reason != 0) {
        return cannotRead(source.path,
                          std::string(kConverter) + " cannot be started: " + std::generic_category().message(reason),
                          ErrorCode::File);
    }
    return unpacked(source, converted);
}

} // namespace voxtact::io
