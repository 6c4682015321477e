# Tests of the program itself. COST: what takes longest begins first, so that no core waits at the end.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME app.cli COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/cli_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.cli PROPERTIES LABELS fast COST 20)
add_test(NAME app.resume COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/resume_test.py $<TARGET_FILE:ejecta>
         ${CMAKE_CURRENT_LIST_DIR}/small-ejection.toml ${CMAKE_CURRENT_BINARY_DIR}/resume)
set_tests_properties(app.resume PROPERTIES LABELS fast TIMEOUT 600)
find_program(PVPYTHON pvpython)
if(PVPYTHON)
  add_test(NAME app.paraview_live
           COMMAND ${PVPYTHON} --force-offscreen-rendering ${CMAKE_CURRENT_LIST_DIR}/../paraview/live_test.py $<TARGET_FILE:ejecta>
                   ${CMAKE_CURRENT_LIST_DIR}/small-ejection.toml ${CMAKE_CURRENT_BINARY_DIR}/live.run)
else()
  add_test(NAME app.paraview_live COMMAND sh -c "echo skipped: app.paraview_live needs ParaView; exit 77")
endif()
set_tests_properties(app.paraview_live PROPERTIES SKIP_RETURN_CODE 77 LABELS fast TIMEOUT 300)
# Bodies without a fluid: shipped cases with what they expect.
add_test(NAME app.bodies COMMAND ejecta validate cases/bodies/belt-feed.toml cases/bodies/drop.toml cases/bodies/pile.toml validation/dem/chung-ooi-5.toml validation/dem/chung-ooi-6.toml
         validation/dem/chung-ooi-8.toml verification/dem/flip-period.toml WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(app.bodies PROPERTIES LABELS fast TIMEOUT 600 COST 15)
# Three bodies of hundreds of spheres: half a minute and more.
add_test(NAME app.angles COMMAND ejecta validate cases/bodies/angles.toml WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(app.angles PROPERTIES LABELS slow TIMEOUT 900)
# The jet that comes with the paper's cases, computed again: minutes.
add_test(NAME app.stored_jet COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/stored_jet_test.py $<TARGET_FILE:ejecta>
         ${PROJECT_SOURCE_DIR}/cases/paper/10mm-cubic.toml)
set_tests_properties(app.stored_jet PROPERTIES LABELS slow TIMEOUT 3600)
# 10,000 cases drawn from the schema: a quarter of an hour.
add_test(NAME app.random_cases COMMAND test_app --gtest_filter=RandomCases.*)
set_tests_properties(app.random_cases PROPERTIES LABELS slow TIMEOUT 3600 ENVIRONMENT EJECTA_RANDOM_CASES=10000)
# Studies: kills, failures, the time of a task; long: 50 kills, 10,000 tasks.
add_test(NAME app.study COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/study_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.study PROPERTIES LABELS fast TIMEOUT 600)
add_test(NAME app.study_long COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/study_test.py $<TARGET_FILE:ejecta> 50 10000)
set_tests_properties(app.study_long PROPERTIES LABELS slow TIMEOUT 3600)
add_test(NAME app.campaign COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/campaign_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.campaign PROPERTIES LABELS fast TIMEOUT 300)
add_test(NAME app.cold_store COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/cold_store_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.cold_store PROPERTIES LABELS fast TIMEOUT 300)
add_test(NAME app.hundred_runs COMMAND test_simulation --gtest_filter=Run.SideBySideInOneProcess*)
set_tests_properties(app.hundred_runs PROPERTIES LABELS slow TIMEOUT 3600 ENVIRONMENT EJECTA_SIDE_BY_SIDE=100)
# A whole sorter: threads, kills, books.
add_test(NAME app.sort COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/sort_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.sort PROPERTIES LABELS fast TIMEOUT 600 COST 30)
# A real SLURM of one node, where Debian's slurm-wlm is installed.
add_test(NAME app.slurm COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/slurm_test.py $<TARGET_FILE:ejecta>)
set_tests_properties(app.slurm PROPERTIES LABELS slow SKIP_RETURN_CODE 77 TIMEOUT 600 RUN_SERIAL ON)
