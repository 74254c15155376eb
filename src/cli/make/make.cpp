// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/make/poses.h"
#include "cli/options/inputs.h"
#include "cli/options/output_paths.h"
#include "cli/output/interrupt.h"
#include "cli/output/outcome.h"
#include "cli/output/standard_streams.h"
#include "cli/output/text_for_messages.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <ostream>
#include <streambuf>
#include <string_view>

namespace voxtact::app {

namespace {

constexpr const char* kMeshFooter = R"(The file ending selects the format: .stl (binary), .obj, .ply (binary).

Example:
  voxtact make mesh builtin:scalpel:3068 scalpel.stl)";

constexpr const char* kVolumeFooter = R"(The file ending selects the format: .nii, .nii.gz, .nrrd, .mha.

Example:
  voxtact make volume builtin:head:128 head.nii.gz)";

constexpr const char* kPosesFooter =
    R"(Each pose is a random rotation that puts a random vertex of the mesh at a random
point of the volume's box, enlarged by a tenth on each side. The same seed gives
the same poses on every machine.

Example:
  voxtact make poses --volume builtin:head:128 --mesh builtin:scalpel \
      --number 1000 --seed 7 --output poses.txt)";

struct MakeFileOptions {
    std::string source;
    std::filesystem::path path;
};

struct MakePosesOptions {
    bool resample = false;
    std::vector<std::string> volumes;
    MeshOptions meshes;
    std::uint32_t number = 100;
    std::uint64_t seed = 1;
    std::filesystem::path path;
};

/// Runs a function that writes a file atomically. An earlier signal leaves no file.
template <class Write> Outcome written(const Write& write) {
    const InterruptGuard guard;
    const Result<void> result = write();
    // On success the file is complete: writing a mesh does not check for signals.
    return result.ok() ? Outcome() : interrupted() ? interruptOutcome("nothing is written") : Outcome(result.error());
}

/// Fails after an interrupt, so that its writer stops soon.
class EndingBuffer : public std::streambuf {
  public:
    explicit EndingBuffer(std::ostream& out) : out_(out) {}

  protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        constexpr std::streamsize kPiece = 1 << 20;
        std::streamsize done = 0;
        while (done < count && !interrupted() && out_.write(bytes + done, std::min(kPiece, count - done))) {
            done += std::min(kPiece, count - done);
        }
        return done;
    }
    int_type overflow(int_type byte) override {
        const char one = traits_type::to_char_type(byte);
        return traits_type::eq_int_type(byte, traits_type::eof()) || xsputn(&one, 1) == 1 ? traits_type::not_eof(byte)
                                                                                          : traits_type::eof();
    }

  private:
    std::ostream& out_;
};

Result<void> writeVolume(const std::filesystem::path& path, const VolumeView& volume) {
    return io::writeFile(path, [&](std::ostream& file) -> Result<void> {
        EndingBuffer buffer(file);
        std::ostream out(&buffer);
        VOXTACT_TRY(io::writeVolume(out, path, volume));
        return interrupted() ? Result<void>(Error{ErrorCode::Cancelled, 0, "interrupted"}) : Result<void>();
    });
}

constexpr std::string_view kBuiltin = "builtin:";

/// Returns the error for a source that is not a builtin.
Result<void> requireBuiltin(const std::string& source) {
    if (!source.starts_with(kBuiltin)) {
        return badArgument("'" + source + "' is not builtin:NAME[:SIZE]");
    }
    return {};
}

std::string_view nameOf(const std::string& source) {
    return std::string_view(source).substr(kBuiltin.size());
}

Error notMade(const std::string& source, const Error& error) {
    return badArgument("SOURCE " + forMessage(source) + ": " + error.text);
}

Outcome makeMesh(const MakeFileOptions& options) {
    VOXTACT_TRY(requireBuiltin(options.source));
    if (const Result<void> writable = checkOutputs({{"OUTPUT", options.path}}, {}); !writable.ok()) {
        return writable.error();
    }
    const Result<MeshData> mesh = makeBuiltinMesh(nameOf(options.source));
    if (!mesh.ok()) {
        return notMade(options.source, mesh.error());
    }
    return written([&] { return io::writeMesh(options.path, mesh->view()); });
}

