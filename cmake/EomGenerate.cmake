# eom_generate(TARGET name MODEL file [WITH jac mass ...] [OUTPUT energy ...] [FIX g ...] [APPROACH I|II] [FORM name])
#
# Adds a static library `name` with the C code that eomgen generates for the model (docs/abi.md). Targets that link it can
# include NAME.h and NAME.hpp, where NAME is the base name of the file as an identifier; the target property EOM_NAME
# contains it. The code is generated at build time, and again if the model or eomgen is newer. WITH, OUTPUT, FIX,
# APPROACH, FORM are the options of `eomgen emit`. A relative MODEL refers to the current source folder; shipped models
# are in ${eomgen_MODELS_DIR}.
include_guard(GLOBAL)

# Asks eomgen for NAME of the C ABI: `int.toml` becomes int_, for example, because C reserves int.
function(_eom_name model result)
  get_target_property(program eomgen::cli LOCATION)
  execute_process(COMMAND "${program}" emit "${model}" -o . --print-name
    OUTPUT_VARIABLE name OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_VARIABLE problem RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "eom_generate: ${program} does not tell the name of ${model}: ${problem}")
  endif()
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

function(_eom_refuse what)
  message(FATAL_ERROR "eom_generate: ${what}\n"
    "  usage: eom_generate(TARGET name MODEL file [WITH jac ...] [OUTPUT energy ...] [FIX g ...] [APPROACH I|II] [FORM name])")
endfunction()

# Converts ARG_WITH, .. to the options of `eomgen emit`, which separate lists by commas.
function(_eom_options result)
  set(options)
  foreach(list WITH OUTPUT FIX APPROACH FORM)
    if(ARG_${list})
      string(TOLOWER "${list}" flag)
      list(JOIN ARG_${list} "," value)
      list(APPEND options "--${flag}" "${value}")
    endif()
  endforeach()
  set(${result} "${options}" PARENT_SCOPE)
endfunction()

function(eom_generate)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "TARGET;MODEL;APPROACH;FORM" "WITH;OUTPUT;FIX")
  if(NOT ARG_TARGET OR NOT ARG_MODEL)
    _eom_refuse("TARGET and MODEL are needed")
  elseif(ARG_UNPARSED_ARGUMENTS)
    _eom_refuse("'${ARG_UNPARSED_ARGUMENTS}' is not understood")
  elseif(NOT TARGET eomgen::cli)
    message(FATAL_ERROR "eom_generate: this eomgen was built without its generator, so there is no eomgen::cli")
  elseif(NOT CMAKE_C_COMPILER_LOADED)
    message(FATAL_ERROR "eom_generate: the generated code is C; enable it: project(${PROJECT_NAME} LANGUAGES C ..)")
  endif()
  get_filename_component(model "${ARG_MODEL}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
  if(NOT EXISTS "${model}")
    _eom_refuse("there is no model ${model}")
  endif()
  _eom_name("${model}" name)
  _eom_options(options)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${ARG_TARGET}_eom")
  set(files "${folder}/${name}.c" "${folder}/${name}.h" "${folder}/${name}.hpp")
  if("run" IN_LIST ARG_WITH)
    list(APPEND files "${folder}/${name}_run.hpp")
  endif()
  add_custom_command(OUTPUT ${files}
    COMMAND eomgen::cli emit "${model}" -o "${folder}" --target cpp ${options}
    DEPENDS "${model}" "$<TARGET_FILE:eomgen::cli>"
    COMMENT "Generating the equations of motion of ${name}"
    VERBATIM)
  add_library(${ARG_TARGET} STATIC ${files})
  target_include_directories(${ARG_TARGET} PUBLIC "${folder}")
  set_target_properties(${ARG_TARGET} PROPERTIES
    C_STANDARD 11 POSITION_INDEPENDENT_CODE ON LINKER_LANGUAGE C EOM_NAME "${name}")
  if(UNIX)
    target_link_libraries(${ARG_TARGET} PUBLIC m)
  endif()
endfunction()
