cmake_policy(VERSION 3.20)
# Fails if a function breve_THING_set_PROPERTY of the headers in HEADERS is neither in the table of TEST nor in the list of
# those whose input has no parts, or whose parts another test breaks:
#   cmake -DHEADERS=folder -DTEST=setters.c -P setters.cmake
set(without_parts
  breve_world_set_paused breve_world_set_sleeping breve_world_set_workers breve_world_set_guard breve_world_set_events
  breve_world_set_interpolated breve_world_set_iteration_step breve_world_set_integration_step breve_world_set_time_scale
  breve_world_set_user breve_world_set_may_collide breve_world_set_listener
  breve_object_set_physics breve_object_set_self_collisions breve_object_set_shape breve_object_set_user
  breve_object_set_collides)
set(elsewhere
  breve_grid_set_concentrations  # grids.c
  breve_world_set_state          # user_data.c
  breve_view_set_camera          # view.c
  breve_view_set_arrows)         # tests/seeing/arrows_tests.cpp
include(${CMAKE_CURRENT_LIST_DIR}/declared.cmake)
declared_functions(names ${HEADERS})
file(READ ${TEST} test)
set(setters 0)
foreach(name IN LISTS names)
  if(NOT name MATCHES "_set_" OR name IN_LIST without_parts OR name IN_LIST elsewhere)
    continue()
  endif()
  math(EXPR setters "${setters} + 1")
  if(NOT test MATCHES "{\"${name}\", ")
    message(SEND_ERROR "${name} is not tried with a part that is bad: add it to setters.c")
  endif()
endforeach()
if(setters EQUAL 0)
  message(SEND_ERROR "no setters in ${HEADERS}")
endif()
