include(${PROJECT_SOURCE_DIR}/cmake/fuzz.cmake)
ejecta_fuzz(stl ejecta_shape)
