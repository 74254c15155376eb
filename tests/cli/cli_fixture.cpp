// SPDX-License-Identifier: MIT
#include "cli_fixture.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace voxtact::test {

namespace {

namespace fs = std::filesystem;

/// A file without a name that takes a stream of the child.
class Capture {
  public:
    Capture() : file_(std::tmpfile()) {
        if (file_ == nullptr) {
            throw std::runtime_error("no temporary file");
        }
    }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;
    ~Capture() { static_cast<void>(std::fclose(file_)); }

    [[nodiscard]] int number() const { return ::fileno(file_); }
    [[nodiscard]] std::string text() const {
        std::rewind(file_);
        std::string text;
        std::array<char, 4096> buffer{};
        while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), file_)) {
            text.append(buffer.data(), got);
        }
        return text;
    }

  private:
    std::FILE* file_;
};

int openOutput(const RunOptions& options, const Capture& captured) {
    if (options.closedPipe) {
        std::array<int, 2> ends{};
        if (::pipe(ends.data()) != 0) {
            throw std::runtime_error("no pipe");
        }
        ::close(ends[0]);
        return ends[1];
    }
    return options.output.empty() ? ::dup(captured.number()) : ::open(options.output.c_str(), O_WRONLY | O_CLOEXEC);
}

/// Whether a test writes over what it has written before.
bool overwrites(const Arguments& arguments) {
    const std::set<std::string> outputs{"--output",  "--contacts", "--triangles", "--witness", "--by-target",
                                        "--surface", "--heat-map", "--report",    "--picture"};
    const bool makesFile = arguments.size() == 4 && arguments[0] == "make";
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const bool isOutput = outputs.contains(arguments[i - 1]) || (makesFile && i == 3);
        std::error_code unknown; // a name that is too long
        if (isOutput && std::filesystem::is_regular_file(arguments[i], unknown)) {
            return true;
        }
    }
    return false;
}

[[noreturn]] void becomeProgram(const Arguments& arguments, const RunOptions& options, int out, int err) {
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    setCaches();
    for (const auto& [name, value] : options.environment) {
        ::setenv(name.c_str(), value.c_str(), 1);
    }
    const std::string program = options.program.empty() ? VOXTACT_PROGRAM : options.program;
    std::vector<std::string> words{program};
    const Arguments all = options.keepExisting ? arguments : withForce(arguments);
    words.insert(words.end(), all.begin(), all.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    ::_exit(127);
}

} // namespace

void setCaches() {
    const auto of = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::string(value == nullptr ? "" : value);
    };
    std::string shaders = of("MESA_SHADER_CACHE_DIR");
    if (shaders.empty()) {
        shaders = of("XDG_CACHE_HOME");
    }
    if (shaders.empty() && !of("HOME").empty()) {
        shaders = of("HOME") + "/.cache";
    }
    ::setenv("MESA_SHADER_CACHE_DIR", shaders.empty() ? VOXTACT_TEST_CACHE : shaders.c_str(), 1);
    ::setenv("XDG_CACHE_HOME", VOXTACT_TEST_CACHE, 1);
}

Arguments withForce(Arguments arguments) {
    if (overwrites(arguments)) {
        arguments.emplace_back("--force");
    }
    return arguments;
}

std::string builtProgram() {
    return VOXTACT_PROGRAM;
}

Ran run(const Arguments& arguments, const RunOptions& options) {
    const Capture out;
    const Capture err;
    const int outNumber = openOutput(options, out);
    const pid_t child = ::fork();
    if (child == 0) {
        becomeProgram(arguments, options, outNumber, err.number());
    }
    ::close(outNumber);
    int state = 0;
    if (child < 0 || ::waitpid(child, &state, 0) != child) {
        throw std::runtime_error("the program cannot be started");
    }
    return {WIFEXITED(state) ? WEXITSTATUS(state) : -1, out.text(), err.text()};
}

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> fieldsOf(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> fields;
    for (std::string field; std::getline(stream, field, ',');) {
        fields.push_back(field);
    }
    return fields;
}

