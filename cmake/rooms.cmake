# One library a room. A room links only the rooms it may know (docs: ARCHITECTURE.md), so the linker
# enforces the table; tools/check_includes.py enforces it for headers.

add_library(ejecta_options INTERFACE)
target_include_directories(ejecta_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
# Inline functions of the library stay its own: a program that includes its headers may be built for an older
# processor. No path of the source tree comes into the program.
# Whole registers where there is AVX-512: GCC takes half of them for Intel's, 12 to 18 % of a flow step on a Xeon.
target_compile_options(ejecta_options INTERFACE -march=${EJECTA_ARCH} -mprefer-vector-width=512 -fvisibility-inlines-hidden
                       -fno-semantic-interposition -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
# Objects lie alike in memory whatever processor a library or a program with its headers was built for.
target_compile_definitions(ejecta_options INTERFACE EIGEN_MAX_STATIC_ALIGN_BYTES=16)
# No -ffast-math: NaN must stay detectable and sums must keep their order.
# GCC 12 warns of uninitialised __Y inside its own AVX-512 header.
target_compile_options(ejecta_options INTERFACE -Wall -Wextra -Wpedantic $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed> -fopenmp-simd -fno-math-errno
                       -fno-trapping-math)
target_link_libraries(ejecta_options INTERFACE fmt::fmt Eigen3::Eigen Threads::Threads)
target_compile_definitions(ejecta_options INTERFACE EIGEN_DONT_PARALLELIZE)
if(EJECTA_DOUBLE)
  target_compile_definitions(ejecta_options INTERFACE EJECTA_DOUBLE)
endif()
if(EJECTA_SANITIZE)
  target_compile_options(ejecta_options INTERFACE -fsanitize=${EJECTA_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer $<$<CXX_COMPILER_ID:Clang>:-fsanitize=fuzzer-no-link>)
  target_link_options(ejecta_options INTERFACE -fsanitize=${EJECTA_SANITIZE})
endif()

# Several files of a room are compiled as one, so that Eigen, fmt and the headers of the room are read and
# instantiated once (docs/decisions/build-time.md). Names in the files of a room therefore differ, in anonymous
# namespaces too. Loops over cells, faces and bodies get -O3, all else -O1.
option(EJECTA_UNITY "Compile several files as one" ON)
function(ejecta_compile_as_one target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${EJECTA_UNITY} UNITY_BUILD_BATCH_SIZE 24)
endfunction()

# ejecta_room(flow [KERNELS] USES base case grid [LIBS hdf5...])
function(ejecta_room name)
  cmake_parse_arguments(ROOM "KERNELS" "" "USES;LIBS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/app/(cli|serve)/main\\.cpp$")
  if(sources)
    add_library(ejecta_${name} STATIC ${sources})
    set(scope PUBLIC)
    ejecta_compile_as_one(ejecta_${name})
    if(NOT ROOM_KERNELS)
      target_compile_options(ejecta_${name} PRIVATE -O1)
    endif()
  else()
    add_library(ejecta_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(ejecta_${name} ${scope} ejecta_options ${ROOM_LIBS})
  foreach(room ${ROOM_USES})
    target_link_libraries(ejecta_${name} ${scope} ejecta_${room})
  endforeach()
endfunction()
