# SPDX-License-Identifier: MIT
# cmake -DSPV=in.spv -DNAME=view_vert -DOUT=view_vert.h -P embed_spirv.cmake
# Writes a SPIR-V module as an array of 32-bit words.
file(READ "${SPV}" hex HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${hex}")
file(WRITE "${OUT}" "#pragma once\n#include <cstdint>\nnamespace voxtact::spirv {\n"
                    "inline constexpr std::uint32_t ${NAME}[] = {\n${words}};\n}\n")
