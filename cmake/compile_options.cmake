# One language standard, one set of warnings, one rule for floating point, for every target of ours.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2")
# The sanitizer presets: -O1 halves their build time, -g1 gives them line numbers.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# -ffp-contract=off: the same expression gives the same bits wherever the compiler places it.
# -fno-semantic-interposition: calls inside the shared library stay direct.
add_compile_options(-Wall -Wextra -Werror -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
                    -ffp-contract=off -fno-semantic-interposition)

if(VINEROW_SANITIZE)
  add_compile_options(-fsanitize=${VINEROW_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${VINEROW_SANITIZE})
  if(VINEROW_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
  # GCC's sanitizer instrumentation produces false "maybe uninitialized" reports in Eigen.
  add_compile_options(-Wno-maybe-uninitialized)
endif()
