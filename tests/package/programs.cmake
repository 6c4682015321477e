# The installed library, program and what comes with them.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME package.outside COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/package_test.py ${CMAKE_BINARY_DIR}
         ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/installed)
set_tests_properties(package.outside PROPERTIES LABELS fast TIMEOUT 600)
