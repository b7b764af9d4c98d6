# The replay: a library of its own, so that the command and its tests share it. Its scripts and three.js become part of the
# program when it is built; a page needs no network.
enable_language(ASM)

find_path(VINEROW_THREE_FOLDER three.min.js
          PATHS /usr/share/javascript/three /usr/share/nodejs/three/build DOC "folder of three.js (Debian: libjs-three)")
set(three_files
    three=three.min.js
    three_orbit_controls=examples/js/controls/OrbitControls.js
    three_gltf_loader=examples/js/loaders/GLTFLoader.js
    three_line_geometry=examples/js/lines/LineSegmentsGeometry.js
    three_line_material=examples/js/lines/LineMaterial.js
    three_line_segments=examples/js/lines/LineSegments2.js)
set(replay_files
    replay_style=replay/replay.css
    replay_markup=replay/replay.html
    replay_data=replay/data.js
    replay_look=replay/look.js
    replay_scene=replay/scene.js
    replay_camera=replay/camera.js
    replay_player=replay/player.js
    replay_controls=replay/controls.js
    three_notice=replay/three_licence.txt)

set(has_three ON)
foreach(entry ${three_files})
  string(REGEX REPLACE "^.*=" "" file ${entry})
  if(NOT VINEROW_THREE_FOLDER OR NOT EXISTS ${VINEROW_THREE_FOLDER}/${file})
    set(has_three OFF)
  endif()
endforeach()
if(NOT has_three)
  message(STATUS "three.js with its examples is absent (Debian: libjs-three): reports are built without their 3D replay")
endif()

# An assembler reads the files as they are; a compiler would take minutes for their bytes as numbers.
set(replay_assembly ".section .rodata\n")
set(replay_assets)
function(vinerow_add_asset name file)
  set(text "${replay_assembly}.global vinerow_asset_${name}\nvinerow_asset_${name}:\n.incbin \"${file}\"\n")
  string(APPEND text ".global vinerow_asset_${name}_end\nvinerow_asset_${name}_end:\n.byte 0\n")
  set(replay_assembly "${text}" PARENT_SCOPE)
  set(replay_assets ${replay_assets} ${file} PARENT_SCOPE)
endfunction()
foreach(entry ${replay_files})
  string(REPLACE "=" ";" pair ${entry})
  list(GET pair 0 name)
  list(GET pair 1 file)
  vinerow_add_asset(${name} ${CMAKE_CURRENT_LIST_DIR}/${file})
endforeach()
if(has_three)
  foreach(entry ${three_files})
    string(REPLACE "=" ";" pair ${entry})
    list(GET pair 0 name)
    list(GET pair 1 file)
    vinerow_add_asset(${name} ${VINEROW_THREE_FOLDER}/${file})
  endforeach()
endif()
string(APPEND replay_assembly ".section .note.GNU-stack,\"\",@progbits\n")
# In lower case: a file that ends on .S would go through the C preprocessor first.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/replay_assets.s CONTENT "${replay_assembly}" @ONLY)
# Clang warns of options of C++ that an assembler has no use for.
set_source_files_properties(${CMAKE_CURRENT_BINARY_DIR}/replay_assets.s PROPERTIES OBJECT_DEPENDS "${replay_assets}"
    COMPILE_OPTIONS -Wno-unused-command-line-argument)

set(replay_sources)
foreach(name base64 replay replay_assets replay_decimate replay_glb replay_ground replay_plans replay_run replay_scene
        replay_textures replay_tracks)
  list(APPEND replay_sources ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
endforeach()
add_library(vinerow_replay STATIC ${replay_sources} ${CMAKE_CURRENT_BINARY_DIR}/replay_assets.s)
vinerow_use_common_headers(vinerow_replay)
vinerow_compile_together(vinerow_replay 12 ${replay_sources})
target_link_libraries(vinerow_replay PUBLIC vinerow nlohmann_json::nlohmann_json PRIVATE fmt::fmt)
if(has_three)
  target_compile_definitions(vinerow_replay PRIVATE VINEROW_HAS_THREE)
endif()
