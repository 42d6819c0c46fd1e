/* Fifteen seconds of play: a walk, a flower, a wasp, debug draw, save, a while later load, and on. */
#include "robot.h"

#include <SDL.h>
#include <stdio.h>

enum { SAVED = 420, LOADED = 600, ENDED = 900 };

static void press(SDL_Keycode key, bool down) {
  SDL_Event event;
  SDL_zero(event);
  event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
  event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.key.keysym.sym = key;
  SDL_PushEvent(&event);
}

static void click(int x, int y) {
  SDL_Event event;
  SDL_zero(event);
  event.type = SDL_MOUSEBUTTONDOWN;
  event.button.button = SDL_BUTTON_LEFT;
  event.button.x = x;
  event.button.y = y;
  SDL_PushEvent(&event);
}

void robot_play(int frame, int window_width, int window_height) {
  static const struct {
    int frame;
    SDL_Keycode key;
    bool down;
  } keys[] = {
      {5, SDLK_RIGHT, true},   {70, SDLK_RIGHT, false}, {70, SDLK_UP, true},      {130, SDLK_UP, false},
      {200, SDLK_w, true},     {200, SDLK_a, true},     {260, SDLK_w, false},     {260, SDLK_a, false},
      {300, SDLK_F1, true},    {330, SDLK_F1, true},    {340, SDLK_LSHIFT, true}, {370, SDLK_LSHIFT, false},
      {SAVED, SDLK_F5, true},  {430, SDLK_SPACE, true}, {440, SDLK_SPACE, true},  {500, SDLK_F6, true},
      {LOADED, SDLK_F9, true}, {700, SDLK_DOWN, true},  {760, SDLK_DOWN, false},
  };
  for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
    if (keys[i].frame == frame) press(keys[i].key, keys[i].down);
  if (frame == 90) click(window_width / 4, window_height / 3);
  if (frame == 150) click(window_width * 3 / 4, window_height * 3 / 4);
  if (frame == 880) click(window_width * 3 / 5, window_height / 4);
}

bool robot_watch(meadow* m, int frame) {
  static const int told[] = {SAVED - 1, SAVED, LOADED - 1, LOADED, ENDED};
  for (size_t i = 0; i < sizeof told / sizeof *told; ++i)
    if (told[i] == frame)
      printf("frame %d: time %.2f honey %d bees %zu wasps %zu flowers %zu seeds %d keeper %.2f %.2f\n", frame,
             breve_world_time(m->world), m->honey, m->bees.count, m->wasps.count, m->flowers.count, m->seeds,
             (double)m->keepers.places[0][0], (double)m->keepers.places[0][1]);
  return frame < ENDED;
}

const char* robot_picture(int frame) { return frame == 310 ? "debug.png" : frame == ENDED - 5 ? "meadow.png" : NULL; }
