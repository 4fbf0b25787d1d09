# cmake -DINPUT=file -DOUTPUT=header -DVARIABLE=name -DNAMESPACE=ns -P embed_bytes.cmake
# Writes a header with the bytes of a file as a constant std::string_view.
file(SIZE "${INPUT}" size)
file(READ "${INPUT}" bytes HEX)
string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
file(WRITE "${OUTPUT}.tmp" "#pragma once\n#include <string_view>\nnamespace ${NAMESPACE} {\n"
  "inline constexpr std::string_view ${VARIABLE}(\"${bytes}\", ${size});\n}\n")
file(RENAME "${OUTPUT}.tmp" "${OUTPUT}")
