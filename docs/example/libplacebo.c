/* SPDX-License-Identifier: MIT */
/* voxtact inside an engine that is not ours: libplacebo, which makes the instance, the device and the image of the
   volume, draws frames, and knows nothing of voxtact. Between two of its frames voxtact decides on its device, against
   its image, what touches. The engine then carves the image, and the next frame and the next answer have seen it.

   Exit status: 0 done, 1 something failed or the validation layer complained, 77 there is no Vulkan device. */
#include "voxtact/voxtact_vulkan.h"

#include <libplacebo/dispatch.h>
#include <libplacebo/shaders/custom.h>
#include <libplacebo/vulkan.h>

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXIT_NO_DEVICE = 77, SIDE = 16, PICTURE = 32, POSES = 2 };

static void quit(int status, const char* why) {
    fprintf(stderr, "libplacebo: %s\n", why);
    exit(status);
}

static void done(vxt_result result) {
    if (result != VXT_OK) {
        quit(EXIT_FAILURE, vxt_last_error(NULL));
    }
}

static void vulkan_done(VkResult result) {
    if (result != VK_SUCCESS) {
        quit(EXIT_FAILURE, "a Vulkan call failed");
    }
}

static void need(bool done, const char* what) {
    if (!done) {
        quit(EXIT_FAILURE, what);
    }
}

/* The engine: libplacebo's objects, a volume to draw, and a picture. */
typedef struct engine {
    int complaints; /* of the validation layer, which libplacebo hands to its log */
    pl_log log;
    pl_vk_inst instance;
    pl_vulkan vulkan;
    pl_dispatch dispatch;
    pl_tex volume;
    pl_tex picture;
    pl_buf voxels; /* on the way to the volume */
    pl_buf pixels; /* on the way from the picture */
} engine;

static void hear(void* user, enum pl_log_level level, const char* message) {
    if (level <= PL_LOG_WARN) {
        fprintf(stderr, "%s\n", message);
    }
    if (level <= PL_LOG_ERR) {
        ++((engine*)user)->complaints;
    }
}

/* What voxtact wants, as structs of single features: libplacebo takes no VkPhysicalDeviceVulkan13Features, and so no
   chain of vxt_features_create(). It enables what the device has. */
static void open_device(engine* e) {
    VkPhysicalDeviceSynchronization2Features synchronization = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, .synchronization2 = VK_TRUE};
    VkPhysicalDeviceDynamicRenderingFeatures rendering = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        .pNext = &synchronization,
        .dynamicRendering = VK_TRUE};
    VkPhysicalDeviceFeatures2 wanted = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &rendering};
    wanted.features.occlusionQueryPrecise = VK_TRUE;
    wanted.features.fragmentStoresAndAtomics = VK_TRUE;

    e->log = pl_log_create(PL_API_VER, pl_log_params(.log_cb = hear, .log_priv = e, .log_level = PL_LOG_WARN));
    e->instance = pl_vk_inst_create(e->log, &(struct pl_vk_inst_params){.debug = true});
    if (e->instance == NULL) {
        quit(EXIT_NO_DEVICE, "there is no Vulkan driver");
    }
    e->vulkan = pl_vulkan_create(e->log, pl_vulkan_params(.instance = e->instance->instance,
                                                          .get_proc_addr = e->instance->get_proc_addr,
                                                          .allow_software = true, .features = &wanted));
    if (e->vulkan == NULL) {
        quit(EXIT_NO_DEVICE, "there is no Vulkan device");
    }
}

static void make_images(engine* e) {
    pl_gpu gpu = e->vulkan->gpu;
    e->dispatch = pl_dispatch_create(e->log, gpu);
    e->volume =
        pl_tex_create(gpu, pl_tex_params(.w = SIDE, .h = SIDE, .d = SIDE, .format = pl_find_named_fmt(gpu, "r8"),
                                         .sampleable = true, .host_writable = true));
    e->picture = pl_tex_create(gpu, pl_tex_params(.w = PICTURE, .h = PICTURE, .format = pl_find_named_fmt(gpu, "rgba8"),
                                                  .renderable = true, .host_readable = true));
    /* Buffers that last: for one of its own, libplacebo destroys a semaphore as soon as it has fired, which the
       lavapipe of Mesa 22.3 does not always survive. */
    e->voxels = pl_buf_create(gpu, pl_buf_params(.size = SIDE * SIDE * SIDE, .host_writable = true));
    e->pixels = pl_buf_create(gpu, pl_buf_params(.size = 4 * PICTURE * PICTURE, .host_readable = true));
    need(e->volume != NULL && e->picture != NULL && e->voxels != NULL && e->pixels != NULL, "no images");
}

