# The warnings that all of our own code is clean under; an interface target, so that it never leaks to users of the libraries.
add_library(eomgen_warnings INTERFACE)
target_compile_options(eomgen_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
