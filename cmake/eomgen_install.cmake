# cmake --install installs bin/eomgen, the runtime headers, and a package with eomgen::runtime, eomgen::cli, eom_generate.
include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/eomgenConfig.cmake.in
  ${PROJECT_BINARY_DIR}/eomgenConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/eomgen
  PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/eomgenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT eomgenTargets NAMESPACE eomgen:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/eomgen)
install(FILES ${PROJECT_BINARY_DIR}/eomgenConfig.cmake ${PROJECT_BINARY_DIR}/eomgenConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/EomGenerate.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/eomgen)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/models DESTINATION ${CMAKE_INSTALL_DATADIR}/eomgen)
# The pages of the documentation that messages and `eomgen --help` refer to.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/lib/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.runtime)
