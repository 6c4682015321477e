# Programs of others that open our files: ParaView, a browser, Python. Each test opens the same sample run and
# skips, with a message, where its program is absent.
foreach(program make_sample_run make_report make_study_report)
  add_executable(${program} ${CMAKE_CURRENT_LIST_DIR}/${program}.cpp)
  target_link_libraries(${program} PRIVATE ejecta_output)
endforeach()

set(sample ${CMAKE_BINARY_DIR}/tests/sample.run)
add_test(NAME output.sample_run COMMAND make_sample_run ${sample})
set_tests_properties(output.sample_run PROPERTIES FIXTURES_SETUP sample_run LABELS "fast;output")

find_program(PVPYTHON pvpython)
find_program(NODE node)
set(python /usr/bin/python3) # Debian's, which has Debian's numpy
set(sources ${CMAKE_CURRENT_LIST_DIR}/..)

# ejecta_program_test(NAME FOUND COMMAND...): runs COMMAND where FOUND is a program, else says that it skips.
function(ejecta_program_test name program)
  if(program AND EXISTS ${program})
    add_test(NAME ${name} COMMAND ${program} ${ARGN})
  else()
    add_test(NAME ${name} COMMAND sh -c "echo skipped: ${name} needs a program that is not installed; exit 77")
  endif()
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS "fast;output" COST 50)
endfunction()

ejecta_program_test(output.paraview "${PVPYTHON}" --force-offscreen-rendering ${sources}/paraview/paraview_test.py ${sample}
                    ${CMAKE_BINARY_DIR}/tests/killed.run)
ejecta_program_test(output.python "${python}" ${sources}/output/python_reader_test.py ${PROJECT_SOURCE_DIR}/python
                    ${sample} ${CMAKE_BINARY_DIR}/tests/sample.png)
set_tests_properties(output.paraview output.python PROPERTIES FIXTURES_REQUIRED sample_run)
ejecta_program_test(output.killed "${python}" ${sources}/output/kill_test.py ${PROJECT_SOURCE_DIR}/python
                    $<TARGET_FILE:make_sample_run> ${CMAKE_BINARY_DIR}/tests/killed.run)
set_tests_properties(output.killed PROPERTIES FIXTURES_SETUP killed_run RUN_SERIAL ON)
set_tests_properties(output.paraview PROPERTIES FIXTURES_REQUIRED "sample_run;killed_run")

# The report of one run, of two laid over each other, and of a jet without bodies.
add_test(NAME output.sample_run_pushed COMMAND make_sample_run ${CMAKE_BINARY_DIR}/tests/pushed.run 3)
add_test(NAME output.sample_jet COMMAND make_sample_run ${CMAKE_BINARY_DIR}/tests/jet.run 0)
set_tests_properties(output.sample_run_pushed output.sample_jet PROPERTIES FIXTURES_SETUP sample_run LABELS "fast;output")
foreach(report "one,sample" "two,sample,pushed" "jet,jet")
  string(REPLACE "," ";" parts ${report})
  list(POP_FRONT parts name)
  list(TRANSFORM parts PREPEND ${CMAKE_BINARY_DIR}/tests/)
  list(TRANSFORM parts APPEND .run)
  set(html ${CMAKE_BINARY_DIR}/tests/report-${name}.html)
  add_test(NAME output.report_${name} COMMAND make_report ${html} ${parts})
  set_tests_properties(output.report_${name} PROPERTIES FIXTURES_REQUIRED sample_run FIXTURES_SETUP report_${name}
                       LABELS "fast;output")
  ejecta_program_test(output.browser_${name} "${NODE}" ${sources}/report/report_test.mjs
                      ${CMAKE_BINARY_DIR}/report/node_modules ${CMAKE_BINARY_DIR}/tests/screenshots ${html} ${parts})
  set_tests_properties(output.browser_${name} PROPERTIES FIXTURES_REQUIRED report_${name} RUN_SERIAL ON)
endforeach()

# The pages of a map and of a study.
foreach(kind map study)
  set(html ${CMAKE_BINARY_DIR}/tests/report-${kind}.html)
  set(result ${sources}/report/sample-${kind}.json)
  add_test(NAME output.report_${kind} COMMAND make_study_report ${html} ${kind} ${result})
  set_tests_properties(output.report_${kind} PROPERTIES FIXTURES_SETUP report_${kind} LABELS "fast;output")
  ejecta_program_test(output.browser_${kind} "${NODE}" ${sources}/report/study_page_test.mjs ${CMAKE_BINARY_DIR}/report/node_modules
                      ${CMAKE_BINARY_DIR}/tests/screenshots ${kind} ${html} ${result})
  set_tests_properties(output.browser_${kind} PROPERTIES FIXTURES_REQUIRED report_${kind} RUN_SERIAL ON)
endforeach()

include(${PROJECT_SOURCE_DIR}/cmake/fuzz.cmake)
ejecta_fuzz(checkpoint ejecta_output)
