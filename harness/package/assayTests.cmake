# Makes a CTest test of each claim of a suite when ctest runs. A new claim needs no build. A
# misspelt one is a failed test with the program's message.
#
#   assay_discover_tests(SUITE
#     [PREFIX text]               before each test's id, where two suites have one name
#     [ARGUMENTS argument…]       of `assay run`; generator expressions may stand in them
#     [WORKING_DIRECTORY folder]  default the current source folder
#     [PROPERTIES name value…])   of all the tests
#
# Each test runs alone, on its fixed share of the suite's alpha. Exit code 77, all skipped, is a
# skip. ARGUMENTS --set mine.file=$<TARGET_FILE:mine> names a library that this build makes.
set(_assay_tests_template ${CMAKE_CURRENT_LIST_DIR}/assayTestsAtTestTime.cmake.in)

function(assay_discover_tests suite)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "PREFIX;WORKING_DIRECTORY" "ARGUMENTS;PROPERTIES")
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "assay_discover_tests: what is `${ARG_UNPARSED_ARGUMENTS}`?")
  endif()
  get_filename_component(suite "${suite}" ABSOLUTE)
  if(NOT EXISTS "${suite}")
    message(FATAL_ERROR "assay_discover_tests: there is no suite ${suite}")
  endif()
  if(NOT ARG_WORKING_DIRECTORY)
    set(ARG_WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  string(MD5 name "${suite} ${ARG_PREFIX}")
  set(file ${CMAKE_CURRENT_BINARY_DIR}/assay_tests_${name})
  configure_file(${_assay_tests_template} ${file}.cmake.in @ONLY)
  get_property(multiple GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
  if(multiple)
    file(GENERATE OUTPUT ${file}-$<CONFIG>.cmake INPUT ${file}.cmake.in)
    file(WRITE ${file}.cmake "include(\"${file}-\${CTEST_CONFIGURATION_TYPE}.cmake\")\n")
  else()
    file(GENERATE OUTPUT ${file}.cmake INPUT ${file}.cmake.in)
  endif()
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file}.cmake)
endfunction()

# Builds a shared library of estimators in C or C++ for the plugin `library`:
#
#   assay_add_plugin(NAME source…)
#
# It finds `estimators/plugin_abi.h`, links nothing and exports what that header declares.

function(assay_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_include_directories(${name} PRIVATE ${_assay_include_dir})
  set_target_properties(${name} PROPERTIES
    PREFIX "" C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden)
endfunction()
