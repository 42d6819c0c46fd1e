/* Record and replay: a log holds everything that came from outside, and a replay finds the first iteration that
 * differs. */
#include <stdlib.h>

#include "scene.h"

/* A log in memory. */
typedef struct tape {
  char* bytes;
  size_t size;
} tape;

static void append(void* sink, const char* bytes, size_t size) {
  tape* t = sink;
  t->bytes = realloc(t->bytes, t->size + size);
  memcpy(t->bytes + t->size, bytes, size);
  t->size += size;
}
static void erase(tape* t) {
  free(t->bytes);
  t->bytes = NULL;
  t->size = 0;
}

/* --- an outside that is different each time it is asked ----------------------------------------------------------- */

static int opened, commands, sensed;

static bool read_some(void* handle, void* bytes, size_t size, size_t* got) {
  int* left = handle;
  *got = *left > 0 && size >= 8 ? (size_t)snprintf(bytes, 8, "%d\n", 100 * opened + *left) : 0;
  --*left;
  return true;
}
static bool open_file(void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                      void* sink) {
  static int left;
  (void)user, (void)world, (void)reason, (void)sink;
  if (strcmp(name, "missing") == 0) return ++opened % 2 == 0; /* not there at first */
  left = 2;
  ++opened;
  file->handle = &left;
  file->read = read_some;
  return true;
}
static bool system_call(void* user, breve_world* world, const char* command, breve_write_fn write, void* sink) {
  char text[16];
  (void)user, (void)world, (void)command;
  write(sink, text, (size_t)snprintf(text, sizeof text, "%d", ++commands));
  return true;
}
static breve_status sense(void* user, const breve_call* call, breve_value* result) {
  int value = ++sensed;
  const breve_status status = breve_world_record_input(call->world, &value, sizeof value);
  (void)user;
  *result = breve_value_int(value);
  return status;
}

/* The host's function does not pass what it reads through the log, from the sixth iteration on. */
static int honest;
static breve_status waver(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  *result = breve_value_int(breve_world_iteration(call->world) < 5 ? 1 : ++honest);
  return BREVE_OK;
}

static breve_world* to_interrupt;
static breve_status interrupt_now(void* user, const breve_call* call, breve_value* result) {
  (void)user, (void)result;
  if (to_interrupt == call->world) breve_world_interrupt(call->world);
  return BREVE_OK;
}

static const char* const text =
    "@use Control.\n@use Mobile.\nController Lab.\nControl : Lab {\n"
    "  + variables: keys, senses, seed, host (int). clock (float). said, seen (string). probe (object).\n"
    "  + to init: probe = new Mobile.\n"
    "  + to catch-key-a-down: keys += 1.\n"
    "  + to look: host += 1.\n"
    "  + to iterate:\n"
    "    file (pointer). words (string).\n"
    "    clock = getRealTime() + getRunningTime().\n"
    "    if keys % 2: seed = randomSeedFromDevRandom().\n"
    "    words = system(\"date\").\n"
    "    said = \"$said$words\".\n"
    "    senses += sense().\n"
    "    file = openFileForReading(\"data\").\n"
    "    words = readFileAsString(file).\n"
    "    seen = \"$seen$words\".\n"
    "    closeFile(file).\n"
    "    if openFileForReading(\"missing\"): seen = \"$seen!\".\n"
    "    probe set-velocity to random[(1, 1, 1)] + (clock % 1, 0, 0).\n"
    "    super iterate.\n"
    "}\n";

typedef struct lab {
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} lab;

static bool add_function(const lab* l, const char* name, breve_type result, breve_function_fn call) {
  breve_function f = breve_function_default();
  f.name = name;
  f.result = result;
  f.call = call;
  return breve_runtime_add_function(l->runtime, &f) == BREVE_OK;
}
static bool lab_open(lab* l, const char* program_text) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(l, 0, sizeof *l);
  config.files.open_for_reading = open_file;
  config.system = system_call;
  config.rights = BREVE_RIGHT_REAL_TIME | BREVE_RIGHT_ENTROPY | BREVE_RIGHT_SLEEP;
  const bool fine =
      breve_runtime_create(&config, &l->runtime) == BREVE_OK && add_function(l, "sense", BREVE_TYPE_INT, sense) &&
      add_function(l, "waver", BREVE_TYPE_INT, waver) && add_function(l, "stopMe", BREVE_TYPE_NULL, interrupt_now) &&
      breve_program_compile(l->runtime, "lab.tz", program_text, strlen(program_text), &l->program) == BREVE_OK &&
      breve_world_create(l->runtime, l->program, NULL, &l->world) == BREVE_OK;
  if (!CHECK(fine) && breve_runtime_last_error(l->runtime)) printf("%s", breve_runtime_last_error(l->runtime)->text);
  return fine;
}
static void lab_close(lab* l) {
  breve_world_destroy(l->world);
  breve_program_destroy(l->program);
  breve_runtime_destroy(l->runtime);
}
static int number(const lab* l, const char* name) {
  breve_value value = breve_value_int(-1);
  CHECK_STATUS(BREVE_OK, breve_object_get(l->world, breve_world_controller(l->world), name, &value));
  return value.as.integer;
}
static uint64_t hash_of(const lab* l) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(l->world, &hash));
  return hash;
}

