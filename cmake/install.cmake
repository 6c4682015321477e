# What `cmake --install` and the Debian package put where. A build with EJECTA_KERNELS_ONLY installs its library alone,
# into a folder that the loader prefers on processors that can run it (glibc-hwcaps, `man ld.so`): tools/package.sh.
option(EJECTA_KERNELS_ONLY "Install only the library, for processors of EJECTA_ARCH" OFF)
if(EJECTA_KERNELS_ONLY)
  install(TARGETS libejecta LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${EJECTA_ARCH} NAMELINK_SKIP)
  return()
endif()

# In the build folder the shipped cases are found as they are in an installation.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/ejecta)
foreach(folder cases validation verification)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/ejecta/${folder} SYMBOLIC)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/ejecta PATTERN "*.py" EXCLUDE)
endforeach()

# The program's own words as a man page and as completions of the shell.
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/ejecta.1 ${CMAKE_BINARY_DIR}/ejecta.bash
  COMMAND ejecta explain --man > ${CMAKE_BINARY_DIR}/ejecta.1
  COMMAND ejecta explain --completion > ${CMAKE_BINARY_DIR}/ejecta.bash DEPENDS ejecta VERBATIM)
add_custom_target(documents ALL DEPENDS ${CMAKE_BINARY_DIR}/ejecta.1)
install(FILES ${CMAKE_BINARY_DIR}/ejecta.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${CMAKE_BINARY_DIR}/ejecta.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME ejecta)

include(CMakePackageConfigHelpers)
file(RELATIVE_PATH library_from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(ejecta PROPERTIES INSTALL_RPATH "$ORIGIN/${library_from_program}")
install(TARGETS ejecta)
if(TARGET ejecta-serve)
  file(RELATIVE_PATH library_from_server ${CMAKE_INSTALL_FULL_LIBEXECDIR}/ejecta ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(ejecta-serve PROPERTIES INSTALL_RPATH "$ORIGIN/${library_from_server}")
  install(TARGETS ejecta-serve DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/ejecta)
endif()
install(TARGETS libejecta EXPORT ejectaTargets)
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ejecta FILES_MATCHING PATTERN "*.hpp" PATTERN app EXCLUDE)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/ejecta)
install(EXPORT ejectaTargets NAMESPACE ejecta:: DESTINATION ${config})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/ejectaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/ejectaConfig.cmake ${CMAKE_BINARY_DIR}/ejectaConfigVersion.cmake DESTINATION ${config})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_NAME ejecta)
set(CPACK_PACKAGE_CONTACT "the Ejecta authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "predicts which particles an air-jet sorter ejects")
set(CPACK_PACKAGE_FILE_NAME ejecta)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev, libfmt-dev, nlohmann-json3-dev, paraview, python3-numpy")
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};ejecta;ALL;/")
foreach(folder ${EJECTA_KERNEL_BUILDS})
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${folder};ejecta;ALL;/")
endforeach()
include(CPack)
