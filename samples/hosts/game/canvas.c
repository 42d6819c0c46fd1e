/* Triangles in an array. Games that already have a renderer need nothing of this file. */
#include "canvas.h"

#include <SDL_opengl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct vertex {
  float x, y;
  color c;
} vertex;

enum { MOST_VERTICES = 300000 };
static vertex vertices[MOST_VERTICES];
static size_t vertex_count;
static const float two_pi = 6.2831853F;

color faded(color c, float part) {
  c.a = (uint8_t)((float)c.a * (part < 0 ? 0 : part > 1 ? 1 : part));
  return c;
}

static uint8_t blend(uint8_t a, uint8_t b, float part) {
  return (uint8_t)((float)a + ((float)b - (float)a) * (part < 0 ? 0 : part > 1 ? 1 : part));
}
color mixed(color a, color b, float part) {
  const color c = {blend(a.r, b.r, part), blend(a.g, b.g, part), blend(a.b, b.b, part), blend(a.a, b.a, part)};
  return c;
}

void canvas_begin(int window_width, int window_height, float width, float height) {
  /* The largest view of the same shape that fits into the window. */
  const float pixels = fminf((float)window_width / width, (float)window_height / height);
  const int w = (int)(pixels * width), h = (int)(pixels * height);
  vertex_count = 0;
  glViewport(0, 0, window_width, window_height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glViewport((window_width - w) / 2, (window_height - h) / 2, w, h);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glOrtho((double)(-width / 2), (double)(width / 2), (double)(-height / 2), (double)(height / 2), -1, 1);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void canvas_end(void) {
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_COLOR_ARRAY);
  glVertexPointer(2, GL_FLOAT, sizeof(vertex), &vertices[0].x);
  glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(vertex), &vertices[0].c);
  glDrawArrays(GL_TRIANGLES, 0, (GLsizei)vertex_count);
}

void canvas_triangle(const float a[2], const float b[2], const float c[2], color of_a, color of_b, color of_c) {
  if (vertex_count + 3 > MOST_VERTICES) return;
  vertices[vertex_count++] = (vertex){a[0], a[1], of_a};
  vertices[vertex_count++] = (vertex){b[0], b[1], of_b};
  vertices[vertex_count++] = (vertex){c[0], c[1], of_c};
}

static void quad(const float corners[4][2], color first, color second, color third, color fourth) {
  canvas_triangle(corners[0], corners[1], corners[2], first, second, third);
  canvas_triangle(corners[0], corners[2], corners[3], first, third, fourth);
}

void canvas_rectangle(float left, float bottom, float right, float top, color below, color above) {
  const float corners[4][2] = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
  quad(corners, below, below, above, above);
}

void canvas_ellipse(float x, float y, float along, float across, float angle, color middle, color rim) {
  const int segments = along > 2 ? 64 : 24;
  const float c = cosf(angle), s = sinf(angle), center[2] = {x, y};
  float last[2] = {x + along * c, y + along * s};
  for (int i = 1; i <= segments; ++i) {
    const float t = two_pi * (float)i / (float)segments, u = along * cosf(t), v = across * sinf(t);
    const float next[2] = {x + u * c - v * s, y + u * s + v * c};
    canvas_triangle(center, last, next, middle, rim, rim);
    memcpy(last, next, sizeof last);
  }
}

void canvas_disc(float x, float y, float radius, color middle, color rim) {
  canvas_ellipse(x, y, radius, radius, 0, middle, rim);
}

void canvas_ring(float x, float y, float radius, float thickness, color c) {
  const int segments = radius > 2 ? 64 : 24;
  for (int i = 0; i < segments; ++i) {
    const float s = two_pi * (float)i / (float)segments, t = two_pi * (float)(i + 1) / (float)segments;
    const float in = radius - thickness / 2, out = radius + thickness / 2;
    const float corners[4][2] = {{x + in * cosf(s), y + in * sinf(s)},
                                 {x + out * cosf(s), y + out * sinf(s)},
                                 {x + out * cosf(t), y + out * sinf(t)},
                                 {x + in * cosf(t), y + in * sinf(t)}};
    quad(corners, c, c, c, c);
  }
}

