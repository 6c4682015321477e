# What the output room needs besides its sources: facts about the build, and the report page.

find_package(ZLIB REQUIRED)
target_link_libraries(ejecta_output PUBLIC ZLIB::ZLIB)

# Workbooks of Excel, where libxlsxwriter is.
find_path(XLSXWRITER_INCLUDE xlsxwriter.h)
find_library(XLSXWRITER xlsxwriter)
if(XLSXWRITER AND XLSXWRITER_INCLUDE)
  target_link_libraries(ejecta_output PUBLIC ${XLSXWRITER})
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/output/workbook.cpp PROPERTIES COMPILE_DEFINITIONS EJECTA_XLSX
                              SKIP_UNITY_BUILD_INCLUSION ON)
else()
  message(STATUS "workbooks of Excel are not written: that needs libxlsxwriter-dev")
endif()

execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision)
  set(revision unknown)
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
get_target_property(options ejecta_options INTERFACE_COMPILE_OPTIONS)
list(FILTER options EXCLUDE REGEX "prefix-map")  # holds a path of the source tree
string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${options})
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/output/build_info.cpp PROPERTIES COMPILE_DEFINITIONS
  "EJECTA_VERSION=\"${PROJECT_VERSION}\";EJECTA_GIT_REVISION=\"${revision}\";EJECTA_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\";EJECTA_COMPILE_FLAGS=\"${flags}\";EJECTA_ARCH=\"${EJECTA_ARCH}\"")

# The report page (report/, TypeScript) is built where npm is found and becomes part of the program. Elsewhere,
# or when npm cannot fetch its packages, the page is empty and `ejecta` writes a plain report that says so.
find_program(NPM npm)
option(EJECTA_REPORT "Build the report page with npm" ON)
file(GLOB_RECURSE report_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/report/src/*)
set(report_page ${CMAKE_BINARY_DIR}/report/page.html)
set(workbench_page ${CMAKE_BINARY_DIR}/report/workbench-page.html)
if(NPM AND EJECTA_REPORT)
  add_custom_command(OUTPUT ${report_page} ${workbench_page}
    COMMAND ${CMAKE_COMMAND} -DNPM=${NPM} -DSOURCE=${PROJECT_SOURCE_DIR}/report -DBUILD=${CMAKE_BINARY_DIR}/report
            -DPAGE=${report_page} -DWORKBENCH=${workbench_page} -P ${PROJECT_SOURCE_DIR}/cmake/build_report.cmake
    DEPENDS ${report_sources} ${PROJECT_SOURCE_DIR}/report/index.html ${PROJECT_SOURCE_DIR}/report/workbench.html ${PROJECT_SOURCE_DIR}/report/package-lock.json
            ${PROJECT_SOURCE_DIR}/report/vite.config.ts ${PROJECT_SOURCE_DIR}/report/tsconfig.json
            ${PROJECT_SOURCE_DIR}/cmake/build_report.cmake
    COMMENT "Building the pages of the report and the workbench")
else()
  message(STATUS "npm not found: reports will be plain tables")
  file(WRITE ${report_page} "")
  file(WRITE ${report_page}.hpp "")
  file(WRITE ${workbench_page} "")
  file(WRITE ${workbench_page}.hpp "")
endif()
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/output/report_page.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  COMPILE_DEFINITIONS "EJECTA_REPORT_PAGE=\"${report_page}\";EJECTA_REPORT_PAGE_SUM=\"${report_page}.hpp\""
  OBJECT_DEPENDS ${report_page})
