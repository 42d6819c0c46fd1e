// Rows that know who solves them.
#include "runtime/dynamics/island_solve.hpp"
