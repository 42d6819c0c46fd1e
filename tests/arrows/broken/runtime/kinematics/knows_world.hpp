// Breaks the house on purpose: a backend that knows the world.
#pragma once
#include "runtime/world/world.hpp"
