# The server of the workbench, asked as a page, and as others, would.
if(TARGET ejecta-serve)
  add_test(NAME serve.server COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/serve_test.py $<TARGET_FILE:ejecta>
           ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/serve)
  set_tests_properties(serve.server PROPERTIES LABELS fast TIMEOUT 900)
endif()
find_program(NODE node)
if(TARGET ejecta-serve AND NODE)
  add_test(NAME serve.page COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/page_test.mjs ${CMAKE_BINARY_DIR}/report/node_modules
           ${CMAKE_BINARY_DIR}/tests/screenshots $<TARGET_FILE:ejecta> ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/workbench)
  set_tests_properties(serve.page PROPERTIES LABELS fast SKIP_RETURN_CODE 77 TIMEOUT 600 RUN_SERIAL ON)
endif()
