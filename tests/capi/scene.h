/* One small program that shows every side of the interface, and a runtime that remembers what was said. */
#ifndef BREVE_TESTS_CAPI_SCENE_H
#define BREVE_TESTS_CAPI_SCENE_H

#include "check.h"

/* What the callbacks of a scene saw. */
typedef struct transcript {
  char print[8192], warning[8192], error[8192];
  int prints, warnings, errors;
  void (*on_print)(breve_world* world, void* context);   /* called for each print, if set */
  void (*on_warning)(breve_world* world, void* context); /* for each warning */
  void* context;
} transcript;

typedef struct scene {
  transcript said;
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} scene;

extern const char* const scene_text;

void remember(void* user, breve_world* world, breve_channel channel, const char* text, size_t size);

/* A world of scene_text, or of another program. False, and a failed check, if there is an error. */
bool scene_open(scene* s);
bool scene_open_text(scene* s, const char* text, const breve_world_config* config);
void scene_close(scene* s);

breve_object ball_of(scene* s);             /* the controller's `ball` */
int int_of(scene* s, const char* variable); /* an int variable of the controller */
breve_value value_of(scene* s, const char* variable);

#endif
