# Installs the program, the headers of plugins, and a relocatable CMake package. The folder `prefix`
# of the build has the same shape, so that a project finds Assay without an installation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ASSAY_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/assay)
install(TARGETS assay RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET assay-mpi)
  install(TARGETS assay-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
set(page ${PROJECT_BINARY_DIR}/assay.1)
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:assay>\" man OUTPUT_FILE \"${page}\")")
install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
set(scripts ${PROJECT_SOURCE_DIR}/harness/command/completion)
set(data ${CMAKE_INSTALL_DATADIR})
install(FILES ${scripts}/assay.bash DESTINATION ${data}/bash-completion/completions RENAME assay)
install(FILES ${scripts}/assay.zsh DESTINATION ${data}/zsh/site-functions RENAME _assay)
install(FILES ${scripts}/assay.fish DESTINATION ${data}/fish/vendor_completions.d)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/estimators/foreign/python/ DESTINATION ${data}/assay/python
        PATTERN README.md EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN build EXCLUDE
        PATTERN *.egg-info EXCLUDE)
# The interface of shared libraries: a plugin is compiled against it and linked against nothing.
install(FILES ${PROJECT_SOURCE_DIR}/estimators/plugin_abi.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/assay)

if(TARGET assay_googletest)
  install(TARGETS assay_googletest EXPORT assayTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT assayTargets NAMESPACE assay:: DESTINATION ${ASSAY_PACKAGE_DIR})
  # Their includes name these folders.
  foreach(header IN ITEMS harness/googletest/claims.h harness/googletest/matchers.h
          estimators/stream.h)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/assay/${folder})
  endforeach()
endif()

set(built ${PROJECT_BINARY_DIR}/prefix)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/assayConfig.cmake.in ${built}/${ASSAY_PACKAGE_DIR}/assayConfig.cmake
  INSTALL_DESTINATION ${ASSAY_PACKAGE_DIR}
  PATH_VARS CMAKE_INSTALL_BINDIR CMAKE_INSTALL_INCLUDEDIR)
# Before 1.0 a minor version may change the meaning of suites and records.
write_basic_package_version_file(${built}/${ASSAY_PACKAGE_DIR}/assayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
foreach(file IN ITEMS assayTests.cmake assayTestsAtTestTime.cmake.in)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${file} ${built}/${ASSAY_PACKAGE_DIR}/${file} COPYONLY)
endforeach()
install(DIRECTORY ${built}/${ASSAY_PACKAGE_DIR}/ DESTINATION ${ASSAY_PACKAGE_DIR}
        PATTERN assayTargets* EXCLUDE)

set(include ${built}/${CMAKE_INSTALL_INCLUDEDIR}/assay)
file(MAKE_DIRECTORY ${include} ${built}/${CMAKE_INSTALL_BINDIR})
file(CREATE_LINK ${PROJECT_BINARY_DIR}/harness/assay ${built}/${CMAKE_INSTALL_BINDIR}/assay SYMBOLIC)
foreach(header IN ITEMS estimators/plugin_abi.h estimators harness)
  cmake_path(GET header FILENAME name)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${header} ${include}/${name} SYMBOLIC)
endforeach()
if(TARGET assay_googletest)
  export(EXPORT assayTargets NAMESPACE assay:: FILE ${built}/${ASSAY_PACKAGE_DIR}/assayTargets.cmake)
endif()
