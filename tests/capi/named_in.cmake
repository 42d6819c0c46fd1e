# Fails if a function of the headers in HEADERS is not named in TEST, unless its name matches EXCEPT.
# A parenthesis follows a name that is called; AFTER is another expression for what follows:
#   cmake -DHEADERS=folder -DTEST=file.c [-DEXCEPT=^breve_analysis_] [-DAFTER=[^a-z_]] -P named_in.cmake
if(NOT AFTER)
  set(AFTER "\\(")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/declared.cmake)
declared_functions(names ${HEADERS})
file(READ ${TEST} test)
foreach(name IN LISTS names)
  if(NOT test MATCHES "[^a-z_]${name}${AFTER}" AND NOT (EXCEPT AND name MATCHES "${EXCEPT}"))
    message(SEND_ERROR "${name} is not in ${TEST}")
  endif()
endforeach()
