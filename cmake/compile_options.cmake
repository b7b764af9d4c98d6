# One language standard, one set of warnings, one rule for floating point, for every target of ours.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
# -O3 instead of -O2: missions take 4 to 11 % less time, the library 7 % more to build. Its results have the same bits.
# -fno-math-errno and -fno-trapping-math besides: no difference.
set(CMAKE_CXX_FLAGS_RELEASE "-O3")
# The preset `single`, which looks for missing includes and runs nothing.
set(CMAKE_CXX_FLAGS_DEBUG "-O0")
# The sanitizer presets: -O1 halves their build time, -g1 gives them line numbers.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Sloppiness: what ccache requires before it caches a source that uses a precompiled header. Paths are kept relative
  # to the source tree, so that one clone finds what another one has compiled.
  # CCACHE_EXTRAFILES: ccache compares preprocessed text, and so takes two precompiled headers for one when only a comment
  # differs. GCC compares the files themselves, finds a header that it has not read, and reads it twice. So the headers that
  # precompiled ones can hold count whole. CCACHE_DEPEND would do as much, but then no clone finds what another one compiled:
  # sources that are compiled together name their files by absolute paths.
  # CCACHE_NAMESPACE: leaves behind entries that were made without this.
  file(GLOB_RECURSE VINEROW_PCH_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/api/*.h ${PROJECT_SOURCE_DIR}/engine/core/*.h
       ${PROJECT_SOURCE_DIR}/engine/math/*.h)
  list(JOIN VINEROW_PCH_SOURCES ":" VINEROW_PCH_SOURCES)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_EXTRAFILES=${VINEROW_PCH_SOURCES}
      CCACHE_NAMESPACE=vinerow_whole_headers CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
      CCACHE_NOHASHDIR=1 ${CCACHE_PROGRAM})
endif()
# mold links the shared library and the test programs in a fraction of the time of the usual linker.
# GCC 12 looks for it in the folders of its target alone, so a cross build keeps its own linker.
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM AND NOT CMAKE_CROSSCOMPILING)
  add_link_options(-fuse-ld=mold)
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # For what is compiled with a precompiled header: ccache wants it.
  set(VINEROW_PCH_OPTIONS -fpch-preprocess)
endif()

# The elementary functions are ours (engine/elementary). A compiler that knows them by name computes those of constants
# itself, by its own library, and joins or replaces calls: it must call them.
set(VINEROW_OWN_FUNCTIONS)
set(VINEROW_ELEMENTARY_SYMBOLS ${CMAKE_BINARY_DIR}/generated/elementary_symbols.txt)
set(elementary_symbols)
foreach(function sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 exp10 expm1 log log2 log10 log1p
        pow cbrt hypot erf erfc tgamma sincos)
  list(APPEND VINEROW_OWN_FUNCTIONS -fno-builtin-${function})
  string(APPEND elementary_symbols "${function}; ${function}f; ")
endforeach()
file(CONFIGURE OUTPUT ${VINEROW_ELEMENTARY_SYMBOLS} CONTENT "{ ${elementary_symbols}};\n")
add_compile_options(${VINEROW_OWN_FUNCTIONS})
# Eigen splits products of more than some 500 terms by the size of the processor's caches, unless it may not ask for it.
add_compile_definitions(EIGEN_NO_CPUID)

# -ffp-contract=off: the same expression gives the same bits wherever the compiler places it.
# -fno-semantic-interposition: calls inside the shared library stay direct.
# -fmacro-prefix-map: messages name files from the tree's root; and one clone's objects serve another one (ccache).
add_compile_options(-Wall -Wextra -Werror -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
                    -ffp-contract=off -fno-semantic-interposition
                    -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)

if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC 12 finds false overruns in std::string and libfmt at -O3, and once headers are precompiled. The sanitizers look for
  # real ones.
  add_compile_options(-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
endif()

if(VINEROW_SANITIZE)
  add_compile_options(-fsanitize=${VINEROW_SANITIZE} -fno-omit-frame-pointer)
  # Elements behind the end of a vector that still has capacity are valid memory: only the library's own checks see them.
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${VINEROW_SANITIZE})
  if(VINEROW_SANITIZE MATCHES "undefined")
    # Left out are the checks that cost a third of the build and find little here: a null pointer traps anyway, bounds of
    # objects are the address sanitizer's, and x86 reads what is not aligned.
    add_compile_options(-fno-sanitize-recover=undefined -fno-sanitize=null,alignment,vptr,object-size)
  endif()
  # GCC's sanitizer instrumentation produces false "maybe uninitialized" reports in Eigen.
  add_compile_options(-Wno-maybe-uninitialized)
endif()
