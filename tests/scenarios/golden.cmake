# What every shipped scenario gave when golden.json was recorded: an entry each. A test of the build machine's own kind: see
# golden.py. Only of the release build, whose rounding the file holds.
if(NOT VINEROW_SANITIZE)
  file(GLOB scenarios ${PROJECT_SOURCE_DIR}/assets/scenarios/*.yaml)
  foreach(scenario ${scenarios})
    get_filename_component(name ${scenario} NAME_WE)
    add_test(NAME golden.${name} COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/golden.py check
                                         $<TARGET_FILE:vinerow_command> ${name})
    set_tests_properties(golden.${name} PROPERTIES TIMEOUT 600)
  endforeach()
  # Two thirds of the time of all of them: begun first.
  set_tests_properties(golden.cooperative_parcel_f PROPERTIES COST 100)
endif()
