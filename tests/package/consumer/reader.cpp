// SPDX-License-Identifier: MIT
// A program that reads files with voxtact::io: a volume and a mesh, written and read again.
#include "voxtact/builtin.h"
#include "voxtact/io.h"

#include <cstdio>
#include <cstdlib>

namespace {

template <class T> T take(voxtact::Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().text.c_str());
        std::exit(EXIT_FAILURE);
    }
    return std::move(*result);
}
void take(const voxtact::Result<void>& result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().text.c_str());
        std::exit(EXIT_FAILURE);
    }
}

} // namespace

int main() {
    take(voxtact::io::writeVolume("reader.nii", take(voxtact::makeBuiltinVolume("sphere:8")).view()));
    take(voxtact::io::writeMesh("reader.stl", take(voxtact::makeScalpel()).view()));
    const voxtact::VolumeData volume = take(voxtact::io::readVolume("reader.nii"));
    const voxtact::MeshData mesh = take(voxtact::io::readMesh("reader.stl"));
    std::printf("%llu voxels, %zu triangles\n", static_cast<unsigned long long>(voxtact::voxelCount(volume.grid)),
                mesh.indices.size() / 3);
    return EXIT_SUCCESS;
}
