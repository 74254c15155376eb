#!/bin/sh
# SPDX-License-Identifier: MIT
# What Doxygen reads of a header: comments for what every class has and no header says again.
exec sed -E \
    -e 's#^( *)(VOXTACT_API [A-Za-z]+\([A-Za-z]+&&\) noexcept;)#\1/// Takes over what the other one has; that one may then only be assigned to or destroyed.\n\1\2#' \
    -e 's#^( *)(VOXTACT_API [A-Za-z]+& operator=\([A-Za-z]+&&\) noexcept;)#\1/// The same, in the place of what this one had.\n\1\2#' \
    -e "s#^( *)(\[\[nodiscard\]\] (const )?[A-Za-z]+& impl\(\) const noexcept .*)#\1/// For voxtact's own parts.\n\1\2#" \
    "$1"
