# SPDX-License-Identifier: MIT
# cmake -DFILE=font.ttf -DNAME=kFont -DHEADER=app/draw/font.h -DOUT=font.cpp -P embed_bytes.cmake
# Writes a file as an array of bytes.
file(READ "${FILE}" hex HEX)
string(LENGTH "${hex}" digits)
math(EXPR bytes "${digits} / 2")
string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," list "${hex}")
file(WRITE "${OUT}" "#include \"${HEADER}\"\n\nnamespace voxtact::app {\n\nconst unsigned char ${NAME}[] = {\n${list}};\n"
                    "const std::size_t ${NAME}Bytes = ${bytes};\n\n} // namespace voxtact::app\n")
