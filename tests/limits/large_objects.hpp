// How objects of each class are made large, in one way or in several: what a native's work may grow with.
#pragma once

#include <string_view>
#include <vector>

namespace breve::limits {

/// A way in which an object is made so large that a call that goes through it just fits the budget, and arguments that
/// fit it.
struct Large {
  std::string_view cls;
  std::string_view made;               // statements; '@' stands for the variable that takes it
  std::string_view fitting = "";       // statements that fill the list `fitting`, an argument that it takes
  std::string_view word = "\"move\"";  // the same for a string
};

/// The ways of a class; none if it has no size.
std::vector<Large> ways_to_be_large(std::string_view cls);

/// Classes that the programs define: what must be derived from before it works.
std::string_view derived_classes();

}  // namespace breve::limits
