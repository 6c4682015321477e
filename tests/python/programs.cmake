# The Python module, as its users have it.
if(TARGET python_core)
  add_test(NAME python.module COMMAND ${EJECTA_PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/module_test.py $<TARGET_FILE:ejecta>
           ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/python)
  add_test(NAME python.notebooks COMMAND ${EJECTA_PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/notebooks_test.py
           ${PROJECT_SOURCE_DIR}/python/notebooks)
  set_tests_properties(python.module python.notebooks PROPERTIES LABELS fast TIMEOUT 900
                       ENVIRONMENT PYTHONPATH=${CMAKE_BINARY_DIR}/python)
endif()
