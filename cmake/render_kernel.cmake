# cmake -DKERNEL=sincos.mustache -DLANES=sincos_lanes.mustache -DOUTPUT=file -P render_kernel.cmake
# Writes the kernel for sines and cosines of two angles in double precision as C++, as emitted code has it in C.
file(READ "${KERNEL}" text)
file(READ "${LANES}" lanes)
string(REPLACE "{{lanes}}" "${lanes}" text "${text}")
foreach(pair "prefix=kernel_" "inline=inline" "std=std::" "real=double" "bits=unsigned long long" "f=" "far=65536" "reach=65536.0"
    "kept=FLT_EVAL_METHOD == 0")
  string(REGEX MATCH "^([a-z]+)=(.*)$" matched "${pair}")
  string(REPLACE "{{${CMAKE_MATCH_1}}}" "${CMAKE_MATCH_2}" text "${text}")
endforeach()
if(text MATCHES "{{")
  message(FATAL_ERROR "a placeholder of ${KERNEL} is not replaced")
endif()
file(WRITE "${OUTPUT}" "${text}")
