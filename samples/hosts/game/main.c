/* Meadow: a small game. Bees gather honey, wasps hunt them; you chase the wasps away and plant flowers.
 *
 *     game [--seed N]            play
 *     game --robot DIRECTORY     play by itself for 15 seconds, as fast as it goes, and leave pictures there
 *
 * The loop is the usual one: input, time, picture. Simulated time passes in iterations of 1/30 s; pictures come as
 * often as the screen shows them, with everybody drawn between the last two iterations.
 */
#include <SDL.h>
#include <breve/view.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "canvas.h"
#include "meadow.h"
#include "robot.h"
#include "scene.h"

#ifndef GAME_DIRECTORY
#define GAME_DIRECTORY "."
#endif

typedef struct game {
  SDL_Window* window;
  SDL_GLContext context;
  meadow meadow;
  double seconds; /* since it began; for what moves by itself in the picture */
  char notice[48];
  double notice_until;
  char save_path[1024];
  const char* robot; /* where its pictures go; NULL: a person plays */
  bool debug, quit;
} game;

static void show_notice(game* g, const char* text) {
  snprintf(g->notice, sizeof g->notice, "%s", text);
  g->notice_until = g->seconds + 1.5;
}

/* ---- input ------------------------------------------------------------------------------------------------------- */

static const char* name_of_key(SDL_Keycode key) {
  switch (key) {
    case SDLK_UP:
    case SDLK_w: return "up";
    case SDLK_DOWN:
    case SDLK_s: return "down";
    case SDLK_LEFT:
    case SDLK_a: return "left";
    case SDLK_RIGHT:
    case SDLK_d: return "right";
    default: return NULL;
  }
}

static void on_function_key(game* g, SDL_Keycode key) {
  switch (key) {
    case SDLK_ESCAPE: g->quit = true; break;
    case SDLK_SPACE: meadow_toggle_pause(&g->meadow); break;
    case SDLK_F1: g->debug = !g->debug; break;
    case SDLK_F5: show_notice(g, meadow_save(&g->meadow, g->save_path) ? "SAVED" : "NOT SAVED"); break;
    case SDLK_F6: show_notice(g, meadow_reload(&g->meadow) ? "NEW PROGRAM" : "AN ERROR IN MEADOW.TZ"); break;
    case SDLK_F9: show_notice(g, meadow_load(&g->meadow, g->save_path) ? "LOADED" : "NOT LOADED"); break;
    default: break;
  }
}

static void on_key(game* g, const SDL_KeyboardEvent* event) {
  const bool down = event->state == SDL_PRESSED;
  const SDL_Keycode key = event->keysym.sym;
  const char* name = name_of_key(key);
  if (event->repeat) return;
  if (name)
    meadow_key(&g->meadow, name, down);
  else if (key == SDLK_LSHIFT || key == SDLK_RSHIFT)
    meadow_set_slow(&g->meadow, down);
  else if (down)
    on_function_key(g, key);
}

/* From pixels to the meadow: the inverse of what canvas_begin sets up. */
static void on_click(game* g, int x, int y) {
  int w = 1, h = 1;
  SDL_GetWindowSize(g->window, &w, &h);
  const float pixels = fminf((float)w / MEADOW_WIDTH, (float)h / MEADOW_HEIGHT);
  meadow_click(&g->meadow, ((float)x - (float)w / 2) / pixels, ((float)h / 2 - (float)y) / pixels);
}

static void take_input(game* g) {
  SDL_Event event;
  while (SDL_PollEvent(&event)) switch (event.type) {
      case SDL_QUIT: g->quit = true; break;
      case SDL_KEYDOWN:
      case SDL_KEYUP: on_key(g, &event.key); break;
      case SDL_MOUSEBUTTONDOWN: on_click(g, event.button.x, event.button.y); break;
      default: break;
    }
}

/* ---- picture ----------------------------------------------------------------------------------------------------- */

/* breve encodes a PNG file for anybody who has pixels. */
static bool write_picture(const char* path, const uint8_t* pixels, int w, int h) {
  uint8_t* png = NULL;
  size_t size = 0;
  FILE* file = NULL;
  if (breve_png((uint32_t)w, (uint32_t)h, pixels, 0, NULL, 0, &size) == BREVE_OK) png = malloc(size);
  bool written = png && breve_png((uint32_t)w, (uint32_t)h, pixels, 0, png, size, &size) == BREVE_OK;
  if (written) file = fopen(path, "wb");
  written = file && fwrite(png, 1, size, file) == size;
  if (file && fclose(file) != 0) written = false;
  free(png);
  return written;
}

