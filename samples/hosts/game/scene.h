/* How the meadow looks. */
#ifndef SCENE_H
#define SCENE_H

#include "meadow.h"

/* @param debug  with what breve's debug draw shows: shapes, velocities, neighbourhoods, names
   @param notice  a line for the player, for a moment; "" if there is none */
void scene_draw(meadow* m, double seconds, bool debug, const char* notice);

#endif
