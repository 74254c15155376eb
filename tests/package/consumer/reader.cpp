// SPDX-License-Identifier: MIT
// A program that reads files with voxtact::io: a volume and a mesh, written and read again.
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
    voxtact::VolumeData cube;
    cube.grid.size = {8, 8, 8};
    cube.voxels.resize(512, std::byte{7});
    voxtact::MeshData tetrahedron;
    tetrahedron.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    tetrahedron.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    take(voxtact::io::writeVolume("reader.nii", cube.view()));
    take(voxtact::io::writeMesh("reader.stl", tetrahedron.view()));
    const voxtact::VolumeData volume = take(voxtact::io::readVolume("reader.nii"));
    const voxtact::MeshData mesh = take(voxtact::io::readMesh("reader.stl"));
    std::printf("%llu voxels, %zu triangles\n", static_cast<unsigned long long>(voxtact::voxelCount(volume.grid)),
                mesh.indices.size() / 3);
    return EXIT_SUCCESS;
}