/* Bright where x is below the voxel `bright`. */
static void fill_volume(engine* e, int bright) {
    static uint8_t voxels[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; ++i) {
        voxels[i] = i % SIDE < bright ? 255 : 0;
    }
    pl_gpu gpu = e->vulkan->gpu;
    pl_buf_write(gpu, e->voxels, 0, voxels, sizeof voxels);
    need(pl_tex_upload(gpu, pl_tex_transfer_params(.tex = e->volume, .buf = e->voxels)), "no upload");
}

/* A frame: the middle slice of the volume. Returns how many of its pixels are bright. */
static int draw(engine* e) {
    pl_shader shader = pl_dispatch_begin(e->dispatch);
    struct pl_shader_desc volume = {.desc = {.name = "volume", .type = PL_DESC_SAMPLED_TEX},
                                    .binding = {.object = e->volume, .sample_mode = PL_TEX_SAMPLE_NEAREST}};
    char body[128];
    snprintf(body, sizeof body, "color = vec4(texture(volume, vec3(gl_FragCoord.xy / %d.0, 0.5)).r);", PICTURE);
    need(pl_shader_custom(shader, &(struct pl_custom_shader){.description = "a slice",
                                                             .body = body,
                                                             .input = PL_SHADER_SIG_NONE,
                                                             .output = PL_SHADER_SIG_COLOR,
                                                             .descriptors = &volume,
                                                             .num_descriptors = 1}),
         "no shader");
    need(pl_dispatch_finish(e->dispatch, pl_dispatch_params(.shader = &shader, .target = e->picture)), "no frame");
    static uint8_t pixels[PICTURE * PICTURE][4];
    pl_gpu gpu = e->vulkan->gpu;
    need(pl_tex_download(gpu, pl_tex_transfer_params(.tex = e->picture, .buf = e->pixels)), "no picture");
    pl_gpu_finish(gpu);
    need(pl_buf_read(gpu, e->pixels, 0, pixels, sizeof pixels), "no pixels");
    int bright = 0;
    for (int i = 0; i < PICTURE * PICTURE; ++i) {
        bright += pixels[i][0] > 127;
    }
    return bright;
}

/* voxtact beside it. */
typedef struct detection {
    engine* engine;
    PFN_vkGetInstanceProcAddr load;
    VkQueue queue;
    vxt_context* context;
    VkImageView view;
    vxt_volume* volume; /* the engine's image */
    vxt_transfer_function* opacity;
    vxt_mesh* mesh;
    vxt_detector* counting;
    vxt_detector* certified;
    vxt_results* results[2];
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkSemaphore turns;
    uint64_t turn;
} detection;

#define LOAD(d, name) ((PFN_##name)(d)->load((d)->engine->instance->instance, #name))

/* Both submit to the engine's queue, each while it holds the engine's lock. */
static void lock_queue(void* user) {
    pl_vulkan vulkan = ((engine*)user)->vulkan;
    vulkan->lock_queue(vulkan, (int)vulkan->queue_graphics.index, 0);
}

static void unlock_queue(void* user) {
    pl_vulkan vulkan = ((engine*)user)->vulkan;
    vulkan->unlock_queue(vulkan, (int)vulkan->queue_graphics.index, 0);
}

static void make_context(detection* d) {
    pl_vulkan vulkan = d->engine->vulkan;
    uint32_t families[8];
    vxt_context_desc desc = {.struct_size = sizeof desc};
    desc.get_instance_proc_addr = d->load;
    desc.instance = vulkan->instance;
    desc.physical_device = vulkan->phys_device;
    desc.device = vulkan->device;
    desc.api_version = d->engine->instance->api_version;
    desc.enabled_features = vulkan->features; /* what it has enabled: its own structs and those above */
    desc.enabled_device_extensions = vulkan->extensions;
    desc.enabled_device_extension_count = (size_t)vulkan->num_extensions;
    desc.queue_families = families;
    for (int i = 0; i < vulkan->num_queues && i < 8; ++i) {
        families[desc.queue_family_count++] = vulkan->queues[i].index;
    }
    done(vxt_context_create(&desc, &d->context));
}

/* The engine's own image, as long as the engine has it. */
static void wrap_volume(detection* d) {
    vxt_wrapped_volume wrapped = {.struct_size = sizeof wrapped};
    VkImage image = pl_vulkan_unwrap(d->engine->vulkan->gpu, d->engine->volume, &wrapped.format, NULL);
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_3D,
                                  .format = wrapped.format,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vulkan_done(LOAD(d, vkCreateImageView)(d->engine->vulkan->device, &info, NULL, &d->view));
    wrapped.view = d->view;
    for (int axis = 0; axis < 3; ++axis) {
        wrapped.grid.size[axis] = SIDE;
        wrapped.grid.origin[axis] = -0.5 * (SIDE - 1);
    }
    wrapped.bricks = 1; /* for the certified detector */
    done(vxt_volume_wrap(d->context, &wrapped, &d->volume));
}

