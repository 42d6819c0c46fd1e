/* The world of the game: how a host embeds breve, from the first call to the last. */
#include "meadow.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool complain(const breve_error* error) {
  if (error) fputs(error->text, stderr);
  return false;
}
static bool worked(const meadow* m, breve_status status) {
  return status == BREVE_OK || complain(breve_world_last_error(m->world));
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

/* The bytes of a file, to be freed; NULL if it cannot be read. */
static char* read_file(const char* path, size_t* size) {
  FILE* file = fopen(path, "rb");
  char* bytes = NULL;
  long length = -1;
  if (file && fseek(file, 0, SEEK_END) == 0) length = ftell(file);
  if (length >= 0) bytes = malloc((size_t)length + 1);
  if (bytes) {
    rewind(file);
    *size = fread(bytes, 1, (size_t)length, file);
  }
  if (file) fclose(file);
  if (!bytes) fprintf(stderr, "%s cannot be read\n", path);
  return bytes;
}

static bool write_file(const char* path, const char* bytes, size_t size) {
  FILE* file = fopen(path, "wb");
  bool written = file && fwrite(bytes, 1, size, file) == size;
  if (file && fclose(file) != 0) written = false;
  if (!written) fprintf(stderr, "%s cannot be written\n", path);
  return written;
}

/* ---- what the world tells the game ------------------------------------------------------------------------------- */

/* Scripts print, and errors in scripts are reported, through this and nothing else. */
static void print(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)user, (void)world;
  fwrite(text, 1, size, channel == BREVE_CHANNEL_PRINT ? stdout : stderr);
}

/* An agent announced something. The game knows three words; whatever else agents say to each other it does not mind. */
static void hear(void* user, breve_world* world, const breve_announcement* announcement) {
  meadow* m = user;
  breve_pose pose = {{0}, {1}};
  spark* s = &m->sparks[m->spark_count];
  if (strcmp(announcement->message, "over") == 0) m->over = true;
  if (m->spark_count == MOST_SPARKS) return;
  if (strcmp(announcement->message, "honey") == 0)
    s->kind = SPARK_HONEY; /* of the controller, which is nowhere: at the hive, in the middle */
  else if (strcmp(announcement->message, "sting") == 0)
    s->kind = SPARK_STING;
  else
    return;
  breve_object_pose(world, announcement->announcer, &pose); /* stays at 0, 0 if it fails */
  s->x = (float)pose.location[0];
  s->y = (float)pose.location[1];
  s->age = 0;
  ++m->spark_count;
}

/* ---- open and close ---------------------------------------------------------------------------------------------- */

static bool compile(meadow* m, breve_program** program) {
  char path[1024];
  size_t size = 0;
  snprintf(path, sizeof path, "%s/meadow.tz", m->directory);
  char* text = read_file(path, &size);
  if (!text) return false;
  const breve_status status = breve_program_compile(m->runtime, path, text, size, program);
  free(text);
  return status == BREVE_OK || complain(breve_runtime_last_error(m->runtime));
}

static bool prepare(meadow* m) {
  static const char* const at[] = {"at"};
  breve_listener listener = breve_listener_default();
  listener.user = m;
  listener.announcement = hear;
  return worked(m, breve_world_prepare(m->world, "plant", at, 1, &m->plant)) &&
         worked(m, breve_world_set_listener(m->world, &listener)) &&
         worked(m, breve_world_set_interpolated(m->world, true));
}

bool meadow_open(meadow* m, const char* directory, uint64_t seed) {
  breve_runtime_config runtime = breve_runtime_config_default();
  breve_world_config world = breve_world_config_default();
  m->directory = directory;
  runtime.print = print;
  world.seed = seed;
  world.advance_limit = 8; /* a computer that is too slow plays slowly, and does not fall behind more and more */
  if (breve_runtime_create(&runtime, &m->runtime) != BREVE_OK) return false;
  if (!compile(m, &m->program)) return false;
  if (breve_world_create(m->runtime, m->program, &world, &m->world) != BREVE_OK)
    return complain(breve_runtime_last_error(m->runtime));
  return prepare(m);
}

void meadow_close(meadow* m) {
  breve_world_destroy(m->world);
  breve_program_destroy(m->program);
  breve_runtime_destroy(m->runtime);
}

/* ---- each frame -------------------------------------------------------------------------------------------------- */

