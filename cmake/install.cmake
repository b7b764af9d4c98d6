# `cmake --install` gives the command, the shared library, the headers, a package for find_package(vinerow), the Python package and
# the documentation. Components are Debian packages (packaging/debian.cmake): `runtime`, `dev`, `python`, `nets`; `texts` is in none of them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vinerow EXPORT vinerowTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT dev)
install(TARGETS vinerow_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
if(TARGET vinerow_net_host)
  install(TARGETS vinerow_net_host LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT nets)
endif()
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/vinerow COMPONENT runtime)
# README.md and CHANGELOG.md link to files under docs/, so they lie as in the tree.
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vinerow COMPONENT runtime)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vinerow COMPONENT texts)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vinerow COMPONENT runtime PATTERN Doxyfile EXCLUDE PATTERN site EXCLUDE)
# Manual pages and completions, written by the command itself.
install(CODE "set(VINEROW_PROGRAM ${CMAKE_CROSSCOMPILING_EMULATOR} \"$<TARGET_FILE:vinerow_command>\")
set(VINEROW_DATADIR \"${CMAKE_INSTALL_DATADIR}\")
set(VINEROW_MANDIR \"${CMAKE_INSTALL_MANDIR}\")" COMPONENT runtime)
install(SCRIPT cmake/install_manual.cmake COMPONENT runtime)

# include/vinerow: api, core, math, session.h, testing.h, version.h. The rest is private.
install(CODE "set(VINEROW_SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
set(VINEROW_INCLUDEDIR \"${CMAKE_INSTALL_INCLUDEDIR}\")" COMPONENT dev)
install(SCRIPT cmake/install_headers.cmake COMPONENT dev)
install(FILES ${CMAKE_BINARY_DIR}/generated/vinerow/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vinerow COMPONENT dev)
install(EXPORT vinerowTargets NAMESPACE vinerow:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow COMPONENT dev)

# The Eigen that the library is compiled with, where that is a copy (eigen_on_aarch64.cmake): for plug-ins.
set(VINEROW_INSTALLED_EIGEN ${CMAKE_INSTALL_INCLUDEDIR}/vinerow/eigen)
if(VINEROW_EIGEN)
  install(DIRECTORY ${VINEROW_EIGEN}/ DESTINATION ${VINEROW_INSTALLED_EIGEN} COMPONENT dev)
endif()
configure_package_config_file(cmake/vinerowConfig.cmake.in ${CMAKE_BINARY_DIR}/vinerowConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow PATH_VARS VINEROW_INSTALLED_EIGEN)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/vinerowConfig.cmake ${CMAKE_BINARY_DIR}/vinerowConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vinerow COMPONENT dev)

# The Python package, where Debian's python3 looks if the prefix is /usr. Without its extension module if that is not built.
if(TARGET vinerow_python)
  set(VINEROW_PYTHON_DIR lib/python3/dist-packages/vinerow)
  file(RELATIVE_PATH from_python_to_lib /${VINEROW_PYTHON_DIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(vinerow_python PROPERTIES INSTALL_RPATH "$ORIGIN/${from_python_to_lib}")
  install(TARGETS vinerow_python LIBRARY DESTINATION ${VINEROW_PYTHON_DIR} COMPONENT python OPTIONAL)
  if(TARGET vinerow_python_host)
    install(TARGETS vinerow_python_host LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT python OPTIONAL)
  endif()
  install(DIRECTORY python/vinerow/ DESTINATION ${VINEROW_PYTHON_DIR} COMPONENT python
          FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed PATTERN *.yaml PATTERN __pycache__ EXCLUDE)
endif()

# A system's own folders need no path to the library; Debian's packages must not have one.
foreach(place "runtime|${CMAKE_INSTALL_BINDIR}/vinerow" "python|${VINEROW_PYTHON_DIR}/_core*.so")
  string(REGEX MATCH "^(.*)[|](.*)$" matched "${place}")
  install(CODE "if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
  file(GLOB programs \"\$ENV{DESTDIR}/usr/${CMAKE_MATCH_2}\")
  foreach(program IN LISTS programs)
    file(RPATH_REMOVE FILE \"\${program}\")
  endforeach()
endif()" COMPONENT ${CMAKE_MATCH_1})
endforeach()

include(packaging/debian.cmake)
