# SPDX-License-Identifier: MIT
# To be sourced. What a bundle does not have: the C library's own, which the system has, and what is no file.
# shellcheck disable=SC2034
of_the_system='^(ld-linux.*|linux-vdso|libc|libm|libdl|librt|libpthread|libmvec|libresolv|libutil)\.so'
