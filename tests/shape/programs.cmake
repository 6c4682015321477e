include(${PROJECT_SOURCE_DIR}/cmake/fuzz.cmake)
file(GLOB shape_sources RELATIVE ${PROJECT_SOURCE_DIR}/src CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/shape/*.cpp)
ejecta_fuzz(stl SOURCES ${shape_sources} base/parallel.cpp base/team.cpp base/storage.cpp INCLUDES ${EIGEN3_INCLUDE_DIRS} LIBS -lfmt)
