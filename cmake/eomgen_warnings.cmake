# The warnings that all of our own code is clean under; an interface target, so that it never leaks to users of the libraries.
# Another compiler may warn of more, so that only the presets, which developers use, end the build there.
add_library(eomgen_warnings INTERFACE)
target_compile_options(eomgen_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion $<$<BOOL:${EOMGEN_WERROR}>:-Werror>)
