// SPDX-License-Identifier: MIT
// A program that needs no file: a volume and a mesh of voxtact::samples.
#include "voxtact/samples.h"

#include <cstdio>
#include <cstdlib>

int main() {
    const voxtact::Result<voxtact::VolumeData> volume = voxtact::makeBuiltinVolume("sphere:16");
    const voxtact::Result<voxtact::MeshData> mesh = voxtact::makeScalpel();
    if (!volume || !mesh) {
        std::fprintf(stderr, "a sample could not be made\n");
        return EXIT_FAILURE;
    }
    std::printf("%llu voxels, %zu triangles\n", static_cast<unsigned long long>(voxtact::voxelCount(volume->grid)),
                mesh->indices.size() / 3);
    return EXIT_SUCCESS;
}
