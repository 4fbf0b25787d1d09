# Finds Cairo; defines Cairo::cairo.
find_path(EOMGEN_CAIRO_INCLUDE cairo/cairo-pdf.h)
find_library(EOMGEN_CAIRO_LIBRARY cairo)
mark_as_advanced(EOMGEN_CAIRO_INCLUDE EOMGEN_CAIRO_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cairo REQUIRED_VARS EOMGEN_CAIRO_LIBRARY EOMGEN_CAIRO_INCLUDE
  REASON_FAILURE_MESSAGE "install libcairo2-dev (scripts/setup does)")
if(Cairo_FOUND AND NOT TARGET Cairo::cairo)
  add_library(Cairo::cairo INTERFACE IMPORTED)
  target_include_directories(Cairo::cairo INTERFACE ${EOMGEN_CAIRO_INCLUDE})
  target_link_libraries(Cairo::cairo INTERFACE ${EOMGEN_CAIRO_LIBRARY})
endif()
