/* The picture: painted from the back to the front, of what meadow_advance has read. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "canvas.h"

static const color shade = {10, 24, 12, 110}, clear_shade = {10, 24, 12, 0};
static const color honey_color = {255, 190, 40, 255}, deep_honey = {206, 118, 16, 255};
static const color ink = {38, 26, 14, 255}, paper = {255, 248, 226, 255}, wing = {255, 255, 255, 120};
static const float two_pi = 6.2831853F;

static color solid(int r, int g, int b) {
  const color c = {(uint8_t)r, (uint8_t)g, (uint8_t)b, 255};
  return c;
}
static color clear_of(color c) { return faded(c, 0); }

/* Numbers that look drawn at random and stay the same from frame to frame. */
static float scatter(uint32_t* state) {
  *state = *state * 1664525U + 1013904223U;
  return (float)(*state >> 8U) / 16777216.0F;
}

/* The direction in which a creature looks. */
static float heading_of(const crowd* c, size_t i) { return atan2f(c->velocities[i][1], c->velocities[i][0]); }

static void shadow(float x, float y, float size) {
  canvas_ellipse(x + 0.12F, y - 0.3F, size, 0.6F * size, 0, shade, clear_shade);
}

/* ---- ground ------------------------------------------------------------------------------------------------------ */

static void draw_ground(double seconds) {
  const float w = MEADOW_WIDTH / 2, h = MEADOW_HEIGHT / 2;
  uint32_t dice = 7;
  canvas_rectangle(-w, -h, w, h, solid(74, 132, 66), solid(118, 168, 84));
  for (int i = 0; i < 60; ++i) { /* patches of other grass */
    const float x = (2 * scatter(&dice) - 1) * w, y = (2 * scatter(&dice) - 1) * h, r = 1.5F + 3 * scatter(&dice);
    const color c = scatter(&dice) < 0.5F ? (color){150, 190, 90, 46} : (color){44, 96, 56, 52};
    canvas_ellipse(x, y, r * 1.6F, r, 0.3F, c, clear_of(c));
  }
  for (int i = 0; i < 900; ++i) { /* blades, which the wind bends */
    const float x = (2 * scatter(&dice) - 1) * w, y = (2 * scatter(&dice) - 1) * h,
                tall = 0.25F + 0.3F * scatter(&dice);
    const float bend = 0.12F * sinf((float)seconds * 1.7F + 0.5F * x + 0.3F * y);
    const color c = scatter(&dice) < 0.4F ? (color){176, 206, 104, 120} : (color){46, 104, 54, 130};
    const float a[2] = {x - 0.05F, y}, b[2] = {x + 0.05F, y}, tip[2] = {x + bend, y + tall};
    canvas_triangle(a, b, tip, c, c, c);
  }
}

/* ---- what stands on it ------------------------------------------------------------------------------------------- */

/* Six petals whose colour the flower was born with; they open as the nectar rises. */
static void draw_flower(float x, float y, float nectar, float hue, double seconds) {
  static const uint8_t hues[4][3] = {{244, 114, 150}, {196, 120, 236}, {252, 246, 250}, {112, 160, 250}};
  const uint8_t* h = hues[(int)(hue * 3.999F)];
  const color petal = {h[0], h[1], h[2], 255}, rim = mixed(petal, solid(90, 40, 110), 0.35F);
  const float size = 0.17F + 0.13F * nectar, sway = 0.05F * sinf((float)seconds * 1.7F + x);
  shadow(x, y, 0.75F);
  canvas_line(x, y - 0.55F, x + sway, y, 0.09F, solid(40, 98, 44));
  canvas_ellipse(x + 0.16F, y - 0.4F, 0.18F, 0.08F, 0.6F, solid(88, 150, 66), solid(48, 108, 48));
  for (int i = 0; i < 6; ++i) {
    const float t = two_pi * (float)i / 6 + hue * 6;
    canvas_ellipse(x + sway + 1.25F * size * cosf(t), y + 1.25F * size * sinf(t), size, 0.72F * size, t, petal, rim);
  }
  canvas_disc(x + sway, y, size * 0.85F, honey_color, deep_honey);
  if (nectar >= 0.99F) {
    const color glow = {255, 240, 150, 90};
    canvas_disc(x + sway, y, 0.9F, glow, clear_of(glow));
  }
}

