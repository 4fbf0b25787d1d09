# gcc 12 reports false overflows in std::string from precompiled headers: it no longer treats them as system headers.
set(EOMGEN_PRECOMPILED_OPTIONS
  "$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-restrict>")

# eomgen_precompile(TARGET header ...): precompiles headers that most files include. Every file still includes what it
# needs: builds without precompiled headers (with sanitizers) fail otherwise.
function(eomgen_precompile target)
  if(EOMGEN_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
    target_compile_options(${target} PRIVATE ${EOMGEN_PRECOMPILED_OPTIONS})
  endif()
endfunction()

# eomgen_take_precompiled(TARGET OWNER): uses the precompiled headers of another target with the same options.
function(eomgen_take_precompiled target owner)
  if(EOMGEN_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${owner})
    target_compile_options(${target} PRIVATE ${EOMGEN_PRECOMPILED_OPTIONS})
  endif()
endfunction()

# eomgen_unite(TARGET): with EOMGEN_UNITY, compiles the sources of a target in groups, each as one file. Headers and templates
# are then read once for a group. Names of one file (in its anonymous namespace) must differ from those of the others of its
# target; tests/architecture requires it of the stages.
function(eomgen_unite target)
  if(EOMGEN_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()

# eomgen_headers(FOLDER [FILE ...]): the target eomgen_headers_FOLDER, which makes the headers of generator/FOLDER visible as
# "FOLDER/file.hpp", and no others: a folder of its own has a link to it. With files: these of generator/, as "file.hpp".
function(eomgen_headers folder)
  if(TARGET eomgen_headers_${folder})
    return()
  endif()
  set(root ${PROJECT_BINARY_DIR}/headers/${folder})
  file(MAKE_DIRECTORY ${root})
  foreach(name IN LISTS ARGN)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/generator/${name} ${root}/${name} SYMBOLIC)
  endforeach()
  if(NOT ARGN)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/generator/${folder} ${root}/${folder} SYMBOLIC)
  endif()
  add_library(eomgen_headers_${folder} INTERFACE)
  target_include_directories(eomgen_headers_${folder} INTERFACE $<BUILD_INTERFACE:${root}>)
endfunction()

# eomgen_stage(NAME [OWN_HEADERS] [UNOPTIMISED] SOURCES a.cpp ... NEEDS other_stage ... READS folder ... LINKS external::target ...)
# One static library per stage. NEEDS is the dependency rule: a stage sees the headers of its own folder, and of the stages
# that it needs, directly or not. They must be declared before it, so there are no cycles. READS: folders whose headers are
# data only, without the libraries behind them.
# OWN_HEADERS: no shared precompiled headers.
# UNOPTIMISED: not critical for run time, contains no integrator; lower optimisation saves a quarter of the compile time.
function(eomgen_stage name)
  cmake_parse_arguments(ARG "OWN_HEADERS;UNOPTIMISED" "" "SOURCES;NEEDS;READS;LINKS" ${ARGN})
  add_library(eomgen_${name} STATIC ${ARG_SOURCES})
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME own)
  foreach(folder IN ITEMS ${own} ${ARG_READS})
    eomgen_headers(${folder})
    target_link_libraries(eomgen_${name} PUBLIC eomgen_headers_${folder})
  endforeach()
  target_link_libraries(eomgen_${name} PRIVATE eomgen_warnings)
  foreach(stage IN LISTS ARG_NEEDS)
    if(NOT TARGET eomgen_${stage})
      message(FATAL_ERROR "The stage ${name} needs ${stage}, which generator/CMakeLists.txt adds after it, or which does not exist")
    endif()
    target_link_libraries(eomgen_${name} PUBLIC eomgen_${stage})
  endforeach()
  target_link_libraries(eomgen_${name} PUBLIC ${ARG_LINKS})
  eomgen_unite(eomgen_${name})
  if(ARG_UNOPTIMISED)
    target_compile_options(eomgen_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(ARG_NEEDS AND NOT ARG_OWN_HEADERS)  # stages without are tables
    eomgen_take_precompiled(eomgen_${name} eomgen_error)
  endif()
endfunction()

# eomgen_registered(FOLDER RESULT): NAME.cpp for each line WORD(NAME) of generator/FOLDER/registry.inc; CMake runs again if it changes.
function(eomgen_registered folder result)
  set(registry ${PROJECT_SOURCE_DIR}/generator/${folder}/registry.inc)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${registry})
  file(STRINGS ${registry} lines REGEX "^[A-Z]+\\(.*\\)$")
  list(TRANSFORM lines REPLACE "^[A-Z]+\\((.*)\\)$" "\\1.cpp")
  set(${result} ${lines} PARENT_SCOPE)
endfunction()

# Compilation dominates the time of testing, so tests use lower optimisation. Their libraries use the same options as
# their programs, so that they share precompiled headers.
set(EOMGEN_TEST_OPTIONS $<$<CONFIG:Release>:-O1> -fPIE)

# Of programs that wait for their child processes. Those that call the stages keep -O1: the linker takes functions of
# headers from the tests, for the stages too.
set(EOMGEN_DRIVER_OPTIONS $<$<CONFIG:Release>:-O0> -fPIE)

# Headers that most test files include.
set(EOMGEN_TEST_HEADERS <doctest/doctest.h> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional>
  <random> <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector>)

# eomgen_test(NAME [OWN_OPTIONS] SOURCES a.cpp ... LINKS target ...): one doctest executable and one ctest entry.
# OWN_OPTIONS: compiled with options of its own, so it has its own precompiled headers.
function(eomgen_test name)
  cmake_parse_arguments(ARG "OWN_OPTIONS" "" "SOURCES;LINKS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_compile_options(test_${name} PRIVATE ${EOMGEN_TEST_OPTIONS})
  target_link_libraries(test_${name} PRIVATE eomgen_test_main ${ARG_LINKS} eomgen_warnings)
  if(NOT ARG_OWN_OPTIONS)
    eomgen_take_precompiled(test_${name} eomgen_test_main)
  endif()
  eomgen_unite(test_${name})
  add_test(NAME ${name} COMMAND test_${name})
  if(TARGET sanitized AND name IN_LIST EOMGEN_SANITIZED)
    set_tests_properties(${name} PROPERTIES LABELS sanitized)
    add_dependencies(sanitized test_${name})
  endif()
endfunction()
