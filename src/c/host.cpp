// SPDX-License-Identifier: MIT
// What the host engine is asked about.
#include "c/convert.h"
#include "c/handles.h"

using namespace voxtact;
using namespace voxtact::c;

vxt_result vxt_host_volume_create(const vxt_volume_view* view, vxt_host_volume** volume) {
    return create(volume, [&] { return take(cpu::Volume::create(toVolumeView(view))); });
}

vxt_result vxt_host_volume_grid(const vxt_host_volume* volume, vxt_grid* grid) {
    return call([&] {
        const Grid& of = need(volume, "volume").object.grid();
        need(grid, "grid") = fromGrid(of);
    });
}

vxt_result vxt_host_volume_set_box(vxt_host_volume* volume, const vxt_voxel_box* box, double value) {
    return call([&] { take(need(volume, "volume").object.set(toVoxelBox(box), value)); });
}

vxt_result vxt_host_volume_set_ball(vxt_host_volume* volume, const double centre[3], double radius, double value) {
    return call([&] { take(need(volume, "volume").object.set(toBall(centre, radius), value)); });
}

vxt_result vxt_host_volume_write(vxt_host_volume* volume, const vxt_voxel_box* box, const void* voxels, size_t bytes) {
    return call([&] { take(need(volume, "volume").object.write(toVoxelBox(box), toBytes(voxels, bytes, "voxels"))); });
}

vxt_result vxt_host_volume_read(const vxt_host_volume* volume, const vxt_voxel_box* box, void* voxels, size_t bytes) {
    return call([&] {
        const VoxelBox of = toVoxelBox(box);
        auto* const to = static_cast<std::byte*>(voxels);
        if (bytes != 0) {
            (void)need(to, "voxels");
        }
        take(need(volume, "volume").object.read(of, {to, bytes}));
    });
}

void vxt_host_volume_destroy(vxt_host_volume* volume) {
    delete volume;
}

vxt_result vxt_host_transfer_function_create(const vxt_transfer_function_desc* desc,
                                             vxt_host_transfer_function** function) {
    return create(function, [&] { return take(cpu::TransferFunction::create(TransferFunctionOf(desc).desc())); });
}

void vxt_host_transfer_function_destroy(vxt_host_transfer_function* function) {
    delete function;
}

vxt_result vxt_host_mesh_create(const vxt_mesh_view* view, vxt_host_mesh** mesh) {
    return create(mesh, [&] { return take(cpu::Mesh::create(toMeshView(view))); });
}

vxt_result vxt_host_mesh_facts(const vxt_host_mesh* mesh, vxt_mesh_facts* facts) {
    return call([&] { need(facts, "facts") = fromFacts(need(mesh, "mesh").object.facts()); });
}

void vxt_host_mesh_destroy(vxt_host_mesh* mesh) {
    delete mesh;
}

vxt_result vxt_host_mesh_update(vxt_host_mesh* mesh, const double* positions, size_t vertex_count) {
    return call([&] {
        take(need(mesh, "mesh").object.update(toSpan(positions, times(vertex_count, 3, "positions"), "positions")));
    });
}

vxt_result vxt_cancel_create(vxt_cancel** cancel) {
    return call([&] {
        vxt_cancel*& place = need(cancel, "the place for the new object");
        place = nullptr;
        place = std::make_unique<vxt_cancel>().release();
    });
}

void vxt_cancel_set(vxt_cancel* cancel, uint32_t set) {
    if (cancel != nullptr) {
        cancel->object = set != 0;
    }
}

void vxt_cancel_destroy(vxt_cancel* cancel) {
    delete cancel;
}
