# Finds minizip and zlib; defines Minizip::minizip.
find_path(EOMGEN_MINIZIP_INCLUDE minizip/zip.h)
find_library(EOMGEN_MINIZIP_LIBRARY minizip)
find_library(EOMGEN_ZLIB_LIBRARY z)
mark_as_advanced(EOMGEN_MINIZIP_INCLUDE EOMGEN_MINIZIP_LIBRARY EOMGEN_ZLIB_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Minizip
  REQUIRED_VARS EOMGEN_MINIZIP_LIBRARY EOMGEN_ZLIB_LIBRARY EOMGEN_MINIZIP_INCLUDE
  REASON_FAILURE_MESSAGE "install libminizip-dev and zlib1g-dev (scripts/setup does)")
if(Minizip_FOUND AND NOT TARGET Minizip::minizip)
  add_library(Minizip::minizip INTERFACE IMPORTED)
  target_include_directories(Minizip::minizip INTERFACE ${EOMGEN_MINIZIP_INCLUDE})
  target_link_libraries(Minizip::minizip INTERFACE ${EOMGEN_MINIZIP_LIBRARY} ${EOMGEN_ZLIB_LIBRARY})
endif()
