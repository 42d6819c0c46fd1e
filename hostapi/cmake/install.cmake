# What `cmake --install` puts where. Components: runtime (the shared library), development (headers, what compilers,
# CMake and pkg-config need, the static library), command.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(breve_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/breve)
set(made ${CMAKE_CURRENT_BINARY_DIR}/package)

install(DIRECTORY include/breve DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING
  PATTERN "*.h" PATTERN "*.hpp")

# The libraries below the static one, each by its find_package or pkg-config, its target and its module of pkg-config.
set(breve_find_dependencies
  "find_dependency(Threads)\nfind_dependency(fmt)\nfind_dependency(ZLIB)\nfind_dependency(pugixml)\nfind_dependency(EXPAT)\nfind_dependency(TBB CONFIG)\n")
set(breve_dependency_targets "fmt::fmt;ZLIB::ZLIB;pugixml::pugixml;EXPAT::EXPAT;TBB::tbb")
set(breve_dependency_modules "fmt, zlib, pugixml, expat, tbb")
# Shared ones by their names: their modules of pkg-config ask for what only their own static libraries need.
set(breve_dependency_libraries "")

# breve_needs_module(NAME MODULE): what breve_pkg_config found is needed below the static library.
macro(breve_needs_module name module)
  string(APPEND breve_find_dependencies
    "find_dependency(PkgConfig)\npkg_check_modules(breve_${name} REQUIRED QUIET IMPORTED_TARGET ${module})\n")
  list(APPEND breve_dependency_targets PkgConfig::breve_${name})
endmacro()

if(BREVE_WITH_PLANAR)
  string(APPEND breve_find_dependencies "find_dependency(box2d)\n")
  list(APPEND breve_dependency_targets box2d::box2d)
  string(APPEND breve_dependency_modules ", box2d")
endif()
if(BREVE_WITH_MESHES)
  breve_needs_module(assimp assimp)
  string(APPEND breve_dependency_modules ", assimp")
endif()
if(BREVE_WITH_SOUND_FILES)
  breve_needs_module(sndfile sndfile)
  string(APPEND breve_dependency_libraries " -lsndfile")
endif()
if(BREVE_WITH_GDAL)
  breve_needs_module(gdal gdal)
  string(APPEND breve_dependency_modules ", gdal")
endif()
if(BREVE_WITH_NETWORK)
  breve_needs_module(httplib cpp-httplib)
  string(APPEND breve_dependency_libraries " -lcpp-httplib")
endif()
if(BREVE_WITH_RENDER)
  string(APPEND breve_find_dependencies "find_dependency(Freetype)\n")
  list(APPEND breve_dependency_targets Freetype::Freetype)
  string(APPEND breve_dependency_modules ", freetype2")
endif()
list(APPEND breve_dependency_targets Threads::Threads ${CMAKE_DL_LIBS})

if(breve_type STREQUAL "SHARED_LIBRARY")
  set(kind Shared)
  install(TARGETS breve
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
else()
  set(kind Static)
  # One archive, so that nobody needs to know the parts.
  set(archives breve breve_analysis breve_library breve_machine breve_compile breve_code breve_syntax breve_runtime)
  if(BREVE_WITH_RENDER)
    list(APPEND archives breve_render)
  endif()
  list(TRANSFORM archives REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  install(CODE "
    execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DAR=${CMAKE_AR}\" \"-DOUT=${made}/libbreve.a\" \"-DARCHIVES=${archives}\"
      -P \"${CMAKE_CURRENT_SOURCE_DIR}/cmake/merge_archives.cmake\" COMMAND_ERROR_IS_FATAL ANY)
  " COMPONENT development)
  install(FILES ${made}/libbreve.a DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()

file(RELATIVE_PATH breve_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" breve_pc_to_prefix "${breve_pc_to_prefix}")
configure_file(cmake/breve.pc.in ${made}/breve.pc @ONLY)
configure_file(cmake/breve${kind}.cmake.in ${made}/breve${kind}.cmake @ONLY)
configure_package_config_file(cmake/breveConfig.cmake.in ${made}/breveConfig.cmake
  INSTALL_DESTINATION ${breve_config_folder} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before version 1 the minor number rises with whatever breaks.
write_basic_package_version_file(${made}/breveConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${made}/breveConfig.cmake ${made}/breveConfigVersion.cmake ${made}/breve${kind}.cmake
  DESTINATION ${breve_config_folder} COMPONENT development)
install(FILES ${made}/breve.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(BREVE_WITH_LUA)
  install(TARGETS breve_lua ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  configure_file(cmake/breve-lua.pc.in ${made}/breve-lua.pc @ONLY)
  install(FILES ${made}/breve-lua.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
  # Where interpreters of Debian and those below /usr/local look.
  install(TARGETS breve_lua_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/lua/5.4 COMPONENT command)
endif()

if(BREVE_WITH_COMMAND)
  install(TARGETS breve_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(FILES command/breve.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)
  install(FILES command/completion/breve.bash RENAME breve
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
  install(FILES command/completion/_breve DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command)
endif()
include(${CMAKE_CURRENT_SOURCE_DIR}/cmake/packages.cmake)
