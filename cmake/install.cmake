# `cmake --install` gives the command, the shared library, the headers and a package for find_package(vinerow).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vinerow EXPORT vinerowTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS vinerow_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY engine vehicles worlds controllers DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vinerow
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY tools/testing/include/vinerow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_BINARY_DIR}/generated/vinerow/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vinerow)
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/vinerow)
install(EXPORT vinerowTargets NAMESPACE vinerow:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow)

configure_package_config_file(cmake/vinerowConfig.cmake.in ${CMAKE_BINARY_DIR}/vinerowConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/vinerowConfig.cmake ${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow)
