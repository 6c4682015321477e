# Fuzzers need clang's libFuzzer, whatever the compiler of the program. ejecta_fuzz(NAME SOURCES... LIBS...) builds
# fuzz/NAME_fuzz.cpp with the sources (relative to src/) under address and undefined-behaviour sanitizers, and adds
# a short run from fuzz/NAME_corpus as a test. A long run:
#   build/release/fuzz/NAME_fuzz -max_total_time=600 /tmp/corpus fuzz/NAME_corpus
find_program(FUZZ_COMPILER NAMES clang++-14 clang++-15 clang++-16 clang++)

function(ejecta_fuzz name)
  cmake_parse_arguments(FUZZ "" "" "SOURCES;LIBS;INCLUDES" ${ARGN})
  if(NOT FUZZ_COMPILER)
    add_test(NAME fuzz.${name} COMMAND sh -c "echo skipped: fuzzing needs clang; exit 77")
    set_tests_properties(fuzz.${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS fast)
    return()
  endif()
  set(binary ${CMAKE_BINARY_DIR}/fuzz/${name}_fuzz)
  list(TRANSFORM FUZZ_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/src/)
  list(TRANSFORM FUZZ_INCLUDES PREPEND -isystem)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz/${name}_new)
  # One translation unit, so that headers are read once.
  set(all ${CMAKE_BINARY_DIR}/fuzz/${name}_fuzz_all.cpp)
  list(TRANSFORM FUZZ_SOURCES REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
  string(JOIN "" includes ${includes} "#include \"${PROJECT_SOURCE_DIR}/fuzz/${name}_fuzz.cpp\"\n")
  file(CONFIGURE OUTPUT ${all} CONTENT "${includes}" @ONLY)
  add_custom_command(OUTPUT ${binary} DEPENDS ${all} DEPFILE ${binary}.d
    COMMAND ${FUZZ_COMPILER} -std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all
            -I${PROJECT_SOURCE_DIR}/src ${FUZZ_INCLUDES} -MD -MF ${binary}.d -MT ${binary} ${all} -o ${binary}
            ${FUZZ_LIBS}
    COMMENT "Building the fuzzer of ${name}")
  add_custom_target(fuzz_${name} ALL DEPENDS ${binary})
  add_test(NAME fuzz.${name} COMMAND ${binary} -runs=50000 -max_total_time=10 -seed=1 -print_final_stats=1
           ${CMAKE_BINARY_DIR}/fuzz/${name}_new ${PROJECT_SOURCE_DIR}/fuzz/${name}_corpus)
  set_tests_properties(fuzz.${name} PROPERTIES LABELS fast)
endfunction()
