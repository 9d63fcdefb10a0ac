# Prints the code block of a page whose first line is "// FILE".
#   awk -v file=NAME -f code_block.awk PAGE
/^```/ { inside = !inside; first = 1; wanted = 0; next }
inside && first { wanted = ($0 == "// " file); first = 0 }
inside && wanted { print; found = 1 }
END { if (!found) exit 1 }