static void hexagon(float x, float y, float r, color middle, color rim) {
  for (int i = 0; i < 6; ++i) {
    const float s = two_pi * ((float)i + 0.5F) / 6, t = s + two_pi / 6, center[2] = {x, y};
    const float a[2] = {x + r * cosf(s), y + r * sinf(s)}, b[2] = {x + r * cosf(t), y + r * sinf(t)};
    canvas_triangle(center, a, b, middle, rim, rim);
  }
}

/* Nineteen cells of a comb; the honey fills one after the other, and then begins anew. */
static void draw_hive(int honey, double seconds) {
  const color wax = solid(236, 196, 110), rim = solid(150, 98, 36), glow = {255, 214, 110, 90};
  const int filled = honey == 0 ? 0 : 1 + (honey - 1) % 19;
  int cell = 0;
  canvas_disc(0, 0, 3.6F + 0.15F * sinf((float)seconds * 2), glow, clear_of(glow));
  canvas_ellipse(0.2F, -0.6F, 2.3F, 1.8F, 0, shade, clear_shade);
  hexagon(0, 0, 2.05F, solid(122, 78, 30), solid(88, 52, 20));
  for (int q = -2; q <= 2; ++q)
    for (int r = -2; r <= 2; ++r) {
      if (q + r < -2 || q + r > 2) continue;
      const float x = 0.69F * ((float)q + 0.5F * (float)r), y = 0.6F * (float)r;
      const bool full = cell++ < filled;
      hexagon(x, y, 0.385F, full ? honey_color : wax, full ? deep_honey : rim);
      if (full) canvas_ellipse(x - 0.1F, y + 0.12F, 0.1F, 0.06F, 0.6F, paper, clear_of(paper));
    }
}

/* ---- who flies over it ------------------------------------------------------------------------------------------- */

static void draw_wings(float x, float y, float size, float angle, float beat) {
  for (int side = -1; side <= 1; side += 2) {
    const float lift = angle + (float)side * (1.15F + 0.35F * beat);
    canvas_ellipse(x + 0.75F * size * cosf(lift), y + 0.75F * size * sinf(lift), 0.75F * size, 0.38F * size, lift, wing,
                   faded(wing, 0.5F));
  }
}

/* A body with three stripes across; y is drawn higher, since it flies. */
static void draw_insect(float x, float y, float size, float angle, color body, color belly, float beat) {
  const float c = cosf(angle), s = sinf(angle);
  canvas_ellipse(x, y, size, 0.62F * size, angle, body, belly);
  for (int i = -1; i <= 1; ++i) {
    const float at = (0.42F * (float)i - 0.18F) * size, half = size * (i == 0 ? 0.56F : 0.46F);
    canvas_line(x + at * c + half * s, y + at * s - half * c, x + at * c - half * s, y + at * s + half * c, 0.2F * size,
                ink);
  }
  canvas_disc(x + 0.85F * size * c, y + 0.85F * size * s, 0.4F * size, solid(70, 48, 26), ink);
  for (int side = -1; side <= 1; side += 2) { /* feelers */
    const float t = angle + 0.45F * (float)side;
    canvas_line(x + 1.1F * size * c, y + 1.1F * size * s, x + 1.65F * size * cosf(t), y + 1.65F * size * sinf(t),
                0.08F * size, ink);
  }
  draw_wings(x, y, size, angle + two_pi / 2, beat);
}

