# Finds GiNaC and CLN through pkg-config; defines GiNaC::ginac and GiNaC::cln.
find_package(PkgConfig REQUIRED)
pkg_check_modules(EOMGEN_GINAC IMPORTED_TARGET ginac>=1.8)
pkg_check_modules(EOMGEN_CLN IMPORTED_TARGET cln>=1.3)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GiNaC
  REQUIRED_VARS EOMGEN_GINAC_FOUND EOMGEN_CLN_FOUND
  REASON_FAILURE_MESSAGE "install libginac-dev and libcln-dev (scripts/setup does)")
if(GiNaC_FOUND AND NOT TARGET GiNaC::ginac)
  add_library(GiNaC::cln ALIAS PkgConfig::EOMGEN_CLN)
  add_library(GiNaC::ginac ALIAS PkgConfig::EOMGEN_GINAC)
endif()
