# What every shipped scenario gives (golden.json): an entry each. The first seconds of all of them again where the C library
# does not see AVX2 and FMA (.ci/nightly: the whole runs).
# Only of the release build: sanitizers are too slow for whole missions.
if(NOT VINEROW_SANITIZE)
  file(GLOB scenarios ${PROJECT_SOURCE_DIR}/assets/scenarios/*.yaml)
  if(NOT VINEROW_NETS)
    list(FILTER scenarios EXCLUDE REGEX "vineyard_row_net")
  endif()
  foreach(scenario ${scenarios})
    get_filename_component(name ${scenario} NAME_WE)
    add_test(NAME golden.${name}
             COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/golden.py check $<TARGET_FILE:vinerow_command> ${name})
    set_tests_properties(golden.${name} PROPERTIES TIMEOUT 600)
    list(APPEND names ${name})
  endforeach()
  add_test(NAME golden_plain COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/golden.py start
                                     $<TARGET_FILE:vinerow_command> ${names} --plain)
  set_tests_properties(golden_plain PROPERTIES TIMEOUT 600 COST 50)
  # The first seconds on a processor of 2008, emulated: no library can ask this one for AVX or FMA.
  find_program(QEMU_X86_64 qemu-x86_64-static)
  if(QEMU_X86_64 AND CMAKE_HOST_SYSTEM_PROCESSOR STREQUAL "x86_64")
    set(emulated orchard_rover vineyard_4ws_two_rows vineyard_scan)
    if(VINEROW_NETS)
      list(APPEND emulated vineyard_row_net)
    endif()
    foreach(name ${emulated})
      add_test(NAME golden_nehalem.${name}
               COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/golden.py start $<TARGET_FILE:vinerow_command>
                       ${name} --under "${QEMU_X86_64} -cpu Nehalem")
      set_tests_properties(golden_nehalem.${name} PROPERTIES TIMEOUT 900 COST 90)
    endforeach()
  endif()
  # The longest by far: begun first.
  set_tests_properties(golden.cooperative_parcel_f PROPERTIES COST 100)
endif()