Outcome makeVolume(const MakeFileOptions& options) {
    VOXTACT_TRY(requireBuiltin(options.source));
    if (const Result<void> writable = checkOutputs({{"OUTPUT", options.path}}, {}); !writable.ok()) {
        return writable.error();
    }
    const Result<VolumeData> volume = makeBuiltinVolume(nameOf(options.source));
    if (!volume.ok()) {
        return notMade(options.source, volume.error());
    }
    return written([&] { return writeVolume(options.path, volume->view()); });
}

void writePose(std::ostream& out, const Mat4& pose) {
    for (std::size_t i = 0; i < 16; ++i) {
        out << (i == 0 ? "" : " ") << number(pose[4 * (i % 4) + i / 4]);
    }
    out << '\n';
}

Outcome makePoses(const MakePosesOptions& options) {
    if (options.volumes.size() != 1 || options.meshes.sources.size() != 1) {
        return badArgument("--volume, --mesh: give each once");
    }
    if (const Result<void> writable =
            checkOutputs({{"--output", options.path}}, inputPaths(options.volumes, options.meshes));
        !writable.ok()) {
        return writable.error();
    }
    const Result<VolumeData> volume = loadVolume(options.volumes.front(), {.resample = options.resample});
    VOXTACT_TRY(volume);
    const Result<MeshData> mesh = loadMesh(options.meshes.sources.front(), options.meshes);
    VOXTACT_TRY(mesh);
    const auto write = [&](std::ostream& out) -> Result<void> {
        out << "# voxtact make poses: " << options.number << " poses, seed " << options.seed << ", mesh "
            << oneLine(options.meshes.sources.front()) << ", volume " << oneLine(options.volumes.front()) << '\n'
            << "# world_from_object, 16 numbers per line, row by row\n";
        forRandomPoses(volume->grid, mesh->view(), options.number, options.seed, [&](const Mat4& pose) {
            writePose(out, pose);
            return out.good() && !interrupted();
        });
        return interrupted() ? Error{ErrorCode::Cancelled, 0, "interrupted"} : Result<void>();
    };
    return written([&] { return deliver(options.path, write); });
}

Command addMakeFile(CLI::App& make, const char* name, const char* what, const char* sources, const char* footer,
                    Outcome (*run)(const MakeFileOptions&)) {
    auto options = std::make_shared<MakeFileOptions>();
    CLI::App* parser = make.add_subcommand(name, what);
    parser->footer(footer);
    parser->add_option("SOURCE", options->source, sources)->type_name("")->required();
    parser->add_option("OUTPUT", options->path, "output file")->type_name("")->required();
    return {parser, [options, run] { return run(*options); }};
}

Command addMakePoses(CLI::App& make) {
    auto options = std::make_shared<MakePosesOptions>();
    CLI::App* parser = make.add_subcommand("poses", "write random rigid poses around a volume");
    parser->footer(kPosesFooter);
    addVolumeOption(*parser, options->volumes);
    addResampleOption(*parser, options->resample);
    addMeshOptions(*parser, options->meshes);
    addWholeNumber(*parser, "--number", options->number, 1, "number of poses");
    addSeed(*parser, options->seed);
    addPath(*parser, "-o,--output", options->path, "output file; -: standard output");
    return {parser, [options] { return makePoses(*options); }};
}

} // namespace

std::vector<Command> addMake(CLI::App& program) {
    CLI::App* make = program.add_subcommand("make", "write builtin meshes, volumes and random poses");
    make->require_subcommand(1);
    make->footer("Example:\n  voxtact make mesh builtin:scalpel:3068 scalpel.stl");
    return {
        addMakeFile(*make, "mesh", "write a builtin mesh",
                    "builtin:scalpel[:TRIANGLES], builtin:ellipsoid[:TRIANGLES] or builtin:needle[:DIAMETER:LENGTH]",
                    kMeshFooter, makeMesh),
        addMakeFile(*make, "volume", "write a builtin volume",
                    "builtin:NAME[:SIZE] with head, sphere, noise, ct, shells or vessels, SIZE voxels per side",
                    kVolumeFooter, makeVolume),
        addMakePoses(*make),
    };
}

} // namespace voxtact::app