std::vector<std::map<std::string, std::string>> rowsOf(const std::string& text) {
    std::vector<std::map<std::string, std::string>> rows;
    std::vector<std::string> names;
    for (const std::string& line : linesOf(text)) {
        const std::vector<std::string> fields = fieldsOf(line);
        if (names.empty()) {
            names = fields;
            continue;
        }
        rows.emplace_back();
        for (std::size_t i = 0; i < fields.size(); ++i) {
            rows.back()[names.at(i)] = fields[i];
        }
    }
    return rows;
}

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void writeText(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
}

std::string sealed(const std::string& content) {
    const std::uint64_t sum = XXH3_64bits(content.data(), content.size());
    std::array<char, 64> head{};
    static_cast<void>(std::snprintf(head.data(), head.size(), "voxtact cache %016zx %016llx\n", content.size(),
                                    static_cast<unsigned long long>(sum)));
    return head.data() + content;
}

void writeNifti(const fs::path& path, const HandNifti& nifti) {
    std::string header(352, '\0');
    const auto put = [&](std::size_t at, const auto& value) { std::memcpy(header.data() + at, &value, sizeof value); };
    put(0, std::int32_t{348});
    put(40, nifti.sizes);
    put(70, nifti.type);
    put(72, nifti.bits);
    put(76, std::array<float, 8>{1, 1, 1, 1, 1, 1, 1, 1});
    put(108, 352.0F);
    put(112, 1.0F); // slope
    put(254, std::int16_t{1});
    put(280, std::array<float, 12>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    put(344, std::array<char, 4>{'n', '+', '1', '\0'});
    writeText(path, header + std::string(nifti.bytes, nifti.value));
}

CliTest::CliTest() {
    std::string pattern = (fs::temp_directory_path() / "voxtact-cli-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
        throw std::runtime_error("no temporary folder");
    }
    folder_ = pattern;
}

CliTest::~CliTest() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::size_t CliTest::filesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
}

std::string withoutProgress(const std::string& err) {
    static const std::regex progress(
        "voxtact [a-z]+: ([a-z]+: )?([^\n]*, )?[0-9,]+ of [0-9,]+(, about [^\n]* left)?\n");
    return std::regex_replace(err, progress, "");
}

std::string CliTest::refused(int status, const Arguments& arguments, const RunOptions& options) {
    const Ran ran = run(arguments, options);
    EXPECT_EQ(ran.status, status) << ran.err;
    EXPECT_EQ(ran.out, "");
    const std::string err = withoutProgress(ran.err);
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_EQ(err.empty() ? '\0' : err.back(), '\n');
    EXPECT_THAT(err, testing::StartsWith("voxtact"));
    return err;
}

std::string CliTest::output(const Arguments& arguments, const RunOptions& options) {
    const Ran ran = run(arguments, options);
    EXPECT_EQ(ran.status, 0) << ran.err;
    const std::string err = withoutProgress(ran.err);
    if (options.note.empty()) {
        EXPECT_EQ(err, "");
    } else {
        EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
        EXPECT_THAT(err, testing::AllOf(testing::StartsWith("voxtact: note: "), testing::HasSubstr(options.note)));
    }
    return ran.out;
}

void CliDeviceTest::SetUp() {
    static const Ran devices = run({"devices", "--format", "csv"});
    if (devices.status == 0) {
        return;
    }
    if (VOXTACT_REQUIRE_DEVICE != 0) {
        FAIL() << "this build requires a Vulkan device: " << devices.err;
    }
    GTEST_SKIP() << devices.err;
}

Arguments CliDeviceTest::detect(const Arguments& more) {
    Arguments all{"count", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500"};
    if (std::find(more.begin(), more.end(), "--method") == more.end()) {
        all.insert(all.end(), {"--method", "query"});
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

std::string CliDeviceTest::poses(int count) const {
    std::string file = path("poses.txt");
    output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--number",
            std::to_string(count), "--seed", "7", "--output", file});
    return file;
}

} // namespace voxtact::test
