/* The scene that the tests share. */
#include "scene.h"

const char* const scene_text =
    "@use Control.\n"
    "@use Mobile.\n"
    "@use Stationary.\n"
    "@use Shape.\n"
    "@use MultiBody.\n"
    "@use Spring.\n"
    "Controller Stage.\n"
    "Control : Stage (aka Stages) {\n"
    "  + variables:\n"
    "    count, pressed, released, clicks, chosen, calls (int).\n"
    "    level (float).\n"
    "    where (vector).\n"
    "    frame (matrix).\n"
    "    name (string).\n"
    "    clicked, item, blank (object).\n"
    "    ball (Ball object).\n"
    "    things, unmade (list).\n"
    "    table (hash).\n"
    "    grid (3 ints).\n"
    "\n"
    "  + to init:\n"
    "    count = 7.\n"
    "    level = 2.5.\n"
    "    where = (1, 2, 3).\n"
    "    frame = [(1, 0, 0), (0, 2, 0), (0, 0, 3)].\n"
    "    name = \"stage\".\n"
    "    things = { 1, 2.5, \"three\", { 4, 5 } }.\n"
    "    table{\"a\"} = 1.\n"
    "    table{\"b\"} = \"two\".\n"
    "    ball = new Ball.\n"
    "    item = (self add-menu named \"Choose Me\" for-method \"choose\").\n"
    "    self add-menu-separator.\n"
    "\n"
    "  + to iterate:\n"
    "    count += 1.\n"
    "    super iterate.\n"
    "\n"
    "  + to catch-key-a-down:\n"
    "    pressed += 1.\n"
    "  + to catch-key-a-up:\n"
    "    released += 1.\n"
    "  + to catch-key-left-down:\n"
    "    pressed += 10.\n"
    "  + to click on what (object):\n"
    "    clicks += 1.\n"
    "    clicked = what.\n"
    "  + to choose:\n"
    "    chosen += 1.\n"
    "\n"
    "  + to add first x (int) second y = 10 (int):\n"
    "    return x + y.\n"
    "  + to subtract this y (float) from x (float):\n"
    "    return x - y.\n"
    "  + to echo value v (list):\n"
    "    return v.\n"
    "  + to echo-hash value v (hash):\n"
    "    return v.\n"
    "  + to echo-object value v (object):\n"
    "    return v.\n"
    "  + to echo-matrix value v (matrix):\n"
    "    return v.\n"
    "  + to echo-string value v (string):\n"
    "    return v.\n"
    "  + to say text t (string):\n"
    "    print t.\n"
    "  + to fail-now:\n"
    "    die \"on purpose\".\n"
    "  + to fail-deep:\n"
    "    self fail-now.\n"
    "  + to recurse:\n"
    "    self recurse.\n"
    "  + to spin:\n"
    "    while 1: calls += 1.\n"
    "  + to stop:\n"
    "    self end-simulation.\n"
    "  + to touch:\n"
    "    calls += 1.\n"
    "}\n"
    "Mobile : Ball (aka Balls) {\n"
    "  + variables:\n"
    "    hits (int).\n"
    "  + to init:\n"
    "    self set-velocity to (1, 0, 0).\n"
    "  + to touch:\n"
    "    hits += 1.\n"
    "  + to destroy:\n"
    "    print \"gone\".\n"
    "}\n"
    "Stationary : Block {\n"
    "  + to init:\n"
    "    self register with-shape ((new Cube) init-with size (2, 4, 6)) at-location (0, -50, 0).\n"
    "}\n"
    "Object : Broken {\n"
    "  + to init:\n"
    "    die \"cannot be made\".\n"
    "}\n";

static void append(char* to, size_t room, const char* text, size_t size) {
  const size_t used = strlen(to);
  if (size > room - used - 1) size = room - used - 1;
  memcpy(to + used, text, size);
  to[used + size] = '\0';
}

void remember(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  transcript* t = user;
  CHECK(world != NULL);
  CHECK(text[size] == '\0');
  switch (channel) {
    case BREVE_CHANNEL_PRINT:
      append(t->print, sizeof t->print, text, size);
      ++t->prints;
      if (t->on_print) t->on_print(world, t->context);
      break;
    case BREVE_CHANNEL_WARNING:
      append(t->warning, sizeof t->warning, text, size);
      ++t->warnings;
      if (t->on_warning) t->on_warning(world, t->context);
      break;
    case BREVE_CHANNEL_ERROR:
      append(t->error, sizeof t->error, text, size);
      ++t->errors;
      break;
  }
}

static void show_diagnostics(const breve_runtime* runtime) {
  for (size_t i = 0; i < breve_runtime_diagnostic_count(runtime); ++i) {
    breve_diagnostic d;
    if (breve_runtime_diagnostic(runtime, i, &d) == BREVE_OK) printf("%s", d.text);
  }
}

bool scene_open_text(scene* s, const char* text, const breve_world_config* config) {
  memset(s, 0, sizeof *s);
  breve_runtime_config c = breve_runtime_config_default();
  c.user = &s->said;
  c.print = remember;
  if (!CHECK_STATUS(BREVE_OK, breve_runtime_create(&c, &s->runtime))) return false;
  if (!CHECK_STATUS(BREVE_OK, breve_program_compile(s->runtime, "scene.tz", text, strlen(text), &s->program))) {
    show_diagnostics(s->runtime);
    return false;
  }
  const bool made = CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, config, &s->world));
  if (!made && breve_runtime_last_error(s->runtime)) printf("%s", breve_runtime_last_error(s->runtime)->text);
  return made;
}

bool scene_open(scene* s) { return scene_open_text(s, scene_text, NULL); }

void scene_close(scene* s) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(s->world));
  breve_program_destroy(s->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(s->runtime));
}

breve_value value_of(scene* s, const char* variable) {
  breve_value value = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_object_get(s->world, breve_world_controller(s->world), variable, &value));
  return value;
}

int int_of(scene* s, const char* variable) {
  const breve_value value = value_of(s, variable);
  CHECK(value.type == BREVE_TYPE_INT);
  return value.as.integer;
}

breve_object ball_of(scene* s) {
  const breve_value value = value_of(s, "ball");
  CHECK(value.type == BREVE_TYPE_OBJECT);
  return value.as.object;
}
