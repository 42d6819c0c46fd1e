/* A little renderer: coloured triangles, gathered in an array and drawn by one call of OpenGL 1.1. */
#ifndef CANVAS_H
#define CANVAS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct color {
  uint8_t r, g, b, a;
} color;

/* Begins a picture of the rectangle around 0, 0 in a window of so many pixels; what is beside it is black. */
void canvas_begin(int window_width, int window_height, float width, float height);
void canvas_end(void); /* draws everything */

void canvas_triangle(const float a[2], const float b[2], const float c[2], color of_a, color of_b, color of_c);
void canvas_rectangle(float left, float bottom, float right, float top, color below, color above);
/* @param angle  rad, of its long axis. The colour runs from the middle to the rim */
void canvas_ellipse(float x, float y, float along, float across, float angle, color middle, color rim);
void canvas_disc(float x, float y, float radius, color middle, color rim);
void canvas_ring(float x, float y, float radius, float thickness, color c);
void canvas_line(float x0, float y0, float x1, float y1, float thickness, color c);
/* Capital letters, digits and a few signs, made of strokes. Returns where the next letter would be. */
float canvas_text(float x, float y, float height, color c, const char* text);
float canvas_text_width(float height, const char* text);

/* The pixels of the picture, rows from the top, RGBA; to be freed. NULL if there is no memory. */
uint8_t* canvas_pixels(int window_width, int window_height);

color faded(color c, float part); /* the same with less alpha; part from 0 to 1 */
color mixed(color a, color b, float part);

#endif
