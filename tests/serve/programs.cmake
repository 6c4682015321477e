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

# What others than pages may send it: the room alone under the sanitizers, the library below it as users have it, which
# under sanitizers would take longer to build than all else.
find_program(FUZZ_COMPILER NAMES clang++ clang++-14 clang++-15 clang++-16)
if(TARGET ejecta-serve AND NOT EJECTA_SANITIZE AND FUZZ_COMPILER)
  file(GLOB serve_sources ${PROJECT_SOURCE_DIR}/src/serve/*.cpp)
  list(FILTER serve_sources EXCLUDE REGEX "/page\\.cpp$")
  list(TRANSFORM serve_sources REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
  string(JOIN "" includes ${includes} "#include \"${PROJECT_SOURCE_DIR}/fuzz/http_fuzz.cpp\"\n")
  set(all ${CMAKE_BINARY_DIR}/fuzz/http_fuzz_all.cpp)  # one translation unit, so that headers are read once
  file(CONFIGURE OUTPUT ${all} CONTENT "${includes}" @ONLY)
  get_target_property(serve_defines ejecta_serve COMPILE_DEFINITIONS)
  list(APPEND serve_defines EIGEN_DONT_PARALLELIZE EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  if(EJECTA_DOUBLE)
    list(APPEND serve_defines EJECTA_DOUBLE)
  endif()
  list(TRANSFORM serve_defines PREPEND -D)
  set(binary ${CMAKE_BINARY_DIR}/fuzz/http_fuzz)
  add_custom_command(OUTPUT ${binary} DEPENDS ${all} libejecta DEPFILE ${binary}.d
    COMMAND ${FUZZ_COMPILER} -std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all
            -I${PROJECT_SOURCE_DIR}/src -isystem${EIGEN3_INCLUDE_DIRS} ${serve_defines} -MD -MF ${binary}.d -MT ${binary}
            ${all} -o ${binary} $<TARGET_FILE:libejecta> -Wl,-rpath,$<TARGET_FILE_DIR:libejecta> ${HTTPLIB} -lfmt -lpthread
    COMMENT "Building the fuzzer of http")
  add_custom_target(fuzz_http ALL DEPENDS ${binary})
  ejecta_fuzz_test(http ${binary})
elseif(NOT EJECTA_SANITIZE)
  ejecta_no_fuzz(http)
endif()
