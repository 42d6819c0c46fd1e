/* debug_draw.h: lines, points and texts that show what the simulation does. A part of breve.h, whose rules hold here.
 *
 * A host that can draw a line sees the shapes of bodies, their contacts and joints on top of its own picture. Nothing
 * is gathered beforehand: a world that nobody draws pays nothing.
 */
#ifndef BREVE_DEBUG_DRAW_H
#define BREVE_DEBUG_DRAW_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- debug draw -------------------------------------------------------------------------------------------------- */

/* Parts of a drawing, to be added. */
typedef enum breve_debug {
  BREVE_DEBUG_SHAPES = 1, /* edges of the shape of each body, in its colour; those of bodies that sleep are dimmed */
  BREVE_DEBUG_AXES = 2,   /* the axes of each body: x red, y green, z blue, as long as its radius */
  BREVE_DEBUG_VELOCITIES = 4, /* where the centre of each body would be after one second at its velocity */
  BREVE_DEBUG_CONTACTS = 8,   /* a point and the normal of each contact that breve_world_contacts lists */
  BREVE_DEBUG_IMPACTS = 16,   /* a point and the impulse of each impact of the last iteration (breve_world_impacts) */
  BREVE_DEBUG_JOINTS = 32,    /* from the centre of each link to the pivot, and the axis of joints that have one */
  BREVE_DEBUG_NEIGHBORHOODS = 64, /* a circle for the neighbourhood size of each object that has one */
  BREVE_DEBUG_NAMES = 128,        /* the class of each body, and its label if it has one */
  BREVE_DEBUG_ALL = 255
} breve_debug;

/* Functions of a host that draw. Positions are in the world frame; a colour has four numbers from 0 to 1. Functions
   that are NULL are not called, and what needs only these is not computed. They must not call the library. */
typedef struct breve_debug_draw {
  size_t struct_size;   /* set by breve_debug_draw_default */
  void* user;           /* passed to the functions. Default NULL */
  uint32_t parts;       /* sum of breve_debug. Default BREVE_DEBUG_SHAPES | _CONTACTS | _JOINTS */
  uint32_t segments;    /* of a circle, 3 to 256. Default 24 */
  double impulse_scale; /* length units for 1 N*s of an impact. Default 1 */
  void (*line)(void* user, const double from[3], const double to[3], const double rgba[4]);
  void (*point)(void* user, const double at[3], const double rgba[4]);
  void (*text)(void* user, const double at[3], const char* text, const double rgba[4]);
} breve_debug_draw;

/* The defaults named above. */
static inline breve_debug_draw breve_debug_draw_default(void) {
  breve_debug_draw draw;
  breve_clear(&draw, sizeof draw);
  draw.struct_size = sizeof draw;
  draw.parts = BREVE_DEBUG_SHAPES | BREVE_DEBUG_CONTACTS | BREVE_DEBUG_JOINTS;
  draw.segments = 24;
  draw.impulse_scale = 1;
  return draw;
}

/* Draws the world as it is now, object by object in the order of creation. Runs no script and changes nothing.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, a bit that is not a breve_debug, a number of segments or a
   scale out of range. */
BREVE_API breve_status breve_world_debug_draw(const breve_world* world, const breve_debug_draw* draw);

#ifdef __cplusplus
}
#endif

#endif
