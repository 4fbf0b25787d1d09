# Warnings enabled for all code of the project. An interface target, so that they do not leak to users of the libraries.
# Other compilers may warn more, so only the presets for developers treat warnings as errors.
add_library(eomgen_warnings INTERFACE)
target_compile_options(eomgen_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion $<$<BOOL:${EOMGEN_WERROR}>:-Werror>
  # Where several files are one, a name in one of them is no outer scope of another, and no file is a header.
  $<$<BOOL:${EOMGEN_UNITY}>:-Wno-shadow> $<$<AND:$<BOOL:${EOMGEN_UNITY}>,$<COMPILE_LANG_AND_ID:CXX,GNU>>:-Wno-subobject-linkage>)
