// A compiler that knows what runs its programs.
#include "steve/machine/machine.hpp"