static void draw_bees(const meadow* m, double seconds) {
  for (size_t i = 0; i < m->bees.count; ++i) {
    const float x = m->bees.places[i][0], y = m->bees.places[i][1], angle = heading_of(&m->bees, i);
    shadow(x, y - 0.15F, 0.4F);
    draw_insect(x, y, 0.34F, angle, solid(255, 214, 70), solid(226, 150, 26), sinf((float)seconds * 60 + (float)i));
    if (m->bees.numbers[i] > 0)
      canvas_disc(x - 0.3F * cosf(angle), y - 0.3F * sinf(angle), 0.16F, solid(255, 246, 160), solid(255, 196, 60));
  }
}

static void draw_wasps(const meadow* m, double seconds) {
  const color rage = {255, 60, 20, 60}, fear = {150, 190, 255, 70};
  for (size_t i = 0; i < m->wasps.count; ++i) {
    const float x = m->wasps.places[i][0], y = m->wasps.places[i][1];
    const bool flees = m->wasps.numbers[i] > 0;
    shadow(x, y - 0.25F, 0.7F);
    canvas_disc(x, y, 1.5F, flees ? fear : rage, clear_of(flees ? fear : rage));
    draw_insect(x, y, 0.56F, heading_of(&m->wasps, i), flees ? solid(232, 214, 170) : solid(246, 96, 30),
                flees ? solid(178, 160, 120) : solid(190, 40, 20), sinf((float)seconds * 48 + (float)i));
  }
}

/* From above: a straw hat, two hands; and how far wasps mind it. */
static void draw_keeper(const meadow* m, double seconds) {
  const color straw = solid(244, 216, 140), edge = solid(196, 150, 70), reach = {255, 255, 255, 56};
  for (size_t i = 0; i < m->keepers.count; ++i) {
    const float x = m->keepers.places[i][0], y = m->keepers.places[i][1], angle = heading_of(&m->keepers, i);
    const float speed = hypotf(m->keepers.velocities[i][0], m->keepers.velocities[i][1]);
    const float step = 0.2F * sinf((float)seconds * 10) * (speed > 0.5F ? 1 : 0);
    for (int k = 0; k < 36; k += 2) {
      const float s = two_pi * (float)k / 36 + 0.15F * (float)seconds, t = s + two_pi / 50;
      canvas_line(x + 5 * cosf(s), y + 5 * sinf(s), x + 5 * cosf(t), y + 5 * sinf(t), 0.1F, reach);
    }
    shadow(x, y - 0.2F, 1.2F);
    for (int side = -1; side <= 1; side += 2) {
      const float t = angle + (float)side * 0.9F, far = 0.85F + (float)side * step;
      canvas_disc(x + far * cosf(t), y + far * sinf(t), 0.2F, solid(250, 214, 180), solid(206, 150, 110));
    }
    canvas_disc(x, y, 0.85F, straw, edge);
    canvas_ring(x, y, 0.5F, 0.13F, solid(190, 60, 50));
    canvas_disc(x - 0.08F, y + 0.1F, 0.43F, solid(255, 236, 178), straw);
  }
}

static void draw_sparks(const meadow* m) {
  static const char* const words[] = {"+1", "", "SEEDED"};
  static const color colors[] = {{255, 206, 70, 255}, {255, 70, 40, 255}, {170, 255, 140, 255}};
  for (size_t i = 0; i < m->spark_count; ++i) {
    const spark* s = &m->sparks[i];
    const color c = faded(colors[s->kind], 1 - s->age);
    canvas_ring(s->x, s->y, 0.6F + 2.6F * s->age, 0.16F, c);
    canvas_text(s->x - canvas_text_width(0.5F, words[s->kind]) / 2, s->y + 1.2F + 1.8F * s->age, 0.5F, c,
                words[s->kind]);
  }
}

/* ---- what breve shows of itself ---------------------------------------------------------------------------------- */