void canvas_line(float x0, float y0, float x1, float y1, float thickness, color c) {
  const float dx = x1 - x0, dy = y1 - y0, length = hypotf(dx, dy);
  if (!(length > 0)) return;
  const float nx = -dy / length * thickness / 2, ny = dx / length * thickness / 2;
  const float corners[4][2] = {{x0 - nx, y0 - ny}, {x1 - nx, y1 - ny}, {x1 + nx, y1 + ny}, {x0 + nx, y0 + ny}};
  quad(corners, c, c, c, c);
}

/* ---- letters ----------------------------------------------------------------------------------------------------- */

/* Strokes on a grid of 5 by 7 points: pairs of a column, 0 to 4, and a row from below, 0 to 6. A space lifts the pen.
 */
static const struct {
  char letter;
  const char* strokes;
} letters[] = {
    {'A', "0004264440 0242"},
    {'B', "00063645443303 3342413000"},
    {'C', "4536160501103041"},
    {'D', "00062644422000"},
    {'E', "46060040 0333"},
    {'F', "460600 0333"},
    {'G', "45361605011030414323"},
    {'H', "0006 4046 0343"},
    {'I', "1636 2620 1030"},
    {'J', "4641301001"},
    {'K', "0006 460340"},
    {'L', "060040"},
    {'M', "0006234640"},
    {'N', "00064046"},
    {'O', "051636454130100105"},
    {'P', "00063645443303"},
    {'Q', "051636454130100105 2240"},
    {'R', "00063645443303 2340"},
    {'S', "453616050413334241301001"},
    {'T', "0646 2620"},
    {'U', "060110304146"},
    {'V', "062046"},
    {'W', "0610243046"},
    {'X', "0046 0640"},
    {'Y', "062346 2320"},
    {'Z', "06460040"},
    {'0', "051636454130100105"},
    {'1', "152620 1030"},
    {'2', "05163645440040"},
    {'3', "05163645443313 334241301001"},
    {'4', "30360242"},
    {'5', "460604344341301001"},
    {'6', "4536160501103041423303"},
    {'7', "064620"},
    {'8', "13040516364544331302011030414233"},
    {'9', "0110304145361605041343"},
    {':', "2122 2425"},
    {'.', "2021"},
    {',', "2110"},
    {'+', "2125 0343"},
    {'-', "1333"},
    {'!', "2622 2021"},
};
static const float advance_of_letter = 6;

float canvas_text_width(float height, const char* text) { return (float)strlen(text) * advance_of_letter * height / 6; }

float canvas_text(float x, float y, float height, color c, const char* text) {
  const float unit = height / 6, thickness = 0.16F * height;
  for (; *text; ++text, x += advance_of_letter * unit) {
    const char* s = "";
    for (size_t i = 0; i < sizeof letters / sizeof *letters; ++i)
      if (letters[i].letter == *text) s = letters[i].strokes;
    for (; s[0] && s[1]; s += 2) {
      if (s[0] == ' ') ++s;
      const float px = x + unit * (float)(s[0] - '0'), py = y + unit * (float)(s[1] - '0');
      canvas_disc(px, py, thickness / 2, c, c); /* round ends */
      if (s[2] && s[2] != ' ')
        canvas_line(px, py, x + unit * (float)(s[2] - '0'), y + unit * (float)(s[3] - '0'), thickness, c);
    }
  }
  return x;
}

uint8_t* canvas_pixels(int window_width, int window_height) {
  const size_t row = (size_t)window_width * 4, height = (size_t)window_height;
  uint8_t *below = malloc(row * height), *pixels = malloc(row * height);
  if (below && pixels) {
    glReadPixels(0, 0, window_width, window_height, GL_RGBA, GL_UNSIGNED_BYTE, below);
    for (size_t y = 0; y < height; ++y) memcpy(pixels + y * row, below + (height - 1 - y) * row, row);
    for (size_t i = 3; i < row * height; i += 4) pixels[i] = 255;
  } else {
    free(pixels);
    pixels = NULL;
  }
  free(below);
  return pixels;
}
