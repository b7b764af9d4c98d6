# `cmake --install` gives the command, the shared library, the headers, a package for find_package(vinerow) and the documentation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vinerow EXPORT vinerowTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS vinerow_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# include/vinerow: api, core, math, session.h, testing.h, version.h. The rest is private.
install(CODE "set(VINEROW_SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
set(VINEROW_INCLUDEDIR \"${CMAKE_INSTALL_INCLUDEDIR}\")")
install(SCRIPT cmake/install_headers.cmake)
install(FILES ${CMAKE_BINARY_DIR}/generated/vinerow/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vinerow)
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/vinerow)
# README.md and CHANGELOG.md link to files under docs/, so they lie as in the tree.
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vinerow)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vinerow PATTERN Doxyfile EXCLUDE PATTERN site EXCLUDE)
install(EXPORT vinerowTargets NAMESPACE vinerow:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow)

# The Eigen that the library is compiled with, where that is a copy (eigen_on_aarch64.cmake): for plug-ins.
set(VINEROW_INSTALLED_EIGEN ${CMAKE_INSTALL_INCLUDEDIR}/vinerow/eigen)
if(VINEROW_EIGEN)
  install(DIRECTORY ${VINEROW_EIGEN}/ DESTINATION ${VINEROW_INSTALLED_EIGEN})
endif()
configure_package_config_file(cmake/vinerowConfig.cmake.in ${CMAKE_BINARY_DIR}/vinerowConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow PATH_VARS VINEROW_INSTALLED_EIGEN)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/vinerowConfig.cmake ${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow)
