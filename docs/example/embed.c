/* SPDX-License-Identifier: MIT */
/* The same small embedder as embed.cpp, in C: how much of a plate is inside the opaque half of a volume, asked of the
   host engine, which needs no device, and then of a Vulkan device that this program makes and keeps.

   Exit status: 0 done, 1 something failed, 77 there is no Vulkan device. */
#include "voxtact/voxtact_vulkan.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXIT_NO_DEVICE = 77, SIDE = 8, VOXELS = SIDE * SIDE * SIDE };

static void quit(int status, const char* why) {
    fprintf(stderr, "embed: %s\n", why);
    exit(status);
}

/* voxtact throws nothing: this program ends with the first error. */
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

/* What both engines are asked about: host memory of the caller's. */
typedef struct scene {
    uint8_t voxels[VOXELS]; /* 1 mm each, centred on the world's origin: 255 where x < 0, else 0 */
    vxt_volume_view volume;
    vxt_control_point points[2];
    vxt_transfer_function_desc opacity;
    double positions[12]; /* a plate of 4 mm by 4 mm around its own origin */
    uint32_t indices[6];
    vxt_mesh_view mesh;
    double world_from_object[16];
    vxt_view view; /* 8 mm by 8 mm of the world's x and y on 64x64 pixels */
} scene;

static void make_volume(scene* s) {
    for (int i = 0; i < VOXELS; ++i) {
        s->voxels[i] = i % SIDE < SIDE / 2 ? 255 : 0;
    }
    s->volume.struct_size = sizeof s->volume; /* what is not set is 0, which stands for the default */
    s->volume.voxels = s->voxels;
    s->volume.bytes = sizeof s->voxels;
    for (int axis = 0; axis < 3; ++axis) {
        s->volume.grid.size[axis] = SIDE;
        s->volume.grid.origin[axis] = -3.5;
    }
    s->points[0].value = 120;
    s->points[0].opacity = 0;
    s->points[1].value = 135;
    s->points[1].opacity = 1;
    s->opacity.struct_size = sizeof s->opacity;
    s->opacity.points = s->points;
    s->opacity.point_count = 2;
}

static void make_mesh(scene* s) {
    const double positions[12] = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0};
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    memcpy(s->positions, positions, sizeof positions);
    memcpy(s->indices, indices, sizeof indices);
    s->mesh.struct_size = sizeof s->mesh;
    s->mesh.positions = s->positions;
    s->mesh.vertex_count = 4;
    s->mesh.indices = s->indices;
    s->mesh.triangle_count = 2;
}

static void make_scene(scene* s) {
    memset(s, 0, sizeof *s);
    make_volume(s);
    make_mesh(s);
    for (int i = 0; i < 16; i += 5) {
        s->world_from_object[i] = 1;
        s->view.clip_from_world[i] = 1;
    }
    s->world_from_object[12] = -1; /* 1 mm towards -x */
    s->view.clip_from_world[0] = 0.25;
    s->view.clip_from_world[5] = 0.25;
    s->view.clip_from_world[10] = 0.1;
    s->view.clip_from_world[14] = 0.5;
    s->view.width = s->view.height = 64;
}

/* Of the first pair. An answer is a table of columns. */
static const void* value_of(const vxt_answer* answer, const char* name) {
    vxt_column column = {.struct_size = sizeof column};
    done(vxt_answer_find(answer, "pairs", name, &column));
    return column.data;
}

static void print_answer(const vxt_answer* answer) {
    const uint32_t touch = *(const uint32_t*)value_of(answer, "touch"); /* 0 no, 1 yes, 2 undecided */
    const uint64_t count = *(const uint64_t*)value_of(answer, "count");
    printf("touch %u, %llu fragments, method %s\n", (unsigned)touch, (unsigned long long)count,
           vxt_method_name(*(const vxt_method*)value_of(answer, "method")));
}

/* Without a device. */
static void ask_the_host(const scene* s, vxt_answer* answer) {
    vxt_host_volume* volume;
    vxt_host_transfer_function* opacity;
    vxt_host_mesh* mesh;
    vxt_host_engine* engine;
    done(vxt_host_volume_create(&s->volume, &volume));
    done(vxt_host_transfer_function_create(&s->opacity, &opacity));
    done(vxt_host_mesh_create(&s->mesh, &mesh));
    done(vxt_host_engine_create(0, &engine));

    const vxt_host_item item = {.mesh = mesh,
                                .volume = volume,
                                .transfer_function = opacity,
                                .world_from_object = s->world_from_object,
                                .pose_count = 1};
    const vxt_pairs pairs = {.struct_size = sizeof pairs, .items = &item, .item_count = 1, .view = &s->view};
    done(vxt_ask(engine, "count", NULL, 0, &pairs, answer)); /* no settings: all defaults */
    print_answer(answer);
    const vxt_setting tolerance = {.name = "tolerance", .number = 0.1};
    done(vxt_ask(engine, "distance", &tolerance, 1, &pairs, answer));
    printf("distance %g to %g mm\n", *(const double*)value_of(answer, "lower"),
           *(const double*)value_of(answer, "upper"));

    vxt_host_engine_destroy(engine);
    vxt_host_mesh_destroy(mesh);
    vxt_host_transfer_function_destroy(opacity);
    vxt_host_volume_destroy(volume);
}

/* What an engine has long before it meets voxtact. */
typedef struct renderer {
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    vxt_features* features; /* what the device was made with */
    VkCommandPool pool;
    VkCommandBuffer commands;
} renderer;

#define LOAD(r, name) ((PFN_##name)(r)->get_instance_proc_addr((r)->instance, #name))