/* How many different colours the picture has: a black window has one. */
static size_t colors_in(const uint8_t* pixels, int w, int h) {
  static uint8_t seen[1U << 15U];
  size_t count = 0;
  memset(seen, 0, sizeof seen);
  for (size_t i = 0; i < (size_t)w * (size_t)h * 4; i += 4) {
    const size_t c = (size_t)(pixels[i] >> 3U) << 10U | (size_t)(pixels[i + 1] >> 3U) << 5U | pixels[i + 2] >> 3U;
    if (!seen[c]) ++count;
    seen[c] = 1;
  }
  return count;
}

static void draw(game* g, const char* picture) {
  char path[1200];
  int w = 1, h = 1;
  SDL_GL_GetDrawableSize(g->window, &w, &h);
  canvas_begin(w, h, MEADOW_WIDTH, MEADOW_HEIGHT);
  scene_draw(&g->meadow, g->seconds, g->debug, g->seconds < g->notice_until ? g->notice : "");
  canvas_end();
  if (picture) {
    snprintf(path, sizeof path, "%s/%s", g->robot, picture);
    uint8_t* pixels = canvas_pixels(w, h);
    const bool written = pixels && write_picture(path, pixels, w, h);
    printf("%s: %s, %d x %d, %zu colours\n", picture, written ? "written" : "not written", w, h,
           pixels ? colors_in(pixels, w, h) : 0);
    free(pixels);
  }
  SDL_GL_SwapWindow(g->window);
}

/* ---- start and end ----------------------------------------------------------------------------------------------- */

static bool open_window(game* g) {
  if (SDL_Init(SDL_INIT_VIDEO) != 0) return false;
  SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
  SDL_GL_SetAttribute(SDL_GL_MULTISAMPLEBUFFERS, 1);
  SDL_GL_SetAttribute(SDL_GL_MULTISAMPLESAMPLES, 4);
  const Uint32 flags = SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
  for (int smooth = 1; smooth >= 0 && !g->context; --smooth) { /* some machines have no multisampling */
    SDL_GL_SetAttribute(SDL_GL_MULTISAMPLEBUFFERS, smooth);
    SDL_GL_SetAttribute(SDL_GL_MULTISAMPLESAMPLES, 4 * smooth);
    if (g->window) SDL_DestroyWindow(g->window);
    g->window = SDL_CreateWindow("Meadow", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, 1200, 720, flags);
    if (g->window) g->context = SDL_GL_CreateContext(g->window);
  }
  if (g->context) SDL_GL_SetSwapInterval(g->robot ? 0 : 1);
  return g->context != NULL;
}

static void close_window(game* g) {
  if (g->context) SDL_GL_DeleteContext(g->context);
  if (g->window) SDL_DestroyWindow(g->window);
  SDL_Quit();
}

static void find_save_path(game* g) {
  char* folder = g->robot ? NULL : SDL_GetPrefPath("breve", "meadow");
  snprintf(g->save_path, sizeof g->save_path, "%s/meadow.save", g->robot ? g->robot : folder ? folder : ".");
  SDL_free(folder);
}

static void play(game* g) {
  Uint64 before = SDL_GetPerformanceCounter();
  while (!g->quit) {
    take_input(g);
    const Uint64 now = SDL_GetPerformanceCounter();
    const double passed = (double)(now - before) / (double)SDL_GetPerformanceFrequency();
    before = now;
    g->seconds += passed;
    meadow_advance(&g->meadow, passed);
    draw(g, NULL);
  }
}

/* The same without a clock: every frame is a sixtieth of a second, so that each run is the same. */
static void play_robot(game* g) {
  for (int frame = 1; !g->quit; ++frame) {
    int w = 1, h = 1;
    SDL_GetWindowSize(g->window, &w, &h);
    robot_play(frame, w, h);
    take_input(g);
    g->seconds += 1.0 / 60;
    meadow_advance(&g->meadow, 1.0 / 60);
    const char* picture = robot_picture(frame);
    if (picture) draw(g, picture);
    if (!robot_watch(&g->meadow, frame)) g->quit = true;
  }
}

int main(int argc, char** argv) {
  static game g;
  uint64_t seed = (uint64_t)SDL_GetPerformanceCounter();
  for (int i = 1; i + 1 < argc; i += 2) {
    if (strcmp(argv[i], "--seed") == 0) seed = strtoull(argv[i + 1], NULL, 10);
    if (strcmp(argv[i], "--robot") == 0) g.robot = argv[i + 1], seed = 1;
  }
  const bool opened = open_window(&g);
  if (!opened) fprintf(stderr, "no window with OpenGL: %s\n", SDL_GetError());
  const bool ready = opened && meadow_open(&g.meadow, GAME_DIRECTORY, seed);
  if (ready) {
    find_save_path(&g);
    if (g.robot)
      play_robot(&g);
    else
      play(&g);
  }
  meadow_close(&g.meadow);
  close_window(&g);
  return ready ? 0 : 1;
}
