/* What a world plays, by closed forms: tones are sines, sounds their samples, nobody pays who does not listen. */
#include "breve/sound.h"

#include <math.h>

#include "scene.h"

static const double kTurn = 6.283185307179586, kRate = 8000;
static const double kClose = 1e-5; /* floats, and a phase that is reduced */

static const char* const program =
    "@use Control.\n@use Sound.\n"
    "Controller Band.\n"
    "Control : Band {\n"
    "  + variables: tone, beep (object).\n"
    "  + to init:\n"
    "    self set-integration-step to 0.05.\n"
    "    self set-iteration-step to 0.05.\n"
    "  + to make-tone:\n"
    "    tone = new Tone.\n"
    "  + to tune to hertz (double) at volume (double) on balance (double):\n"
    "    tone set-frequency to hertz.\n"
    "    tone set-volume to volume.\n"
    "    tone set-balance to balance.\n"
    "  + to silence:\n"
    "    free tone.\n"
    "}\n";

static void hear(scene* s, double time, float* samples, size_t count) {
  for (size_t i = 0; i < 2 * count; ++i) samples[i] = 7;
  CHECK_STATUS(BREVE_OK, breve_world_sound(s->world, time, kRate, samples, count));
}

static void call(scene* s, const char* method) {
  CHECK_STATUS(BREVE_OK, breve_object_call(s->world, breve_world_controller(s->world), method, NULL, 0, NULL));
}

static void tune(scene* s, double hertz, double volume, double balance) {
  const breve_keyword keywords[] = {
      {"to", breve_value_double(hertz)}, {"at", breve_value_double(volume)}, {"on", breve_value_double(balance)}};
  CHECK_STATUS(BREVE_OK, breve_object_call(s->world, breve_world_controller(s->world), "tune", keywords, 3, NULL));
}

static void a_tone_is_a_sine(void) {
  enum { kCount = 100 };
  float heard[2 * kCount];
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  hear(&s, 0, heard, kCount);
  for (int i = 0; i < 2 * kCount; ++i) CHECK(heard[i] == 0);
  call(&s, "make-tone");
  tune(&s, 440, 0.5, 0.25);
  hear(&s, 0, heard, kCount);
  for (int i = 0; i < kCount; ++i) {
    const double wave = sin(kTurn * 440 * i / kRate);
    CHECK(fabs(heard[2 * i] - 0.5 * wave) < kClose);
    CHECK(fabs(heard[2 * i + 1] - 0.25 * wave) < kClose); /* a quarter to the left: half as loud on the right */
  }
  scene_close(&s);
}

/* The frequency changes at 0.05 s; the wave has the phase there that it had come to. */
static void a_wave_goes_on_without_a_jump(void) {
  enum { kCount = 50 };
  float heard[2 * kCount];
  uint64_t before = 0, after = 1;
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  call(&s, "make-tone");
  tune(&s, 431, 1, 0.5);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  tune(&s, 97, 1, 0.5);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  hear(&s, 0.05, heard, kCount);
  for (int i = 0; i < kCount; ++i)
    CHECK(fabs(heard[2 * i] - sin(kTurn * 431 * 0.05 + kTurn * 97 * i / kRate)) < kClose);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  call(&s, "silence");
  hear(&s, 0.05, heard, kCount);
  for (int i = 0; i < 2 * kCount; ++i) CHECK(heard[i] == 0);
  scene_close(&s);
}

/* A rate cannot hold tones of half of it or more: they would be heard as others. */
static void what_the_rate_cannot_hold_is_silent(void) {
  float heard[20];
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  call(&s, "make-tone");
  tune(&s, 4000, 1, 0.5);
  hear(&s, 0.1, heard, 10);
  for (int i = 0; i < 20; ++i) CHECK(heard[i] == 0);
  scene_close(&s);
}

static void bad_arguments_are_refused(void) {
  float heard[2] = {7, 7};
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(NULL, 0, kRate, heard, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, 0, kRate, NULL, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, NAN, kRate, heard, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, INFINITY, kRate, heard, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, 0, 999, heard, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, 0, NAN, heard, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_sound(s.world, 0, kRate, heard, SIZE_MAX / 2));
  CHECK(heard[0] == 7 && heard[1] == 7);
  CHECK_STATUS(BREVE_OK, breve_world_sound(s.world, 0, kRate, NULL, 0));
  scene_close(&s);
}

void sound_suite(void) {
  RUN(a_tone_is_a_sine);
  RUN(a_wave_goes_on_without_a_jump);
  RUN(what_the_rate_cannot_hold_is_silent);
  RUN(bad_arguments_are_refused);
}
