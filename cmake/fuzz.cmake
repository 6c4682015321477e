# ejecta_fuzz(NAME LIBRARIES...): fuzz/NAME_fuzz.cpp with clang's libFuzzer and the libraries, in a build under sanitizers
# (preset `sanitize`, which takes clang where it is installed), and a short run from fuzz/NAME_corpus as a test. A long run:
#   build/sanitize/fuzz/NAME_fuzz -max_total_time=600 /tmp/corpus fuzz/NAME_corpus
function(ejecta_fuzz name)
  if(NOT EJECTA_SANITIZE)
    return()
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    add_custom_target(fuzz_${name})  # nothing to build
    ejecta_no_fuzz(${name})
    return()
  endif()
  add_executable(fuzz_${name} ${PROJECT_SOURCE_DIR}/fuzz/${name}_fuzz.cpp)
  target_link_libraries(fuzz_${name} PRIVATE ${ARGN})
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  set_target_properties(fuzz_${name} PROPERTIES OUTPUT_NAME ${name}_fuzz RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
  ejecta_fuzz_test(${name} $<TARGET_FILE:fuzz_${name}>)
endfunction()

function(ejecta_fuzz_test name binary)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz/${name}_new)
  add_test(NAME fuzz.${name} COMMAND ${binary} -runs=50000 -max_total_time=10 -seed=1 -print_final_stats=1
           ${CMAKE_BINARY_DIR}/fuzz/${name}_new ${PROJECT_SOURCE_DIR}/fuzz/${name}_corpus)
  set_tests_properties(fuzz.${name} PROPERTIES LABELS fast)
endfunction()

function(ejecta_no_fuzz name)
  add_test(NAME fuzz.${name} COMMAND sh -c "echo skipped: fuzzing needs clang; exit 77")
  set_tests_properties(fuzz.${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS fast)
endfunction()
