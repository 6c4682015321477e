# The server of the workbench, where cpp-httplib is: a program of its own, which `ejecta serve` becomes.
find_path(HTTPLIB_INCLUDE httplib.h)
find_library(HTTPLIB cpp-httplib)
if(NOT HTTPLIB OR NOT HTTPLIB_INCLUDE)
  message(STATUS "the server of the workbench is not built: it needs libcpp-httplib-dev")
  return()
endif()

ejecta_room(serve USES base case shape study output simulation LIBS ${HTTPLIB} nlohmann_json::nlohmann_json)
# As Debian's library was built: objects have other members without.
target_compile_definitions(ejecta_serve PUBLIC CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/serve/page.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  COMPILE_DEFINITIONS "EJECTA_WORKBENCH_PAGE=\"${workbench_page}\";EJECTA_WORKBENCH_PAGE_SUM=\"${workbench_page}.hpp\"" OBJECT_DEPENDS ${workbench_page})

add_executable(ejecta-serve app/serve/main.cpp $<TARGET_OBJECTS:ejecta_serve>)
target_link_libraries(ejecta-serve PRIVATE libejecta ejecta_options ${HTTPLIB})
set_target_properties(ejecta-serve PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
