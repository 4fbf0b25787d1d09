# eomgen_embed(TARGET OUTPUT FOLDER folder FILES a b/c HEADER h NAMESPACE ns TYPE T FUNCTION f): text files of the source
# tree in a library, so that the installed program needs no data files (embed_files.cmake).
function(eomgen_embed target output)
  cmake_parse_arguments(ARG "" "FOLDER;HEADER;NAMESPACE;TYPE;FUNCTION" "FILES" ${ARGN})
  list(TRANSFORM ARG_FILES PREPEND ${ARG_FOLDER}/ OUTPUT_VARIABLE paths)
  list(JOIN ARG_FILES "," names)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${output})
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${ARG_FOLDER} -DFILES=${names} -DOUTPUT=${source} -DHEADER=${ARG_HEADER}
      -DNAMESPACE=${ARG_NAMESPACE} -DTYPE=${ARG_TYPE} -DFUNCTION=${ARG_FUNCTION} -P ${script}
    DEPENDS ${paths} ${script}
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
  # GCC and Clang take literals of any length; the standard promises 65536 characters, which pages of docs exceed.
  set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -Wno-overlength-strings)
endfunction()