static void upload_the_rest(detection* d) {
    const vxt_queue queue = {.struct_size = sizeof queue,
                             .queue = d->queue,
                             .family = d->engine->vulkan->queue_graphics.index,
                             .lock = lock_queue,
                             .unlock = unlock_queue,
                             .user = d->engine};
    const vxt_control_point points[2] = {{120, 0}, {135, 1}};
    const vxt_transfer_function_desc opacity = {.struct_size = sizeof opacity, .points = points, .point_count = 2};
    done(vxt_transfer_function_upload(d->context, &queue, &opacity, NULL, &d->opacity));
    const double positions[12] = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0}; /* a plate of 4 mm by 4 mm */
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const vxt_mesh_view mesh = {
        .struct_size = sizeof mesh, .positions = positions, .vertex_count = 4, .indices = indices, .triangle_count = 2};
    done(vxt_mesh_upload(d->context, &queue, &mesh, NULL, &d->mesh));
}

static void make_detectors(detection* d) {
    const vxt_raster_desc desc = {.struct_size = sizeof desc, .method = vxt_context_default_method(d->context)};
    done(vxt_detector_create_raster(d->context, &desc, &d->counting));
    done(vxt_detector_create_certified(d->context, NULL, &d->certified));
    const vxt_results_desc room = {.struct_size = sizeof room, .max_pairs = POSES};
    done(vxt_results_create(d->counting, &room, &d->results[0]));
    done(vxt_results_create(d->certified, &room, &d->results[1]));
}

static void make_commands(detection* d) {
    VkDevice device = d->engine->vulkan->device;
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = d->engine->vulkan->queue_graphics.index};
    vulkan_done(LOAD(d, vkCreateCommandPool)(device, &pool, NULL, &d->pool));
    VkCommandBufferAllocateInfo buffers = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = d->pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    vulkan_done(LOAD(d, vkAllocateCommandBuffers)(device, &buffers, &d->commands));
    VkSemaphoreTypeCreateInfo timeline = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                          .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &timeline};
    vulkan_done(LOAD(d, vkCreateSemaphore)(device, &semaphore, NULL, &d->turns));
}

static void begin(detection* d, engine* e) {
    memset(d, 0, sizeof *d);
    d->engine = e;
    d->load = e->instance->get_proc_addr;
    LOAD(d, vkGetDeviceQueue)(e->vulkan->device, e->vulkan->queue_graphics.index, 0, &d->queue);
    make_context(d);
    wrap_volume(d);
    upload_the_rest(d);
    make_detectors(d);
    make_commands(d);
}

static void record(detection* d) {
    const vxt_voxel_box everything = {{0, 0, 0}, {SIDE, SIDE, SIDE}};
    double poses[POSES][16] = {{0}};
    vxt_view view = {{0}, 64, 64}; /* 8 mm by 8 mm of the world's x and y */
    for (int i = 0; i < 16; i += 5) {
        view.clip_from_world[i] = poses[0][i] = poses[1][i] = 1;
    }
    poses[0][12] = -1; /* 1 mm towards -x, and 4 mm towards +x */
    poses[1][12] = 4;
    view.clip_from_world[0] = view.clip_from_world[5] = 0.25;
    view.clip_from_world[10] = 0.1;
    view.clip_from_world[14] = 0.5;
    const vxt_item item = {.struct_size = sizeof item,
                           .mesh = d->mesh,
                           .volume = d->volume,
                           .transfer_function = d->opacity,
                           .world_from_object = poses[0],
                           .pose_count = POSES};
    const vxt_batch batch = {.struct_size = sizeof batch, .items = &item, .item_count = 1, .view = &view};
    VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vulkan_done(LOAD(d, vkBeginCommandBuffer)(d->commands, &info));
    done(vxt_volume_cmd_update_bricks(d->volume, d->commands, &everything)); /* the engine has changed its image */
    done(vxt_detector_cmd_detect(d->counting, d->commands, &batch, d->results[0]));
    done(vxt_detector_cmd_detect(d->certified, d->commands, &batch, d->results[1]));
    done(vxt_results_cmd_read_back(d->results[0], d->commands));
    done(vxt_results_cmd_read_back(d->results[1], d->commands));
    vulkan_done(LOAD(d, vkEndCommandBuffer)(d->commands));
}