/* Three calls for a whole class, however many there are: who, where, and a variable of the script. */
static void read_crowd(meadow* m, const char* class_name, const char* variable, crowd* to) {
  const breve_array places = {to->places, 0, BREVE_NUMBER_FLOAT, 3};
  const breve_array velocities = {to->velocities, 0, BREVE_NUMBER_FLOAT, 3};
  const breve_array numbers = {to->numbers, 0, BREVE_NUMBER_FLOAT, 1};
  to->count = 0;
  if (breve_world_objects(m->world, class_name, to->objects, MOST_CREATURES, &to->count) != BREVE_OK) return;
  if (to->count > MOST_CREATURES) to->count = MOST_CREATURES;
  breve_objects_interpolated(m->world, to->objects, to->count, m->fraction, BREVE_PROPERTY_LOCATION, &places);
  breve_objects_property(m->world, to->objects, to->count, BREVE_PROPERTY_VELOCITY, &velocities);
  if (variable) breve_objects_get(m->world, to->objects, to->count, variable, &numbers);
}

static int read_number(meadow* m, const char* variable) {
  breve_value value = breve_value_int(0);
  breve_object_get(m->world, breve_world_controller(m->world), variable, &value);
  return value.as.integer;
}

static void read_all(meadow* m) {
  const breve_array hues = {m->hues, 0, BREVE_NUMBER_FLOAT, 1};
  read_crowd(m, "Bee", "load", &m->bees);
  read_crowd(m, "Wasp", "fright", &m->wasps);
  read_crowd(m, "Flower", "nectar", &m->flowers);
  read_crowd(m, "Keeper", NULL, &m->keepers);
  breve_objects_get(m->world, m->flowers.objects, m->flowers.count, "hue", &hues);
  m->honey = read_number(m, "honey");
  m->seeds = read_number(m, "seeds");
  m->lost = read_number(m, "lost");
}

void meadow_advance(meadow* m, double seconds) {
  size_t kept = 0;
  for (size_t i = 0; i < m->spark_count; ++i) {
    m->sparks[i].age += (float)seconds;
    if (m->sparks[i].age < 1) m->sparks[kept++] = m->sparks[i];
  }
  m->spark_count = kept;
  /* Some iterations or none: the listener hears of all of them. */
  worked(m, breve_world_advance(m->world, seconds, &m->fraction));
  read_all(m);
}

/* ---- input ------------------------------------------------------------------------------------------------------- */

void meadow_key(meadow* m, const char* key, bool down) { worked(m, breve_world_queue_key(m->world, key, down)); }

void meadow_click(meadow* m, float x, float y) {
  /* Down from above: a click goes to whatever a ray meets. With some room about it, since wasps are quick. */
  const double point[3] = {(double)x, (double)y, 0};
  breve_query wasps = breve_query_default();
  breve_hit hit;
  bool found = false;
  wasps.class_name = "Wasp";
  if (!worked(m, breve_world_closest(m->world, point, 0.8, &wasps, &found, &hit))) return;
  if (found) {
    worked(m, breve_world_queue_click(m->world, hit.object));
    return;
  }
  const breve_value place = breve_value_vector(point[0], point[1], 0);
  breve_value planted = breve_value_int(0);
  worked(m, breve_object_call_prepared(m->world, breve_world_controller(m->world), m->plant, &place, 1, &planted));
  if (planted.as.integer == 0 || m->spark_count == MOST_SPARKS) return;
  m->sparks[m->spark_count++] = (spark){SPARK_PLANTED, x, y, 0};
}

void meadow_set_slow(meadow* m, bool slow) { breve_world_set_time_scale(m->world, slow ? 0.25 : 1); }

void meadow_toggle_pause(meadow* m) { breve_world_set_paused(m->world, !breve_world_paused(m->world)); }

/* ---- save, load, change ------------------------------------------------------------------------------------------ */

/* A snapshot is the whole world: agents, scripts, random numbers. Going on from it is going on as before, bit for bit.
 */
bool meadow_save(meadow* m, const char* path) {
  size_t size = 0;
  if (!worked(m, breve_world_snapshot(m->world, NULL, 0, &size))) return false;
  char* image = malloc(size);
  bool saved = image && worked(m, breve_world_snapshot(m->world, image, size, &size));
  saved = saved && write_file(path, image, size);
  free(image);
  return saved;
}

bool meadow_load(meadow* m, const char* path) {
  size_t size = 0;
  char* image = read_file(path, &size);
  const bool loaded = image && worked(m, breve_world_restore(m->world, image, size));
  free(image);
  if (!loaded) return false; /* a damaged file changes nothing */
  m->over = read_number(m, "over") != 0;
  m->spark_count = 0;
  read_all(m);
  return true;
}

bool meadow_reload(meadow* m) {
  breve_program* changed = NULL;
  if (!compile(m, &changed)) return false; /* a mistake in the text leaves the game as it is */
  if (!worked(m, breve_world_reload(m->world, changed))) {
    breve_program_destroy(changed);
    return false;
  }
  breve_program_destroy(m->program);
  m->program = changed;
  return true;
}
