# cmake -DFOLDER=folder -DFILES=a,b/c -DOUTPUT=file -DHEADER=h -DNAMESPACE=ns -DTYPE=T -DFUNCTION=f -P embed_files.cmake
# Writes a source file with `std::span<const T> f()`: the path and the text of each file. T has these two members.
string(REPLACE "," ";" FILES "${FILES}")
set(entries "")
foreach(file IN LISTS FILES)
  file(READ "${FOLDER}/${file}" text)
  string(FIND "${text}" ")EOM" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${file} contains the delimiter of the raw string")
  endif()
  # A literal is split, because compilers need not accept long ones.
  string(LENGTH "${text}" length)
  set(written "")
  set(from 0)
  while(from LESS length)
    string(SUBSTRING "${text}" ${from} 12000 part)
    string(APPEND written "R\"EOM(${part})EOM\"\n")
    math(EXPR from "${from} + 12000")
  endwhile()
  string(APPEND entries "    {\"${file}\",\n${written}},\n")
endforeach()
file(WRITE "${OUTPUT}.tmp" "#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {
constexpr ${TYPE} files[] = {
${entries}};
}  // namespace
std::span<const ${TYPE}> ${FUNCTION}() { return files; }
}  // namespace ${NAMESPACE}
")
file(RENAME "${OUTPUT}.tmp" "${OUTPUT}")
