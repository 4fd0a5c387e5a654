# assay_add_estimators(FILE...): the list of plugin files is the registry.
#
# Each FILE, say luminaire/area.cpp, must define
#   std::vector<assay::Entry> assay::plugins::luminaire_area();
# A listed file that is missing is an error here; a missing function is an error when a program is
# linked; a name used twice throws when the catalogue is first asked for.
function(assay_add_estimators)
  set(ASSAY_PLUGIN_DECLARATIONS "")
  set(ASSAY_PLUGIN_CALLS "")
  foreach(file IN LISTS ARGN)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
      message(FATAL_ERROR "estimators/CMakeLists.txt lists the plugin file estimators/${file}, "
                          "which does not exist")
    endif()
    string(REGEX REPLACE "\\.cpp$" "" name ${file})
    string(MAKE_C_IDENTIFIER ${name} name)
    string(APPEND ASSAY_PLUGIN_DECLARATIONS "std::vector<Entry> ${name}();\n")
    string(APPEND ASSAY_PLUGIN_CALLS "       ${name},\n")
  endforeach()
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/catalogue_list.cpp.in
                 ${CMAKE_CURRENT_BINARY_DIR}/catalogue_list.cpp @ONLY)
  target_sources(assay_estimators PRIVATE ${ARGN} ${CMAKE_CURRENT_BINARY_DIR}/catalogue_list.cpp)
endfunction()
