# The installed library, program and what comes with them.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME package.outside COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/package_test.py ${CMAKE_BINARY_DIR}
         ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/installed)
set_tests_properties(package.outside PROPERTIES LABELS fast TIMEOUT 600)
# The notebooks of an installation in a folder, and of an environment of pip, from nothing.
if(TARGET python_core)
  add_test(NAME package.notebooks COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/notebooks_test.py ${CMAKE_BINARY_DIR}
           ${PROJECT_SOURCE_DIR})
  set_tests_properties(package.notebooks PROPERTIES LABELS slow TIMEOUT 1800)
endif()
