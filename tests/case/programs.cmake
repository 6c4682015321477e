# Tests of the case room that are programs of their own.
include(${PROJECT_SOURCE_DIR}/cmake/fuzz.cmake)
ejecta_fuzz(case ejecta_case)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME house.includes COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_includes.py)
set_tests_properties(house.includes PROPERTIES LABELS fast)
add_test(NAME house.includes_refused
         COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/case/check_includes_test.py)
set_tests_properties(house.includes_refused PROPERTIES LABELS fast)
add_test(NAME house.format COMMAND ${PROJECT_SOURCE_DIR}/tools/check_format.sh)
set_tests_properties(house.format PROPERTIES LABELS fast SKIP_RETURN_CODE 77)
