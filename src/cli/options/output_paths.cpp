// SPDX-License-Identifier: MIT
#include "cli/options/output_paths.h"

#include "cli/options/file_status.h"
#include "cli/options/inputs.h"
#include "core/base/try.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

/// Set for the running command.
bool keepsExisting = false;
bool hasFiles = false;

/// Decodes "a%20b" to "a b", as glTF encodes names.
std::string withoutPercents(std::string_view text) {
    constexpr int kHexadecimal = 16;
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned byte = 0;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(text.data() + i + 1, text.data() + i + 3, byte, kHexadecimal).ptr == text.data() + i + 3) {
            out += static_cast<char>(byte);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(kBlanks);
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// Adds possible file names in a line of a header: the whole line, the part after `=` or `:`, and quoted parts.
void addNames(std::string_view line, std::vector<std::string>& names) {
    names.emplace_back(trimmed(line));
    if (const std::size_t sign = line.find_first_of("=:"); sign != std::string_view::npos) {
        names.emplace_back(trimmed(line.substr(sign + 1)));
    }
    for (std::size_t open = line.find('"'); open != std::string_view::npos;) {
        const std::size_t close = line.find('"', open + 1);
        if (close == std::string_view::npos) {
            break;
        }
        names.push_back(withoutPercents(line.substr(open + 1, close - open - 1)));
        open = close;
    }
}

/// Returns the names of the files that belong to a header by its name.
std::vector<std::string> siblingNames(const fs::path& header, const std::string& ending) {
    const std::string stem = header.stem().string();
    if (ending == ".hdr") {
        return {stem + ".img", stem + ".img.gz", stem + ".IMG", stem + ".IMG.GZ"};
    }
    return {stem + ".hdr", stem + ".hdr.gz", stem + ".HDR", stem + ".HDR.GZ"};
}

std::string loweredEnding(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    return ending;
}

/// Returns true if the existing file `output` is read together with the file `input`.
Result<bool> isNamedBy(const FileIdentity& output, const fs::path& input) {
    const Result<std::vector<fs::path>> others = filesNamedIn(input);
    VOXTACT_TRY(others);
    for (const fs::path& other : *others) {
        const Result<std::optional<FileIdentity>> identity = identityOf(other, NoAccess::IsNothing);
        VOXTACT_TRY(identity);
        if (*identity == output) {
            return true;
        }
    }
    return false;
}

/// Returns true if `output` is, or would become, a file of the folder `input`.
Result<bool> isMember(const fs::path& output, const fs::path& input) {
    const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
    const Result<std::optional<FileIdentity>> identity = identityOf(output);
    VOXTACT_TRY(identity);
    const Result<std::optional<FileIdentity>> place = identityOf(folder);
    VOXTACT_TRY(place);
    const Result<std::optional<FileIdentity>> inputs = identityOf(input);
    VOXTACT_TRY(inputs);
    if (place->has_value() && *place == *inputs) {
        return true;
    }
    if (!identity->has_value()) {
        return false;
    }
    std::error_code problem;
    for (fs::directory_iterator entry(input, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem)) {
        const Result<std::optional<FileIdentity>> member = identityOf(entry->path(), NoAccess::IsNothing);
        VOXTACT_TRY(member);
        if (*member == *identity) {
            return true;
        }
    }
    return problem ? cannotLookAt(input, problem) : Result<bool>(false);
}

Result<void> checkApart(const NamedPath& output, const NamedPath& input) {
    const std::string what = output.option + ": '" + output.path.string() + "' is ";
    const std::string reads = "that " + input.option + " reads";
    const std::string end = ", and is not overwritten; choose another path";
    const Result<std::optional<struct stat>> source = statusOf(input.path);
    VOXTACT_TRY(source);
    if (*source && S_ISDIR((*source)->st_mode)) {
        const Result<bool> member = isMember(output.path, input.path);
        VOXTACT_TRY(member);
        return *member ? badArgument(what + "in the folder '" + input.path.string() + "' " + reads + end)
                       : Result<void>();
    }
    const Result<std::optional<FileIdentity>> identity = identityOf(output.path);
    VOXTACT_TRY(identity);
    const Result<std::optional<FileIdentity>> read = identityOf(input.path);
    VOXTACT_TRY(read);
    if (!identity->has_value() || !read->has_value()) {
        return {}; // there is nothing to overwrite, or nothing to read
    }
    if (**identity == **read) {
        return badArgument(what + "the file " + reads + end);
    }
    const Result<bool> named = isNamedBy(**identity, input.path);
    VOXTACT_TRY(named);
    return *named ? badArgument(what + "a file that '" + input.path.string() + "' consists of, " + reads + end)
                  : Result<void>();
}

/// Refuses a second writer to standard output: their outputs would be mixed.
Result<void> checkOneOnStandardOutput(const std::vector<NamedPath>& outputs) {
    const NamedPath* first = nullptr;
    for (const NamedPath& output : outputs) {
        if (output.path != "-") {
            continue;
        }
        if (first != nullptr) {
            return badArgument(output.option + ": - is standard output, where the rows of " + first->option +
                               " go; give one of the two a file");
        }
        first = &output;
    }
    return {};
}

Result<std::vector<std::string>> namesIn(const fs::path& header) {
    const std::string ending = loweredEnding(header);
    if (ending == ".gz") {
        const fs::path inner = header.stem();
        const std::string innerEnding = loweredEnding(inner);
        return innerEnding == ".hdr" || innerEnding == ".img" ? siblingNames(inner, innerEnding)
                                                              : std::vector<std::string>{};
    }
    if (ending == ".hdr" || ending == ".img") {
        return siblingNames(header, ending);
    }
    std::vector<std::string> names;
    if (ending == ".nhdr" || ending == ".mhd" || ending == ".gltf") {
        constexpr std::size_t kMaxBytes = std::size_t{1} << 22U;
        errno = 0;
        std::ifstream file(header, std::ios::binary);
        if (!file) {
            return cannotLookAt(header, {errno != 0 ? errno : EIO, std::generic_category()});
        }
        file.exceptions(std::ios::badbit); // otherwise getline() treats an error as the end
        try {
            std::string line;
            for (std::size_t read = 0; read < kMaxBytes && std::getline(file, line); read += line.size() + 1) {
                addNames(line, names);
            }
        } catch (const std::ios::failure& failure) {
            return cannotLookAt(header, failure.code());
        }
    }
    return names;
}

} // namespace

