# Tests of what solves: quadratic and linear programmes, Riccati equations, sets.
vinerow_add_test(solvers_test
  SOURCES parts/solvers/discretise_test.cpp
          estimation/row_localisation/ellipsoid_test.cpp
          parts/solvers/fixed_wing_sets_test.cpp
          parts/solvers/invariant_set_test.cpp
          parts/solvers/linear_mpc_contract_test.cpp
          parts/solvers/linear_mpc_test.cpp
          parts/solvers/linear_programme_test.cpp
          parts/solvers/polytope_test.cpp
          parts/solvers/qp_contract_test.cpp
          parts/solvers/qp_mpc_benchmark_test.cpp
          parts/solvers/qp_random_test.cpp
          parts/solvers/qp_test.cpp
          parts/solvers/riccati_test.cpp
          parts/solvers/tube_mpc_test.cpp
          parts/solvers/tube_sets_test.cpp
          parts/solvers/zonotope_test.cpp
  LIBS ${LIBS}
  SHARDS 4)

# The QP solver judged from Python. numpy and cvxopt are packages of the system's python3, which need
# not be the first on the path; without them, or without the data, the tests are skipped.
add_executable(qp_solve_files parts/solvers/qp_solve_files.cpp)
target_link_libraries(qp_solve_files PRIVATE vinerow_controller_test_support vinerow_controllers)
find_program(SYSTEM_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(SYSTEM_PYTHON NAMES python3 REQUIRED)
add_test(NAME qp_python.mpc_benchmark
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/qp_benchmark_check.py
                 $<TARGET_FILE:qp_solve_files> ${PROJECT_SOURCE_DIR}/../shared/data)
add_test(NAME qp_python.cvxopt
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/qp_cvxopt_check.py
                 $<TARGET_FILE:qp_solve_files>)
set_tests_properties(qp_python.mpc_benchmark qp_python.cvxopt PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)

add_executable(optimal_control_files parts/solvers/optimal_control_files.cpp)
target_link_libraries(optimal_control_files PRIVATE vinerow_controllers)
add_test(NAME optimal_control_python.scipy
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/optimal_control_scipy_check.py
                 $<TARGET_FILE:optimal_control_files>)
add_test(NAME optimal_control_python.cvxopt
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/linear_mpc_cvxopt_check.py
                 $<TARGET_FILE:optimal_control_files>)
set_tests_properties(optimal_control_python.scipy optimal_control_python.cvxopt
                     PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)

# The mixer outside its limits judged by linear programmes of cvxopt.
add_executable(mix_rotors parts/rotorcraft/mix_rotors.cpp)
target_link_libraries(mix_rotors PRIVATE vinerow_controller_test_support vinerow_controllers)
add_test(NAME rotor_mixer_python.cvxopt
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/rotorcraft/rotor_mixer_check.py
                 $<TARGET_FILE:mix_rotors>)
set_tests_properties(rotor_mixer_python.cvxopt PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)

add_executable(tube_mpc_files parts/solvers/tube_mpc_files.cpp)
target_link_libraries(tube_mpc_files PRIVATE vinerow_controllers)
add_test(NAME tube_mpc_python.cvxopt
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/tube_mpc_cvxopt_check.py
                 $<TARGET_FILE:tube_mpc_files>)
set_tests_properties(tube_mpc_python.cvxopt PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)

# The linear programmes judged by HiGHS (scipy) and GLPK (cvxopt).
add_executable(lp_solve_files parts/solvers/lp_solve_files.cpp)
target_link_libraries(lp_solve_files PRIVATE vinerow_controllers)
add_test(NAME lp_python.highs_glpk
         COMMAND ${SYSTEM_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/parts/solvers/lp_check.py
                 $<TARGET_FILE:lp_solve_files>)
set_tests_properties(lp_python.highs_glpk PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
