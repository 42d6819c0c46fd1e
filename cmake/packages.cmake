# The libraries that breve stands on, as targets that breve has found by itself.
#
# A host may have targets of the same names: built from source in its own tree, or made by hand. They need not be of the
# version or the configuration that breve is written for, and to link them without a word would show as a crash at run
# time. So a name that is taken is an error, unless it was found by the same find_package that breve calls, or the host
# says in BREVE_HOST_TARGETS that breve is to use its target.
set(BREVE_HOST_TARGETS "" CACHE STRING "Targets of the host that breve links in place of packages it finds, such as fmt::fmt")

# breve_package(TARGET PACKAGE [arguments of find_package…])
macro(breve_package target package)
  if("${target}" IN_LIST BREVE_HOST_TARGETS)
    if(NOT TARGET ${target})
      message(FATAL_ERROR "breve: BREVE_HOST_TARGETS names ${target}, and there is no such target before breve is added")
    endif()
  else()
    breve_refuse_other_target(${target} ${package})
    find_package(${package} ${ARGN} REQUIRED)
  endif()
endmacro()

function(breve_refuse_other_target target package)
  if(NOT TARGET ${target})
    return()
  endif()
  get_target_property(imported ${target} IMPORTED)
  if(imported AND ${package}_FOUND)
    return()
  endif()
  message(FATAL_ERROR
    "breve: the project that breve is added to has a target ${target} that find_package(${package}) did not make. "
    "breve is built with the package ${package} and does not link another target of that name unasked. "
    "Add breve before that target is made, or set BREVE_HOST_TARGETS to a list with ${target} to link it all the same.")
endfunction()

# breve_pkg_config(NAME MODULE): the target PkgConfig::breve_NAME. The prefix keeps apart what a host may have asked
# pkg-config under the same name: `bullet` for one has a build with floats and one with doubles.
macro(breve_pkg_config name module)
  pkg_check_modules(breve_${name} REQUIRED IMPORTED_TARGET ${module})
endmacro()

# breve_optional_package(TARGET PACKAGE USER DEBIAN_PACKAGE): finds what only a sample or test needs. Where it is
# missing, a message says what is left out.
macro(breve_optional_package target package user debian)
  if(NOT TARGET ${target})
    find_package(${package} QUIET)
  endif()
  if(NOT TARGET ${target})
    message(STATUS "breve: ${user} is left out: ${package} was not found (Debian: ${debian})")
  endif()
endmacro()