static void make_instance(renderer* r) {
    void* loader = dlopen("libvulkan.so.1", RTLD_NOW);
    if (loader == NULL) {
        quit(EXIT_NO_DEVICE, "there is no Vulkan loader");
    }
    void* symbol = dlsym(loader, "vkGetInstanceProcAddr");
    memcpy(&r->get_instance_proc_addr, &symbol, sizeof symbol);
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    if (LOAD(r, vkCreateInstance)(&info, NULL, &r->instance) != VK_SUCCESS) {
        quit(EXIT_NO_DEVICE, "there is no Vulkan driver");
    }
    uint32_t one = 1;
    const VkResult found = LOAD(r, vkEnumeratePhysicalDevices)(r->instance, &one, &r->physical_device);
    if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || one == 0) {
        quit(EXIT_NO_DEVICE, "there is no Vulkan device");
    }
}

static uint32_t graphics_family(const renderer* r) {
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    LOAD(r, vkGetPhysicalDeviceQueueFamilyProperties)(r->physical_device, &count, families);
    for (uint32_t family = 0; family < count; ++family) {
        if ((families[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) {
            return family;
        }
    }
    quit(EXIT_NO_DEVICE, "the device cannot draw");
    return 0;
}

/* voxtact says which features it wants; an engine adds its own to the chain before it makes the device. */
static void make_device(renderer* r) {
    VkPhysicalDeviceFeatures2 supported = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    LOAD(r, vkGetPhysicalDeviceFeatures2)(r->physical_device, &supported);
    done(vxt_features_create(&supported, &r->features));
    r->queue_family = graphics_family(r);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = r->queue_family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = vxt_features_chain(r->features),
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    vulkan_done(LOAD(r, vkCreateDevice)(r->physical_device, &info, NULL, &r->device));
    LOAD(r, vkGetDeviceQueue)(r->device, r->queue_family, 0, &r->queue);
}

static void make_commands(renderer* r) {
    VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .queueFamilyIndex = r->queue_family};
    vulkan_done(LOAD(r, vkCreateCommandPool)(r->device, &info, NULL, &r->pool));
    VkCommandBufferAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = r->pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    vulkan_done(LOAD(r, vkAllocateCommandBuffers)(r->device, &allocation, &r->commands));
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vulkan_done(LOAD(r, vkBeginCommandBuffer)(r->commands, &begin));
}

static void end_frame_and_wait(renderer* r) {
    vulkan_done(LOAD(r, vkEndCommandBuffer)(r->commands));
    VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &r->commands};
    vulkan_done(LOAD(r, vkQueueSubmit)(r->queue, 1, &info, VK_NULL_HANDLE));
    vulkan_done(LOAD(r, vkQueueWaitIdle)(r->queue));
}

static void end_renderer(renderer* r) {
    LOAD(r, vkDestroyCommandPool)(r->device, r->pool, NULL);
    LOAD(r, vkDestroyDevice)(r->device, NULL);
    LOAD(r, vkDestroyInstance)(r->instance, NULL);
    vxt_features_destroy(r->features);
}

static vxt_context* make_context(const renderer* r) {
    const vxt_context_desc desc = {.struct_size = sizeof desc, /* your instance, device and loader */
                                   .get_instance_proc_addr = r->get_instance_proc_addr,
                                   .instance = r->instance,
                                   .physical_device = r->physical_device,
                                   .device = r->device,
                                   .api_version = VK_API_VERSION_1_3,
                                   .enabled_features = vxt_features_chain(r->features)};
    vxt_context* context;
    done(vxt_context_create(&desc, &context));
    return context;
}

/* On the device: what is recorded here stands between the engine's own commands. */
static void ask_the_device(renderer* r, const scene* s, vxt_answer* answer) {
    vxt_context* context = make_context(r);
    const vxt_queue queue = {.struct_size = sizeof queue, .queue = r->queue, .family = r->queue_family};
    const vxt_raster_desc desc = {.struct_size = sizeof desc, .method = vxt_context_default_method(context)};
    vxt_volume* volume;
    vxt_transfer_function* opacity;
    vxt_mesh* mesh;
    vxt_detector* detector;
    vxt_results* results;
    done(vxt_volume_upload(context, &queue, &s->volume, NULL, &volume));
    done(vxt_transfer_function_upload(context, &queue, &s->opacity, NULL, &opacity));
    done(vxt_mesh_upload(context, &queue, &s->mesh, NULL, &mesh));
    done(vxt_detector_create_raster(context, &desc, &detector));
    done(vxt_results_create(detector, NULL, &results));

    const vxt_item item = {.struct_size = sizeof item,
                           .mesh = mesh,
                           .volume = volume,
                           .transfer_function = opacity,
                           .world_from_object = s->world_from_object,
                           .pose_count = 1};
    const vxt_batch batch = {.struct_size = sizeof batch, .items = &item, .item_count = 1, .view = &s->view};
    done(vxt_detector_cmd_detect(detector, r->commands, &batch, results)); /* only records */
    done(vxt_results_cmd_read_back(results, r->commands));
    end_frame_and_wait(r);
    done(vxt_results_read(results, answer));
    print_answer(answer);

    vxt_results_destroy(results);
    vxt_detector_destroy(detector);
    vxt_mesh_destroy(mesh);
    vxt_transfer_function_destroy(opacity);
    vxt_volume_destroy(volume);
    vxt_context_destroy(context);
}

int main(void) {
    scene s;
    make_scene(&s);
    vxt_answer* answer;
    done(vxt_answer_create(&answer));
    ask_the_host(&s, answer);

    renderer r;
    memset(&r, 0, sizeof r);
    make_instance(&r);
    make_device(&r);
    make_commands(&r);
    ask_the_device(&r, &s, answer);
    end_renderer(&r);
    vxt_answer_destroy(answer);
    return EXIT_SUCCESS;
}
