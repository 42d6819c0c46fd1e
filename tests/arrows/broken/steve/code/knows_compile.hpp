// A description of programs that knows who makes them.
#include "steve/compile/compile.hpp"