static color color_of(const double rgba[4]) {
  const color c = {(uint8_t)(255 * rgba[0]), (uint8_t)(255 * rgba[1]), (uint8_t)(255 * rgba[2]), 150};
  return c;
}
static void debug_line(void* user, const double from[3], const double to[3], const double rgba[4]) {
  (void)user;
  canvas_line((float)from[0], (float)from[1], (float)to[0], (float)to[1], 0.05F, color_of(rgba));
}
static void debug_text(void* user, const double at[3], const char* text, const double rgba[4]) {
  char capitals[32] = "";
  (void)user, (void)rgba;
  for (size_t i = 0; text[i] && i + 1 < sizeof capitals; ++i)
    capitals[i] = (char)(text[i] >= 'a' && text[i] <= 'z' ? text[i] - 'a' + 'A' : text[i]);
  canvas_text((float)at[0] + 0.3F, (float)at[1] + 0.5F, 0.28F, paper, capitals);
}
static void draw_debug(const meadow* m) {
  breve_debug_draw draw = breve_debug_draw_default();
  draw.parts = BREVE_DEBUG_SHAPES | BREVE_DEBUG_VELOCITIES | BREVE_DEBUG_NEIGHBORHOODS | BREVE_DEBUG_NAMES;
  draw.line = debug_line;
  draw.text = debug_text;
  breve_world_debug_draw(m->world, &draw);
}

/* ---- words ------------------------------------------------------------------------------------------------------- */

static void draw_words(const meadow* m, const char* notice) {
  const float w = MEADOW_WIDTH / 2, h = MEADOW_HEIGHT / 2;
  const color veil = {20, 34, 18, 190}, none = {20, 34, 18, 0}, quiet = {255, 248, 226, 190};
  char text[64];
  canvas_rectangle(-w, h - 3.2F, w, h, none, veil);
  canvas_rectangle(-w, -h, w, -h + 2, veil, none);
  float x = -w + 1;
  snprintf(text, sizeof text, "HONEY %d", m->honey);
  x = canvas_text(x, h - 1.6F, 0.9F, honey_color, text) + 1;
  snprintf(text, sizeof text, "BEES %zu", m->bees.count);
  x = canvas_text(x, h - 1.6F, 0.9F, paper, text) + 1;
  snprintf(text, sizeof text, "SEEDS %d", m->seeds);
  canvas_text(x, h - 1.6F, 0.9F, solid(190, 240, 160), text);
  snprintf(text, sizeof text, "LOST %d", m->lost);
  canvas_text(w - 1 - canvas_text_width(0.9F, text), h - 1.6F, 0.9F, solid(255, 150, 120), text);
  canvas_text(
      -w + 1, -h + 0.6F, 0.36F, quiet,
      "ARROWS: WALK   CLICK: PLANT, OR SHOO A WASP   SHIFT: SLOW   SPACE: PAUSE   F1: DEBUG   F5: SAVE   F9: LOAD");
  if (m->over) notice = "THE HIVE IS SILENT";
  canvas_text(-canvas_text_width(1.1F, notice) / 2, 4.2F, 1.1F, paper, notice);
}

/* Darker toward the corners, so that the eye stays in the middle. */
static void draw_vignette(void) {
  const color none = {8, 20, 10, 0}, dark = {8, 20, 10, 150};
  for (int i = 0; i < 64; ++i) {
    const float s = two_pi * (float)i / 64, t = two_pi * (float)(i + 1) / 64;
    const float in[2] = {17 * cosf(s), 11 * sinf(s)}, in2[2] = {17 * cosf(t), 11 * sinf(t)};
    const float out[2] = {30 * cosf(s), 20 * sinf(s)}, out2[2] = {30 * cosf(t), 20 * sinf(t)};
    canvas_triangle(in, out, out2, none, dark, dark);
    canvas_triangle(in, out2, in2, none, dark, none);
  }
}

void scene_draw(meadow* m, double seconds, bool debug, const char* notice) {
  draw_ground(seconds);
  for (size_t i = 0; i < m->flowers.count; ++i)
    draw_flower(m->flowers.places[i][0], m->flowers.places[i][1], m->flowers.numbers[i], m->hues[i], seconds);
  draw_hive(m->honey, seconds);
  draw_keeper(m, seconds);
  draw_bees(m, seconds);
  draw_wasps(m, seconds);
  draw_sparks(m);
  draw_vignette();
  if (debug) draw_debug(m);
  draw_words(m, notice);
}
