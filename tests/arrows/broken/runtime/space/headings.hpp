// Headings that are not true.
#pragma once

class Headings {
 public:
  // nowhere.cpp
  void stands_nowhere();

  void stands_elsewhere();

  // one.cpp
  void stands_here();
};
