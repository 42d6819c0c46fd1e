// Breaks the house on purpose: the command stands on breve.h alone.
#include "steve/machine/machine.hpp"
