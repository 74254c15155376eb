# SPDX-License-Identifier: MIT
# What Doxygen reads of a header: the tables in comments as tables, and comments for what every class has and no header
# says again.
match($0, /^ *\/\/\/   /) { # a row of a table: Markdown takes it for code, once it is apart and indented enough
    margin = substr($0, 1, index($0, "/") - 1)
    if (!table) {
        print margin "///"
    }
    table = 1
    print margin "///         " substr($0, RLENGTH + 1)
    next
}

{
    margin = $0
    sub(/[^ ].*/, "", margin)
    if (table) {
        print margin "///"
    }
    table = 0
}

/^ *VOXTACT_API [A-Za-z]+\([A-Za-z]+&&\) noexcept;/ {
    print margin "/// Takes over what the other one has; that one may then only be assigned to or destroyed."
}

/^ *VOXTACT_API [A-Za-z]+& operator=\([A-Za-z]+&&\) noexcept;/ {
    print margin "/// The same, in the place of what this one had."
}

/^ *\[\[nodiscard\]\] (const )?[A-Za-z]+& impl\(\) const noexcept / {
    print margin "/// For voxtact's own parts."
}

{ print }
