// One of two files that are compiled together.
#include "runtime/space/headings.hpp"

namespace {

// It has the same name as one in the other file.
int helper(int x) { return x + 1; }

}  // namespace

void Headings::stands_here() { helper(1); }

int counter = 0;
