# Copies report/ into the build folder and builds the page there, so that the source tree stays clean.
# A failure gives an empty page, not a failed build: the program works without it.
file(REMOVE_RECURSE ${BUILD}/src)  # what is gone there goes here
file(COPY ${SOURCE}/ DESTINATION ${BUILD} PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE)
file(REMOVE_RECURSE ${BUILD}/dist)
file(SHA256 ${BUILD}/package-lock.json lock)
set(installed "")
if(EXISTS ${BUILD}/node_modules/.installed)
  file(READ ${BUILD}/node_modules/.installed installed)
endif()
if(NOT installed STREQUAL lock)
  execute_process(COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${BUILD}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(NOT failed)
    file(WRITE ${BUILD}/node_modules/.installed ${lock})
  endif()
endif()
if(NOT failed)
  execute_process(COMMAND ${NPM} run --silent build WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE failed
                  OUTPUT_VARIABLE log ERROR_VARIABLE log)
endif()
if(failed)
  message(WARNING "The report page was not built; reports will be plain tables.\n${log}")
  file(WRITE ${PAGE} "")
  file(WRITE ${WORKBENCH} "")
  execute_process(COMMAND touch -d @0 ${PAGE} ${WORKBENCH})  # older than its sources: the next build tries again
else()
  file(COPY_FILE ${BUILD}/dist/index.html ${PAGE})
  file(COPY_FILE ${BUILD}/dist/workbench.html ${WORKBENCH})
endif()
foreach(page ${PAGE} ${WORKBENCH})
  file(SHA256 ${page} sum)
  file(WRITE ${page}.hpp "// ${sum}\n")
endforeach()
