// SPDX-License-Identifier: MIT
// A program that needs no file: a volume, a mesh and a scene of voxtact::samples.
#include "voxtact/samples.h"

#include <cstdio>
#include <cstdlib>

int main() {
    const voxtact::Result<voxtact::VolumeData> volume = voxtact::makeBuiltinVolume("sphere:16");
    const voxtact::Result<voxtact::MeshData> mesh = voxtact::makeScalpel();
    const voxtact::Result<voxtact::MeasureScene> scene = voxtact::makeMeasureScene();
    if (!volume || !mesh || !scene) {
        std::fprintf(stderr, "a sample could not be made\n");
        return EXIT_FAILURE;
    }
    std::printf("%llu voxels, %zu triangles, %zu poses\n",
                static_cast<unsigned long long>(voxtact::voxelCount(volume->grid)), mesh->indices.size() / 3,
                scene->world_from_object.size());
    return EXIT_SUCCESS;
}