/* The image goes from the engine to voxtact and back; the turns are values of one timeline semaphore. */
static void submit(detection* d) {
    pl_gpu gpu = d->engine->vulkan->gpu;
    const uint64_t handed_over = ++d->turn;
    const uint64_t given_back = ++d->turn;
    need(pl_vulkan_hold(gpu, d->engine->volume, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        (pl_vulkan_sem){d->turns, handed_over}),
         "the engine does not hand over its image");
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkTimelineSemaphoreSubmitInfo values = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                            .waitSemaphoreValueCount = 1,
                                            .pWaitSemaphoreValues = &handed_over,
                                            .signalSemaphoreValueCount = 1,
                                            .pSignalSemaphoreValues = &given_back};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &values,
                         .waitSemaphoreCount = 1,
                         .pWaitSemaphores = &d->turns,
                         .pWaitDstStageMask = &stage,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &d->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &d->turns};
    lock_queue(d->engine);
    const VkResult submitted = LOAD(d, vkQueueSubmit)(d->queue, 1, &info, VK_NULL_HANDLE);
    unlock_queue(d->engine);
    vulkan_done(submitted);
    pl_vulkan_release(gpu, d->engine->volume, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                      (pl_vulkan_sem){d->turns, given_back});
    VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &d->turns,
                                .pValues = &given_back};
    vulkan_done(LOAD(d, vkWaitSemaphores)(d->engine->vulkan->device, &wait, UINT64_MAX));
}

static const void* value_of(const vxt_answer* answer, const char* name, size_t pair) {
    vxt_column column = {.struct_size = sizeof column};
    done(vxt_answer_find(answer, "pairs", name, &column));
    return (const char*)column.data + pair * column.stride;
}

static void detect(detection* d) {
    record(d);
    submit(d);
    vxt_answer* answer;
    done(vxt_answer_create(&answer));
    done(vxt_results_read(d->results[0], answer));
    printf("%s: %llu and %llu fragments; ", vxt_method_name(*(const vxt_method*)value_of(answer, "method", 0)),
           (unsigned long long)*(const uint64_t*)value_of(answer, "count", 0),
           (unsigned long long)*(const uint64_t*)value_of(answer, "count", 1));
    done(vxt_results_read(d->results[1], answer));
    printf("certified: %s and %s\n", *(const uint32_t*)value_of(answer, "touch", 0) == 1 ? "yes" : "no",
           *(const uint32_t*)value_of(answer, "touch", 1) == 1 ? "yes" : "no");
    vxt_answer_destroy(answer);
}

static void end(detection* d) {
    VkDevice device = d->engine->vulkan->device;
    pl_gpu_finish(d->engine->vulkan->gpu);
    vulkan_done(LOAD(d, vkDeviceWaitIdle)(device));
    for (int i = 0; i < 2; ++i) {
        vxt_results_destroy(d->results[i]);
    }
    vxt_detector_destroy(d->certified);
    vxt_detector_destroy(d->counting);
    vxt_mesh_destroy(d->mesh);
    vxt_transfer_function_destroy(d->opacity);
    vxt_volume_destroy(d->volume);
    vxt_context_destroy(d->context);
    LOAD(d, vkDestroyImageView)(device, d->view, NULL);
    LOAD(d, vkDestroySemaphore)(device, d->turns, NULL);
    LOAD(d, vkDestroyCommandPool)(device, d->pool, NULL);
}

static bool is_validated(const engine* e) {
    for (int i = 0; i < e->instance->num_layers; ++i) {
        if (strcmp(e->instance->layers[i], "VK_LAYER_KHRONOS_validation") == 0) {
            return true;
        }
    }
    return false;
}

int main(void) {
    engine e;
    memset(&e, 0, sizeof e);
    open_device(&e);
    printf("validation %s\n", is_validated(&e) ? "on" : "off");
    make_images(&e);
    fill_volume(&e, SIDE / 2);
    detection d;
    begin(&d, &e);

    printf("frame: %d bright pixels\n", draw(&e));
    detect(&d);
    fill_volume(&e, SIDE / 2 - 1);
    printf("frame: %d bright pixels\n", draw(&e));
    detect(&d);

    end(&d);
    pl_buf_destroy(e.vulkan->gpu, &e.pixels);
    pl_buf_destroy(e.vulkan->gpu, &e.voxels);
    pl_tex_destroy(e.vulkan->gpu, &e.picture);
    pl_tex_destroy(e.vulkan->gpu, &e.volume);
    pl_dispatch_destroy(&e.dispatch);
    pl_vulkan_destroy(&e.vulkan);
    pl_vk_inst_destroy(&e.instance);
    pl_log_destroy(&e.log);
    return e.complaints == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
