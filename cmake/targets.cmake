# vinerow_add_part(NAME SOURCES ... [PUBLIC libs...] [PRIVATE libs...])
# One static library per folder; all of them together become the shared library `vinerow`.
set_property(GLOBAL PROPERTY VINEROW_PARTS "")

# What nearly every source file includes, compiled once. Two lists: the library does not pay for what tests include.
# Our own are those that most units see anyway. An edit of one compiles everything again, so the test hot_headers counts them
# as seen by every source.
if(VINEROW_PCH)
  add_library(vinerow_headers OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/common_headers.cpp)
  target_link_libraries(vinerow_headers PRIVATE Eigen3::Eigen fmt::fmt)
  target_include_directories(vinerow_headers PRIVATE ${PROJECT_SOURCE_DIR})
  target_precompile_headers(vinerow_headers PRIVATE
                            <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <algorithm> <array> <cmath> <filesystem>
                            <functional> <map> <memory> <optional> <span> <sstream> <string> <string_view> <utility>
                            <variant> <vector> <engine/api/parameter_table.h> <engine/api/stepped_parts.h>)
  target_compile_options(vinerow_headers PRIVATE ${VINEROW_PCH_OPTIONS})
endif()

# vinerow_use_common_headers(TARGET): of a library; programs are compiled with other options.
function(vinerow_use_common_headers target)
  if(VINEROW_PCH)
    target_link_libraries(${target} PRIVATE fmt::fmt)
    target_precompile_headers(${target} REUSE_FROM vinerow_headers)
    target_compile_options(${target} PRIVATE ${VINEROW_PCH_OPTIONS})
  endif()
endfunction()

# vinerow_compile_together(TARGET BATCH SOURCES...): sources of one folder are compiled as units of at most BATCH files.
# Files that open a name in an anonymous namespace share it with their unit, so names differ within a folder.
function(vinerow_compile_together target batch)
  if(NOT VINEROW_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source ${ARGN})
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "unit_${folder}" folder)
    if(NOT DEFINED count_${folder})
      set(count_${folder} 0)
    endif()
    math(EXPR index "${count_${folder}} / ${batch}")
    math(EXPR count_${folder} "${count_${folder}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${index})
  endforeach()
endfunction()

function(vinerow_add_part name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    vinerow_use_common_headers(${name})
    vinerow_compile_together(${name} 10 ${ARG_SOURCES})
    set_property(GLOBAL APPEND PROPERTY VINEROW_PARTS ${name})
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC} ${ARG_PRIVATE})
  endif()
endfunction()
