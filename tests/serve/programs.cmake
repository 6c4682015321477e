# The server of the workbench, asked as a page, and as others, would.
if(TARGET ejecta-serve)
  add_test(NAME serve.server COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/serve_test.py $<TARGET_FILE:ejecta>
           ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/serve)
  set_tests_properties(serve.server PROPERTIES LABELS fast TIMEOUT 900 COST 60)
endif()
find_program(NODE node)
if(TARGET ejecta-serve AND NODE)
  add_test(NAME serve.page COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/page_test.mjs ${CMAKE_BINARY_DIR}/report/node_modules
           ${CMAKE_BINARY_DIR}/tests/screenshots $<TARGET_FILE:ejecta> ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/tests/workbench)
  set_tests_properties(serve.page PROPERTIES LABELS fast SKIP_RETURN_CODE 77 TIMEOUT 600 RUN_SERIAL ON)
endif()

# What others than pages may send it. The library below it is that of the program, without sanitizers.
if(TARGET ejecta-serve AND NOT EJECTA_SANITIZE)
  include(${PROJECT_SOURCE_DIR}/cmake/fuzz.cmake)
  file(GLOB serve_sources RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/serve/*.cpp)
  list(REMOVE_ITEM serve_sources serve/page.cpp)
  get_target_property(serve_defines ejecta_serve COMPILE_DEFINITIONS)
  if(EJECTA_DOUBLE)
    list(APPEND serve_defines EJECTA_DOUBLE)
  endif()
  list(APPEND serve_defines EIGEN_DONT_PARALLELIZE EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  list(TRANSFORM serve_defines PREPEND -D)
  ejecta_fuzz(http SOURCES ${serve_sources} INCLUDES ${EIGEN3_INCLUDE_DIRS}
              LIBS ${serve_defines} $<TARGET_FILE:libejecta>
                   -Wl,-rpath,$<TARGET_FILE_DIR:libejecta> ${HTTPLIB} -lfmt -lpthread)
  if(TARGET fuzz_http)
    add_dependencies(fuzz_http libejecta)
  endif()
endif()
