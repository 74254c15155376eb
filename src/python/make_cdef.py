# SPDX-License-Identifier: MIT
"""Makes voxtact/_cdef.py, the C declarations for cffi, from voxtact_vulkan.h and the headers that it includes.

usage: make_cdef.py OUTPUT INCLUDE
"""
import pathlib
import re
import sys

import cffi

# What the headers take from Vulkan's. Handles are pointers on every machine of 64 bits.
HANDLES = ("VkInstance VkPhysicalDevice VkDevice VkQueue VkCommandBuffer VkPipelineCache VkImage VkImageView "
           "VkBuffer VkDeviceMemory VkQueryPool").split()
STRUCTS = "VkPhysicalDeviceFeatures2 VkAllocationCallbacks".split()
NUMBERS = "VkFormat VkImageLayout VkIndexType VkResult".split()
VULKAN = "\n".join([*(f"typedef struct {name}_T* {name};" for name in HANDLES),
                    *(f"typedef struct {name} {name};" for name in STRUCTS),
                    *(f"typedef int32_t {name};" for name in NUMBERS),
                    "typedef uint64_t VkDeviceSize;",
                    "typedef uint32_t VkMemoryPropertyFlags;",
                    "typedef struct VkMemoryRequirements { VkDeviceSize size; VkDeviceSize alignment; uint32_t memoryTypeBits; } "
                    "VkMemoryRequirements;",
                    "typedef void* PFN_vkGetInstanceProcAddr;",
                    "typedef struct VkOffset2D { int32_t x; int32_t y; } VkOffset2D;",
                    "typedef struct VkExtent2D { uint32_t width; uint32_t height; } VkExtent2D;",
                    "typedef struct VkRect2D { VkOffset2D offset; VkExtent2D extent; } VkRect2D;"])


def expanded(folder, name, seen):
    """Returns the text of a header, with the headers of voxtact that it includes, each once."""
    if name in seen:
        return ""
    seen.add(name)
    return re.sub(r'^#include "(.+)"$', lambda found: expanded(folder, found[1], seen),
                  (folder / name).read_text(encoding="utf-8"), flags=re.MULTILINE)


def declarations(text):
    """Returns types and functions, without comments, preprocessor directives and inline functions."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    text = re.sub(r"^#ifdef __cplusplus\n.*?^#endif\n", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^#(?:.*\\\n)*.*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^static inline .*?^}\n", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"\bVXT_(API|CHECKED)\s+", "", text)
    return re.sub(r"\n\s*\n+", "\n", text)


def main():
    output, include = sys.argv[1:]
    made = cffi.FFI()
    made.set_source("voxtact._cdef", None)
    made.cdef(VULKAN + "\n" + declarations(expanded(pathlib.Path(include), "voxtact/voxtact_vulkan.h", set())))
    made.emit_python_code(output)


if __name__ == "__main__":
    main()
