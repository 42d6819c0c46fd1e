cmake_policy(VERSION 3.20)
# Fails if a function breve_THING_set_PROPERTY of the headers in HEADERS has no breve_THING_PROPERTY or
# breve_THING_get, and is not in the table of those that are read back in another way:
#   cmake -DHEADERS=folder -P getters.cmake
set(elsewhere
  breve_object_set_assembly_pose=breve_object_pose    # the pose of the body
  breve_world_set_may_collide=                        # a callback of the host, which knows what it has set
  breve_object_set=breve_object_get
  breve_objects_set=breve_objects_get
  breve_hash_set=breve_hash_get
  breve_world_queue_key=                              # input: what handlers make of it is the world's state
  breve_world_queue_click=
  breve_world_queue_choice=breve_world_menu_items)
include(${CMAKE_CURRENT_LIST_DIR}/declared.cmake)
declared_functions(names ${HEADERS})
set(setters 0)
foreach(name IN LISTS names)
  if(NOT name MATCHES "^breve_[a-z]+_set(_|$)" AND NOT name MATCHES "_queue_")
    continue()
  endif()
  math(EXPR setters "${setters} + 1")
  string(REGEX REPLACE "^(breve_[a-z]+)_set_" "\\1_" getter "${name}")
  foreach(pair IN LISTS elsewhere)
    if(pair MATCHES "^${name}=(.*)$")
      set(getter "${CMAKE_MATCH_1}")
    endif()
  endforeach()
  if(getter STREQUAL "" OR getter IN_LIST names)
    continue()
  endif()
  message(SEND_ERROR "${name} sets what no function reads: ${getter} is not declared")
endforeach()
if(setters LESS 35)
  message(FATAL_ERROR "found ${setters} setters in ${HEADERS}: the pattern is out of date")
endif()
