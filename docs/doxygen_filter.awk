# SPDX-License-Identifier: MIT
# What Doxygen reads of a header: the tables in comments as tables, and comments for what every class, struct or object
# of C has and no header says again.
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

!commented && /^VXT_API void vxt_[a-z_]+_destroy\(/ {
    print "/// Destroys the object; accepts null."
}

!commented && /^VXT_CHECKED vxt_result vxt_[a-z_]+_cmd_upload\(/ {
    print "/// Records the copy to the device."
}

!commented && !/_cmd_upload\(/ && /^VXT_CHECKED vxt_result vxt_[a-z_]+_upload\(/ {
    print "/// Creates and uploads in one call: submits on `queue` and waits."
}

/^VXT_API void vxt_[a-z_]+_release_staging\(/ {
    print "/// Frees the staging buffer. The submission of the upload must be complete."
}

/^ *size_t struct_size;$/ {
    $0 = $0 " ///< sizeof this struct"
}

/^ *VXT_[A-Z_]+_MAX = 0x7fffffff$/ {
    $0 = $0 " ///< makes the type 32 bits wide"
}

{
    print
    commented = /^ *\/\/\//
}
