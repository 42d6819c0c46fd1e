/* The program that is drawn, and what the tests of scenes and of pictures read from it. */
#include "show.h"

#include <math.h>

static const char* const start =
    "@use Control.\n@use Mobile.\n@use Stationary.\n@use Shape.\n@use Image.\n@use Camera.\n@use Graph.\n"
    "Mobile : Thing {\n"
    "\t+ to become from shape (object) at place (vector) in color (vector):\n"
    "\t\tself set-shape to shape. self move to place. self set-color to color. return self.\n"
    "}\n"
    "Controller Show.\nControl : Show {\n"
    "\t+ variables: ball, box, thing, picture, eye (object). count (int).\n"
    "\t+ to init:\n"
    "\t\tball = ((new Sphere) init-with radius 2). box = ((new Cube) init-with size (10, 10, 1)).\n"
    "\t\tself set-background-color to (0, 0, 0).\n";

bool open_show(scene* s, const char* body) {
  char text[4096];
  snprintf(text, sizeof text, "%s%s}\n", start, body);
  return scene_open_text(s, text, NULL);
}

breve_rows rows_of(breve_scene* scene, uint32_t kind) {
  breve_rows rows = {NULL, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_scene_rows(scene, kind, &rows));
  return rows;
}

const void* row(const breve_rows* rows, size_t i) { return (const char*)rows->data + i * rows->stride; }

double slope(void) { return tan(20 * acos(-1) / 180); }
