// SPDX-License-Identifier: MIT
// A folder that holds one DICOM file, which may be a whole image in frames.
#include "fuzz.h"
#include "voxtact/io.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace {

/// In memory where the system has such a folder; removed at the end.
class Folder {
  public:
    Folder() {
        std::error_code ignored;
        const bool memory = std::filesystem::is_directory("/dev/shm", ignored);
        std::string name = memory ? "/dev/shm/voxtact-fuzz-XXXXXX" : "/tmp/voxtact-fuzz-XXXXXX";
        voxtact::fuzz::require(::mkdtemp(name.data()) != nullptr, "a temporary folder can be made");
        path_ = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    static const Folder folder;
    std::ofstream(folder.path() / "input", std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    const auto volume = io::readVolume(folder.path(), {.resample = true});
    if (!volume) {
        fuzz::requireOneLine(volume.error().text);
        return 0;
    }
    fuzz::require(checkVolume(volume->view()).ok(), "a volume that is read is a volume");
    fuzz::require(volume->grid.size[2] >= 2, "a series has two slices");
    return 0;
}
