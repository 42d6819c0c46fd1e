/* Worlds that are drawn, and the rows of their scenes. */
#ifndef BREVE_TESTS_CAPI_SHOW_H
#define BREVE_TESTS_CAPI_SHOW_H

#include "breve/view.h"
#include "scene.h"

enum { kWidth = 640, kHeight = 480, kPixels = kWidth * kHeight };
#define PERCENT 0.01

/* A world whose controller does `body` at the end of its init. */
bool open_show(scene* s, const char* body);
breve_rows rows_of(breve_scene* scene, uint32_t kind);
const void* row(const breve_rows* rows, size_t i);
double slope(void); /* of the edge of what a camera sees, of its height */

#endif