/* Ten iterations with everything that a host can do between them. */
static void live(lab* l, tape* t) {
  const breve_object controller = breve_world_controller(l->world);
  breve_value value;
  breve_object made;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l->world, append, t));
  CHECK(breve_world_recording(l->world));
  for (int i = 0; i < 10; ++i) {
    if (i % 3 == 0) CHECK_STATUS(BREVE_OK, breve_world_queue_key(l->world, "a", true));
    if (i == 4) CHECK_STATUS(BREVE_OK, breve_object_call(l->world, controller, "look", NULL, 0, &value));
    if (i == 5) CHECK_STATUS(BREVE_OK, breve_object_create(l->world, "Mobile", &made));
    if (i == 6) {
      const breve_value new_host = breve_value_int(1000);
      CHECK_STATUS(BREVE_OK, breve_object_set(l->world, controller, "host", &new_host));
    }
    if (i == 8) CHECK_STATUS(BREVE_OK, breve_object_free(l->world, made));
    if (!CHECK_STATUS(BREVE_OK, breve_world_step(l->world))) printf("%s", breve_world_last_error(l->world)->text);
  }
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l->world));
  CHECK(!breve_world_recording(l->world));
}

static void a_replay_in_another_world_is_the_recorded_run(void) {
  lab first, second;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&first, text)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(first.world)); /* a log may begin anywhere */
  live(&first, &t);
  CHECK(number(&first, "keys") == 4 && number(&first, "host") == 1000);
  const int opened_then = opened, commands_then = commands;
  if (lab_open(&second, text)) {
    CHECK_STATUS(BREVE_OK, breve_world_replay(second.world, t.bytes, t.size, NULL, NULL, &replay));
    CHECK(!replay.differs && replay.complete && replay.iterations == 10 && replay.iteration == 11);
    CHECK(replay.hash == replay.recorded_hash && hash_of(&second) == hash_of(&first));
    for (const char* const* name = (const char* const[]){"keys", "senses", "seed", "host", NULL}; *name; ++name)
      CHECK(number(&second, *name) == number(&first, *name));
    CHECK(opened == opened_then && commands == commands_then); /* the outside was not asked */
    CHECK_STATUS(BREVE_OK, breve_world_step(second.world));    /* and it goes on like any other world */
    CHECK(opened > opened_then);
    lab_close(&second);
  }
  lab_close(&first);
  erase(&t);
}

static int seen_iterations;
static bool stop_at_third(void* user, breve_world* world) {
  uint64_t hash;
  CHECK(user == &seen_iterations && breve_world_iteration(world) > 0);
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_hash(world, &hash)); /* it may look, but not change anything */
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(world));
  return ++seen_iterations < 3;
}

static void a_replay_can_be_watched_and_ended(void) {
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, text)) return;
  live(&l, &t);
  seen_iterations = 0;
  CHECK_STATUS(BREVE_OK, breve_world_replay(l.world, t.bytes, t.size, stop_at_third, &seen_iterations, &replay));
  CHECK(replay.iterations == 3 && !replay.differs && !replay.complete && breve_world_iteration(l.world) == 3);
  lab_close(&l);
  erase(&t);
}

static void the_first_iteration_that_differs_is_named(void) {
  const char* wavering =
      "@use Control.\nController Lab.\nControl : Lab { + variables: sum (int).\n"
      "  + to iterate: sum += waver(). super iterate. }\n";
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, wavering)) return;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t));
  for (int i = 0; i < 9; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_replay(l.world, t.bytes, t.size, NULL, NULL, &replay));
  CHECK(replay.differs && replay.iterations == 6 && replay.iteration == 6 && replay.hash != replay.recorded_hash);
  lab_close(&l);
  erase(&t);
}

static void iterations_that_fail_are_part_of_the_run(void) {
  const char* failing =
      "@use Control.\nController Lab.\nControl : Lab { + variables: n (int).\n"
      "  + to iterate: n += 1. if n == 3: die \"at three\". super iterate. }\n";
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, failing)) return;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t));
  for (int i = 0; i < 5; ++i) CHECK_STATUS(i == 2 ? BREVE_ERROR_SCRIPT : BREVE_OK, breve_world_step(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_replay(l.world, t.bytes, t.size, NULL, NULL, &replay));
  CHECK(!replay.differs && replay.complete && replay.iterations == 5);
  CHECK(number(&l, "n") == 5);
  lab_close(&l);
  erase(&t);
}

