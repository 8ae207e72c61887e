# tendril_component(NAME name SOURCES ... HEADERS ... LINK_PUBLIC ... LINK_INTERFACE ...)
# Folder = target = install component = export set. Headers live under <folder>/include and are listed by name, so
# that the path in the tree and the installed path cannot disagree.
include(GNUInstallDirs)

function(tendril_component)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;HEADERS;LINK_PUBLIC;LINK_INTERFACE" ${ARGN})
  set(target tendril_${ARG_NAME})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(tendril::${ARG_NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${ARG_NAME} POSITION_INDEPENDENT_CODE ON
    VERIFY_INTERFACE_HEADER_SETS ${PROJECT_IS_TOP_LEVEL})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${ARG_HEADERS})
  target_link_libraries(${target} PUBLIC ${ARG_LINK_PUBLIC} PRIVATE $<BUILD_INTERFACE:tendril_warnings>
                                  INTERFACE ${ARG_LINK_INTERFACE})

  set_property(GLOBAL APPEND PROPERTY TENDRIL_COMPONENTS ${ARG_NAME})

  set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tendril)
  install(TARGETS ${target} EXPORT tendril-${ARG_NAME}
    ARCHIVE COMPONENT ${ARG_NAME} LIBRARY COMPONENT ${ARG_NAME}
    FILE_SET HEADERS COMPONENT ${ARG_NAME})
  install(EXPORT tendril-${ARG_NAME} NAMESPACE tendril:: DESTINATION ${config_dir} COMPONENT ${ARG_NAME})
endfunction()