Result<std::vector<fs::path>> filesNamedIn(const fs::path& header) {
    const Result<std::vector<std::string>> names = namesIn(header);
    VOXTACT_TRY(names);
    std::vector<fs::path> files;
    for (const std::string& name : *names) {
        if (!name.empty() && name.find('\0') == std::string::npos) {
            files.push_back(header.parent_path() / name);
        }
    }
    return files;
}

NamedImage namedImage(const std::string& source) {
    std::error_code ignored;
    const std::size_t mark = source.rfind('#');
    if (mark == std::string::npos || fs::exists(source, ignored)) {
        return {source, {}};
    }
    return {source.substr(0, mark), source.substr(mark + 1)};
}

void addInput(std::vector<NamedPath>& inputs, const char* option, const fs::path& path) {
    if (!path.empty() && path != "-" && !path.string().starts_with("builtin:")) {
        inputs.push_back({option, namedImage(path.string()).path});
    }
}

std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes) {
    std::vector<NamedPath> paths;
    for (const std::string& volume : volumes) {
        addInput(paths, "--volume", volume);
    }
    for (const std::string& mesh : meshes.sources) {
        addInput(paths, "--mesh", mesh);
    }
    return paths;
}

std::vector<NamedPath> inputPaths(const std::vector<std::string>& volumes, const MeshOptions& meshes,
                                  const TransferFunctionOptions& transferFunction, const ViewOptions& view,
                                  const LabelOptions& labels) {
    std::vector<NamedPath> paths = inputPaths(volumes, meshes);
    addInput(paths, "--transfer-function", transferFunction.path);
    addInput(paths, "--poses", view.poses);
    addInput(paths, "--camera", view.camera);
    if (!labels.path.empty()) {
        paths.push_back({"--labels", labels.path});
        paths.push_back({"--label-names", labelNamesPath(labels.names, labels.path)});
    }
    return paths;
}

Result<void> checkOutputs(const std::vector<NamedPath>& outputs, const std::vector<NamedPath>& inputs) {
    VOXTACT_TRY(checkOneOnStandardOutput(outputs));
    for (const NamedPath& output : outputs) {
        VOXTACT_TRY(checkOutput(output.path));
        if (output.path.empty() || output.path == "-") {
            continue;
        }
        for (const NamedPath& input : inputs) {
            VOXTACT_TRY(checkApart(output, input));
        }
        const Result<bool> exists = isFile(output.path);
        VOXTACT_TRY(exists);
        if (*exists && keepsExisting) {
            return badArgument(output.option + ": '" + output.path.string() +
                               "' exists; --force overwrites it, or choose another path");
        }
        hasFiles = true;
    }
    std::vector<std::pair<std::string, fs::path>> all;
    for (const NamedPath& output : outputs) {
        all.emplace_back(output.option, output.path);
    }
    return checkDistinct(all);
}

void keepExisting(bool keep) noexcept {
    keepsExisting = keep;
}

bool writesFiles() noexcept {
    return hasFiles;
}

} // namespace voxtact::app
