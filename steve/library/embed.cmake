# Turns the files of the class library into one C++ table: name, text, classes and aliases of each.
# Run as: cmake -DOUTPUT=FILE -DSOURCES="A.tz;B.tz;..." -DFOLDER=DIR -P embed.cmake
# A long string literal is cut into adjacent pieces, which every compiler joins.

set(chunk 8000)
set(table "")
set(texts "")
foreach(source IN LISTS SOURCES)
  file(READ "${FOLDER}/${source}" text)
  string(REGEX REPLACE "[^A-Za-z0-9]" "_" symbol "${source}")

  # Classes are the only lines that start with "Parent : Name", optionally "(aka Alias)".
  string(REGEX MATCHALL "\n[A-Za-z0-9]+ : [A-Za-z0-9]+( \\(aka [A-Za-z0-9]+\\))?" headers "\n${text}")
  set(classes "")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "\n[A-Za-z0-9]+ : ([A-Za-z0-9]+).*" "\\1" name "${header}")
    string(APPEND classes " ${name}")
    if(header MATCHES "\\(aka ([A-Za-z0-9]+)\\)")
      string(APPEND classes " ${CMAKE_MATCH_1}")
    endif()
  endforeach()
  string(STRIP "${classes}" classes)

  string(LENGTH "${text}" length)
  string(APPEND texts "constexpr std::string_view k${symbol} =\n")
  set(position 0)
  while(position LESS length)
    string(SUBSTRING "${text}" ${position} ${chunk} piece)
    string(APPEND texts "R\"steve(${piece})steve\"\n")
    math(EXPR position "${position} + ${chunk}")
  endwhile()
  string(APPEND texts ";\n\n")
  string(APPEND table "    {\"${source}\", k${symbol}, \"${classes}\"},\n")
endforeach()

file(WRITE "${OUTPUT}" "// Made by embed.cmake from the files of the class library.
#include \"steve/library/library.hpp\"

namespace breve::steve {

namespace {

${texts}constexpr LibraryFile kFiles[] = {
${table}};

}  // namespace

std::span<const LibraryFile> library_files() { return kFiles; }

}  // namespace breve::steve
")
