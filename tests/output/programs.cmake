# Programs of others that open our files: ParaView, a browser, Python. Each test opens the same sample run and
# skips, with a message, where its program is absent.
foreach(program make_sample_run make_report)
  add_executable(${program} ${CMAKE_CURRENT_LIST_DIR}/${program}.cpp)
  target_link_libraries(${program} PRIVATE ejecta_output)
endforeach()

set(sample ${CMAKE_BINARY_DIR}/tests/sample.run)
add_test(NAME output.sample_run COMMAND make_sample_run ${sample})
set_tests_properties(output.sample_run PROPERTIES FIXTURES_SETUP sample_run LABELS "fast;output")
