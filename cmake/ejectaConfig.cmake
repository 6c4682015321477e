# find_package(ejecta): the library as ejecta::ejecta. Its headers hold values of these.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(fmt)
find_dependency(nlohmann_json)
include(${CMAKE_CURRENT_LIST_DIR}/ejectaTargets.cmake)
