# Debian packages by CPack: vinerow, libvinerow-dev, python3-vinerow and, where OpenCV is at hand, vinerow-nets (`tools/package` builds
# and makes them).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vinerow)
set(CPACK_PACKAGE_VENDOR "The Vinerow authors")
set(VINEROW_MAINTAINER "The Vinerow authors <vinerow@localhost.invalid>" CACHE STRING "name and address of who publishes the packages")
set(CPACK_PACKAGE_CONTACT "${VINEROW_MAINTAINER}")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)

set(CPACK_COMPONENTS_ALL runtime dev python)
if(TARGET vinerow_net_host)
  list(APPEND CPACK_COMPONENTS_ALL nets)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# Dependencies on libraries and their versions, as dpkg-shlibdeps finds them; the library of `runtime` is in no package yet.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME vinerow)
# Opened by its first use, where dpkg-shlibdeps does not look: libgdal.so.32 is in libgdal32.
string(REGEX REPLACE "\\.so\\.?" "" gdal_package "${VINEROW_GDAL_FILE}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "${gdal_package}")
# Loaded at run time: without them a run has no pictures, or pictures without words.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "libosmesa6, fonts-dejavu-core")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "ffmpeg, python3-vinerow, libvinerow-dev, vinerow-nets")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "physics simulator of robots in vineyards and orchards
Rovers, quadrotors and fixed-wing aircraft with their sensors, estimators,
planners and controllers. A scenario file becomes a log, metrics, pictures, a
verdict and a report, with the same bits every time.
.
This package has the command, its library, scenarios and documentation.")
# Programs that are packaged and link the library need this version of it; the linker's cache is made again.
file(WRITE ${CMAKE_BINARY_DIR}/debian/shlibs "libvinerow 0 vinerow (= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/debian/shlibs ${CMAKE_BINARY_DIR}/debian/triggers)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvinerow-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "vinerow (= ${PROJECT_VERSION}), libeigen3-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "cmake, libgtest-dev")
set(CPACK_DEBIAN_DEV_DESCRIPTION "physics simulator of robots in vineyards - C++ headers
Headers and a CMake package for parts in plug-ins, for programs that step a
simulation, and for tests of parts against physics.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vinerow)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "vinerow (= ${PROJECT_VERSION}), python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "physics simulator of robots in vineyards - Python
Steps simulations from Python, and reads logs as NumPy arrays.")
set(CPACK_DEBIAN_NETS_PACKAGE_NAME vinerow-nets)
set(CPACK_DEBIAN_NETS_PACKAGE_DEPENDS "vinerow (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_NETS_DESCRIPTION "physics simulator of robots in vineyards - neural networks
Runs ONNX files in estimators, by OpenCV.")
# Byte code is made at installation and removed with the package, as in Debian's own packages.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/python/postinst ${CMAKE_CURRENT_LIST_DIR}/python/prerm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Copyright and changelog of each package, only in packages.
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(VINEROW_PACKAGE ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(CODE "set(VINEROW_SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
set(VINEROW_VERSION \"${PROJECT_VERSION}\")
set(VINEROW_CONTACT \"${CPACK_PACKAGE_CONTACT}\")
set(VINEROW_PACKAGE \"${VINEROW_PACKAGE}\")" COMPONENT ${component})
  install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/install_package_texts.cmake COMPONENT ${component})
endforeach()

include(CPack)