static void an_interrupted_iteration_is_replayed_by_its_result(void) {
  const char* endless =
      "@use Control.\nController Lab.\nControl : Lab { + variables: n (int).\n"
      "  + to iterate: k (int). n += 1. if n == 2: { stopMe(). for k = 0, k < 100000000, k += 1: n = n. }\n"
      "    super iterate. }\n";
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, endless)) return;
  to_interrupt = l.world;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t));
  CHECK_STATUS(BREVE_OK, breve_world_step(l.world));
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED, breve_world_step(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_step(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l.world));
  to_interrupt = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_replay(l.world, t.bytes, t.size, NULL, NULL, &replay));
  CHECK(!replay.differs && replay.complete && replay.iterations == 3);
  lab_close(&l);
  erase(&t);
}

static void a_log_that_was_cut_off_is_replayed_to_its_last_whole_iteration(void) {
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, text)) return;
  live(&l, &t);
  uint64_t before = 10;
  for (size_t size = t.size; size-- > 0;) {
    const breve_status status = breve_world_replay(l.world, t.bytes, size, NULL, NULL, &replay);
    if (status == BREVE_ERROR_IMAGE) break; /* not even its snapshot is whole */
    CHECK(status == BREVE_OK && !replay.differs && !replay.complete);
    CHECK(replay.iterations == before || replay.iterations + 1 == before);
    before = replay.iterations;
    size -= size % 61; /* not each of them */
    if (size == 0) break;
  }
  CHECK(before == 0);
  lab_close(&l);
  erase(&t);
}

static void damaged_logs_and_those_of_other_programs_are_refused(void) {
  lab l, other;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, text)) return;
  live(&l, &t);
  const uint64_t before = hash_of(&l);
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_replay(l.world, "", 0, NULL, NULL, &replay));
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_replay(l.world, "breve log 2\n", 12, NULL, NULL, &replay));
  CHECK(hash_of(&l) == before); /* nothing was changed */
  for (size_t at = 0; at < t.size; at += 1 + t.size / 300) {
    t.bytes[at] = (char)(t.bytes[at] ^ 8);
    const breve_status status = breve_world_replay(l.world, t.bytes, t.size, NULL, NULL, &replay);
    /* A size that is damaged may look like a log that was cut off. */
    CHECK(status == BREVE_ERROR_IMAGE || (status == BREVE_OK && !replay.complete));
    t.bytes[at] = (char)(t.bytes[at] ^ 8);
  }
  if (lab_open(&other, "@use Control.\nController Lab.\nControl : Lab { }\n")) {
    CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_replay(other.world, t.bytes, t.size, NULL, NULL, &replay));
    lab_close(&other);
  }
  lab_close(&l);
  erase(&t);
}

static void recordings_end_with_a_reload_and_cannot_be_nested(void) {
  lab l;
  tape t = {0};
  breve_replay replay;
  if (!lab_open(&l, text)) return;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_record_start(l.world, NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l.world)); /* nothing to stop */
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_record_start(l.world, append, &t));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_replay(l.world, t.bytes, t.size, NULL, NULL, &replay));
  CHECK_STATUS(BREVE_OK, breve_world_reload(l.world, l.program));
  CHECK(!breve_world_recording(l.world));
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t)); /* destroyed while it is recorded */
  lab_close(&l);
  erase(&t);
}

static void a_log_grows_by_what_happens_and_not_by_the_size_of_the_world(void) {
  const char* crowd =
      "@use Control.\n@use Mobile.\nController Lab.\nControl : Lab {\n"
      "  + variables: crowd (list). n (int).\n"
      "  + to init: crowd = 2000 new Mobiles.\n"
      "  + to poke: n += 1. }\n";
  lab l;
  tape t = {0};
  breve_value value;
  if (!lab_open(&l, crowd)) return;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(l.world, append, &t));
  const size_t image = t.size;
  CHECK(image > 100000);
  for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(l.world));
  CHECK(t.size - image < 5 * 200);
  const size_t quiet = t.size;
  CHECK_STATUS(BREVE_OK, breve_object_call(l.world, breve_world_controller(l.world), "poke", NULL, 0, &value));
  CHECK_STATUS(BREVE_OK, breve_world_step(l.world));
  CHECK(t.size - quiet < image / 20); /* a difference, and not a whole image */
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(l.world));
  lab_close(&l);
  erase(&t);
}

void recording_suite(void) {
  RUN(a_replay_in_another_world_is_the_recorded_run);
  RUN(a_replay_can_be_watched_and_ended);
  RUN(the_first_iteration_that_differs_is_named);
  RUN(iterations_that_fail_are_part_of_the_run);
  RUN(an_interrupted_iteration_is_replayed_by_its_result);
  RUN(a_log_that_was_cut_off_is_replayed_to_its_last_whole_iteration);
  RUN(damaged_logs_and_those_of_other_programs_are_refused);
  RUN(recordings_end_with_a_reload_and_cannot_be_nested);
  RUN(a_log_grows_by_what_happens_and_not_by_the_size_of_the_world);
}
