# tendril_component(NAME name SOURCES ... HEADERS ... LINK_PUBLIC ... LINK_PRIVATE ... LINK_INTERFACE ...)
# Folder = target = install component = export set. Headers live under <folder>/include and are listed by name, so
# that the path in the tree and the installed path cannot disagree. Static or shared as BUILD_SHARED_LIBS says; both are
# built with hidden symbols, and tendril/base/export.h marks what a shared one shows. Where TENDRIL_UNITY is on, the
# sources of a room (a folder) are compiled as one.
include(GNUInstallDirs)
include(CheckLinkerFlag)

set(tendril_exported ${CMAKE_CURRENT_LIST_DIR}/exported.map)
check_linker_flag(CXX "LINKER:--version-script=${tendril_exported}" TENDRIL_HAS_VERSION_SCRIPT)

# What only a shared library asks for. Calls to its own functions are no invitation to replace them: they are inlined as in
# a static one, so that both give the same bits.
function(tendril_shared target)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "$ORIGIN")
  target_compile_definitions(${target} PUBLIC TENDRIL_SHARED)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  if(TENDRIL_HAS_VERSION_SCRIPT)
    target_link_options(${target} PRIVATE "LINKER:--version-script=${tendril_exported}")
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${tendril_exported})
  endif()
endfunction()

# Compile options of single sources. One that is not there is an error: CMake itself would say nothing, and a source that
# moved would lose them.
function(tendril_source_options options)
  foreach(source IN LISTS ARGN)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
      message(FATAL_ERROR "options for ${source}, which is no file of ${CMAKE_CURRENT_SOURCE_DIR}")
    endif()
  endforeach()
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${options}")
endfunction()

# Where TENDRIL_UNITY is on, sources of the target are compiled together: eight at a time, or as the properties say.
function(tendril_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TENDRIL_UNITY} ${ARGN})
  if(TENDRIL_UNITY)  # what a source has for itself is no header's there, though it is included
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

function(tendril_component)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;HEADERS;LINK_PUBLIC;LINK_PRIVATE;LINK_INTERFACE" ${ARGN})
  set(target tendril_${ARG_NAME})
  add_library(${target} ${ARG_SOURCES})
  add_library(tendril::${ARG_NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${ARG_NAME} POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    VERIFY_INTERFACE_HEADER_SETS ${PROJECT_IS_TOP_LEVEL})
  foreach(source IN LISTS ARG_SOURCES)
    cmake_path(GET source PARENT_PATH room)
    string(MAKE_C_IDENTIFIER "${room}" room)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room})
  endforeach()
  tendril_unity(${target} UNITY_BUILD_MODE GROUP)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${ARG_HEADERS})
  target_link_libraries(${target} PUBLIC ${ARG_LINK_PUBLIC} PRIVATE ${ARG_LINK_PRIVATE} $<BUILD_INTERFACE:tendril_warnings>
                                  INTERFACE ${ARG_LINK_INTERFACE})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL SHARED_LIBRARY)
    tendril_shared(${target})
  endif()

  set_property(GLOBAL APPEND PROPERTY TENDRIL_COMPONENTS ${ARG_NAME})

  set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tendril)
  install(TARGETS ${target} EXPORT tendril-${ARG_NAME}
    ARCHIVE COMPONENT ${ARG_NAME} LIBRARY COMPONENT ${ARG_NAME} RUNTIME COMPONENT ${ARG_NAME}
    FILE_SET HEADERS COMPONENT ${ARG_NAME})
  install(EXPORT tendril-${ARG_NAME} NAMESPACE tendril:: DESTINATION ${config_dir} COMPONENT ${ARG_NAME})
endfunction()
