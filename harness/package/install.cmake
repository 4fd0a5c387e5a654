# Installs the program, the headers of plugins, and a relocatable CMake package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ASSAY_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/assay)
install(TARGETS assay RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The interface of shared libraries: a plugin is compiled against it and linked against nothing.
install(FILES ${PROJECT_SOURCE_DIR}/estimators/plugin_abi.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/assay)

if(TARGET assay_googletest)
  install(TARGETS assay_googletest EXPORT assayTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT assayTargets NAMESPACE assay:: DESTINATION ${ASSAY_PACKAGE_DIR})
  # Their includes name these folders.
  foreach(header IN ITEMS harness/googletest/claims.h harness/googletest/matchers.h
          estimators/stream.h estimators/philox.h)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/assay/${folder})
  endforeach()
endif()

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/assayConfig.cmake.in ${PROJECT_BINARY_DIR}/package/assayConfig.cmake
  INSTALL_DESTINATION ${ASSAY_PACKAGE_DIR}
  PATH_VARS CMAKE_INSTALL_BINDIR CMAKE_INSTALL_INCLUDEDIR)
# Before 1.0 a minor version may change the meaning of suites and records.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/assayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/package/assayConfig.cmake
  ${PROJECT_BINARY_DIR}/package/assayConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/assayTests.cmake
  ${CMAKE_CURRENT_LIST_DIR}/assayTestsAtTestTime.cmake.in
  DESTINATION ${ASSAY_PACKAGE_DIR})
