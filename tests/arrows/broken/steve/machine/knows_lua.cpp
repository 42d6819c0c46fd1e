#include <lua.h>
#include <SDL.h>
