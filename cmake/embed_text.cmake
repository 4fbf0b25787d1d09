# cmake -DINPUT=file -DOUTPUT=header -DVARIABLE=name -DNAMESPACE=ns -P embed_text.cmake
# Writes a header with the text as a constant, so that the installed program needs no data files.
file(READ "${INPUT}" text)
string(FIND "${text}" ")EOMTEXT" clash)
if(NOT clash EQUAL -1)
  message(FATAL_ERROR "${INPUT} contains the delimiter of the raw string")
endif()
file(WRITE "${OUTPUT}.tmp"
  "#pragma once\nnamespace ${NAMESPACE} {\ninline constexpr const char* ${VARIABLE} = R\"EOMTEXT(${text})EOMTEXT\";\n}\n")
file(RENAME "${OUTPUT}.tmp" "${OUTPUT}")
