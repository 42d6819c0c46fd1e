/* What scripts may touch outside their world: by default nothing, and no more than the host gives. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene.h"

/* --- a directory to play in ---------------------------------------------------------------------------------------- */

static char box[64];

static void path_in_box(char* path, size_t size, const char* name) { snprintf(path, size, "%s/%s", box, name); }

static void put(const char* name, const char* text) {
  char path[256];
  path_in_box(path, sizeof path, name);
  FILE* file = fopen(path, "wb");
  if (!CHECK(file != NULL)) return;
  fputs(text, file);
  fclose(file);
}

/* The contents of a file there; "-" if there is none. */
static const char* content(const char* name) {
  static char text[256];
  char path[256];
  path_in_box(path, sizeof path, name);
  FILE* file = fopen(path, "rb");
  if (!file) return "-";
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  return text;
}

static bool make_box(void) {
  char path[256], target[256];
  snprintf(box, sizeof box, "/tmp/breve-files-XXXXXX");
  if (!CHECK(mkdtemp(box) != NULL)) return false;
  put("outside.txt", "secret\n");
  path_in_box(path, sizeof path, "root");
  CHECK(mkdir(path, 0700) == 0);
  path_in_box(path, sizeof path, "root/sub");
  CHECK(mkdir(path, 0700) == 0);
  path_in_box(path, sizeof path, "other");
  CHECK(mkdir(path, 0700) == 0);
  put("root/a.txt", "first\nsecond\n");
  put("root/sub/b.txt", "below\n");
  put("other/c.txt", "elsewhere\n");
  path_in_box(path, sizeof path, "root/pipe");
  CHECK(mkfifo(path, 0600) == 0);
  path_in_box(target, sizeof target, "outside.txt");
  path_in_box(path, sizeof path, "root/link.txt");
  CHECK(symlink(target, path) == 0);
  path_in_box(path, sizeof path, "root/way");
  return CHECK(symlink(box, path) == 0);
}

static void remove_box(void) {
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", box);
  CHECK(system(command) == 0);
}

/* --- a world that reads and writes --------------------------------------------------------------------------------- */

static const char* const text =
    "@use Control.\n@use Image.\n@use Data.\nController Clerk.\n"
    "Data : Note { + variables: word (string). }\n"
    "Control : Clerk {\n"
    "  + variables:\n    f (pointer).\n"
    "  + to read name s (string):\n"
    "    f = openFileForReading(s).\n    if !f: return \"none\".\n    return readLine(f).\n"
    "  + to write text t (string) into s (string):\n"
    "    f = openFileForWriting(s).\n    if !f: return 0.\n    writeString(f, t).\n    return 1.\n"
    "  + to append text t (string) into s (string):\n"
    "    f = openFileForAppending(s).\n    if !f: return 0.\n    writeString(f, t).\n    closeFile(f).\n    return 1.\n"
    "  + to finish: closeFile(f).\n"
    "  + to draw into s (string):\n"
    "    i (object).\n    i = new Image.\n    i set-size width 4 height 4.\n    return (i write to s).\n"
    "  + to look at s (string):\n    i (object).\n    i = new Image.\n    return !!(i load from s).\n"
    "  + to archive into s (string): return (self archive-as-xml file s).\n"
    "  + to note into s (string): return (new Note save-as-xml file s).\n"
    "  + to find name s (string): return findFile(s).\n"
    "  + to rest: sleep(0.001).\n"
    "  + to look-at-clock: return getRealTime().\n"
    "  + to look-at-run: return getRunningTime().\n"
    "  + to draw-seed: return randomSeedFromDevRandom().\n"
    "  + to run-command: return system(\"id\").\n"
    "  + to read-whole of s (string):\n    f = openFileForReading(s).\n    return |readFileAsString(f)|.\n"
    "  + to read-a-line of s (string):\n    f = openFileForReading(s).\n    return |readLine(f)|.\n"
    "}\n";

typedef struct {
  transcript said;
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} clerk;

static bool open_clerk(clerk* c, breve_runtime_config config) {
  memset(c, 0, sizeof *c);
  config.user = &c->said;
  config.print = remember;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &c->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_compile(c->runtime, "clerk.tz", text, strlen(text), &c->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(c->runtime, c->program, NULL, &c->world));
}

static void close_clerk(clerk* c) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(c->world));
  breve_program_destroy(c->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(c->runtime));
}

/* One of the methods above; of two texts the second is `name`. */
static breve_status ask(clerk* c, const char* method, const char* what, const char* name, breve_value* result) {
  static const char* const words[][2] = {
      {"read", "name"}, {"look", "at"}, {"draw", "into"}, {"archive", "into"}, {"find", "name"}};
  breve_keyword args[2];
  size_t count = 0;
  if (what) args[count++] = (breve_keyword){"text", breve_value_string(what)};
  if (name) {
    const char* keyword = "into";
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
      if (strcmp(words[i][0], method) == 0) keyword = words[i][1];
    args[count++] = (breve_keyword){keyword, breve_value_string(name)};
  }
  return breve_object_call(c->world, breve_world_controller(c->world), method, args, count, result);
}

static void reads(clerk* c, const char* name, const char* line) {
  breve_value result;
  const char* got = NULL;
  CHECK_STATUS(BREVE_OK, ask(c, "read", NULL, name, &result));
  CHECK_STATUS(BREVE_OK, breve_value_text(c->world, &result, &got));
  CHECK_TEXT(line, got);
}

static bool does(clerk* c, const char* method, const char* what, const char* name) {
  breve_value result;
  CHECK_STATUS(BREVE_OK, ask(c, method, what, name, &result));
  return result.type == BREVE_TYPE_INT && result.as.integer == 1;
}

static breve_runtime_config with_root(breve_files* files, const char* name, bool may_write, uint64_t most) {
  char path[256];
  breve_runtime_config config = breve_runtime_config_default();
  path_in_box(path, sizeof path, name);
  CHECK_STATUS(BREVE_OK, breve_files_add_directory(path, may_write, most, files));
  config.files = *files;
  return config;
}

/* --- tests --------------------------------------------------------------------------------------------------------- */

static void by_default_nothing_is_touched(void) {
  clerk c;
  if (!open_clerk(&c, breve_runtime_config_default())) return;
  static const char* const machine[] = {"/etc/passwd", "/proc/self/environ", "/proc/self/maps"};
  for (size_t i = 0; i < sizeof machine / sizeof *machine; ++i) reads(&c, machine[i], "none");
  CHECK(strstr(c.said.error, "the host does not let scripts read files") != NULL ||
        strstr(c.said.warning, "let scripts") != NULL);
  char path[256];
  path_in_box(path, sizeof path, "root/made.txt");
  CHECK(!does(&c, "write", "x", path) && !does(&c, "append", "x", path) && !does(&c, "draw", NULL, path));
  breve_value result;
  static const char* const savers[] = {"archive", "note"};
  for (size_t i = 0; i < sizeof savers / sizeof *savers; ++i) {
    CHECK_STATUS(BREVE_OK, ask(&c, savers[i], NULL, path, &result));
    CHECK(result.as.integer == -1);
  }
  CHECK_TEXT("-", content("root/made.txt"));
  static const char* const refused[] = {"rest", "look-at-clock", "look-at-run", "draw-seed", "run-command"};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
    CHECK_STATUS(BREVE_ERROR_SCRIPT, ask(&c, refused[i], NULL, NULL, NULL));
    CHECK(strstr(breve_world_last_error(c.world)->message, "the host does not") != NULL);
  }
  close_clerk(&c);
}

static void rights_are_given_one_by_one(void) {
  static const struct {
    uint32_t right;
    const char* method;
  } rights[] = {{BREVE_RIGHT_SLEEP, "rest"},
                {BREVE_RIGHT_REAL_TIME, "look-at-clock"},
                {BREVE_RIGHT_REAL_TIME, "look-at-run"},
                {BREVE_RIGHT_ENTROPY, "draw-seed"}};
  for (size_t i = 0; i < sizeof rights / sizeof *rights; ++i) {
    clerk c;
    breve_runtime_config config = breve_runtime_config_default();
    config.rights = rights[i].right;
    if (!open_clerk(&c, config)) return;
    for (size_t k = 0; k < sizeof rights / sizeof *rights; ++k)
      CHECK_STATUS(rights[k].right == rights[i].right ? BREVE_OK : BREVE_ERROR_SCRIPT,
                   ask(&c, rights[k].method, NULL, NULL, NULL));
    close_clerk(&c);
  }
  breve_runtime* runtime = NULL;
  breve_runtime_config config = breve_runtime_config_default();
  config.rights = 8;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_create(&config, &runtime));
}

static void files_below_a_directory_are_read(void) {
  clerk c;
  breve_files files = {0};
  if (!open_clerk(&c, with_root(&files, "root", false, 0))) return;
  reads(&c, "a.txt", "first");
  reads(&c, "sub/b.txt", "below");
  reads(&c, "./sub//./b.txt", "below");
  reads(&c, "missing.txt", "none");
  breve_value result;
  const char* found = NULL;
  CHECK_STATUS(BREVE_OK, ask(&c, "find", NULL, "a.txt", &result));
  CHECK_STATUS(BREVE_OK, breve_value_text(c.world, &result, &found));
  CHECK_TEXT("a.txt", found);
  CHECK(!does(&c, "write", "x", "made.txt") && !does(&c, "append", "x", "a.txt") && !does(&c, "draw", NULL, "p.png"));
  CHECK_TEXT("-", content("root/made.txt"));
  CHECK_TEXT("first\nsecond\n", content("root/a.txt"));
  close_clerk(&c);
  CHECK_STATUS(BREVE_OK, breve_files_release(&files));
}

static void nothing_leads_out_of_a_directory(void) {
  clerk c;
  breve_files files = {0};
  if (!open_clerk(&c, with_root(&files, "root", true, 0))) return;
  char absolute[256];
  path_in_box(absolute, sizeof absolute, "root/a.txt");
  const char* const names[] = {"../outside.txt",
                               "sub/../../outside.txt",
                               absolute,
                               "/etc/passwd",
                               "link.txt",
                               "way/outside.txt",
                               "way/other/c.txt",
                               "pipe",
                               "sub",
                               ".",
                               "..",
                               "sub/",
                               "/dev/zero",
                               ""};
  for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
    reads(&c, names[i], "none");
    CHECK(!does(&c, "write", "x", names[i]));
    CHECK(!does(&c, "append", "x", names[i]));
  }
  CHECK_TEXT("secret\n", content("outside.txt"));
  CHECK_TEXT("elsewhere\n", content("other/c.txt"));
  CHECK(!does(&c, "write", "x", "no/such/folder.txt"));
  close_clerk(&c);
  breve_files_release(&files);
}

static void what_is_written_gets_its_name_when_it_is_closed(void) {
  clerk c;
  breve_files files = {0};
  if (!open_clerk(&c, with_root(&files, "root", true, 0))) return;
  put("root/old.txt", "old");
  CHECK(does(&c, "write", "new", "old.txt"));
  CHECK_TEXT("old", content("root/old.txt"));
  CHECK_STATUS(BREVE_OK, ask(&c, "finish", NULL, NULL, NULL));
  CHECK_TEXT("new", content("root/old.txt"));
  CHECK(does(&c, "append", "er", "old.txt") && does(&c, "append", "made", "sub/fresh.txt"));
  CHECK_TEXT("newer", content("root/old.txt"));
  CHECK_TEXT("made", content("root/sub/fresh.txt"));
  CHECK(does(&c, "draw", NULL, "p.png") && does(&c, "look", NULL, "p.png"));
  /* A file that nobody closed is kept when its world ends. */
  CHECK(does(&c, "write", "left open", "last.txt"));
  close_clerk(&c);
  CHECK_TEXT("left open", content("root/last.txt"));
  breve_files_release(&files);
}

static void files_are_bounded(void) {
  clerk c;
  breve_files files = {0};
  if (!open_clerk(&c, with_root(&files, "root", true, 12))) return;
  put("root/long.txt", "thirteen bytes");
  reads(&c, "long.txt", "none");
  put("root/kept.txt", "kept");
  CHECK(does(&c, "write", "much too long for it", "kept.txt"));
  CHECK_STATUS(BREVE_OK, ask(&c, "finish", NULL, NULL, NULL));
  CHECK_TEXT("kept", content("root/kept.txt"));
  close_clerk(&c);
  breve_files_release(&files);
}

static void a_long_file_counts_as_work_and_as_memory(void) {
  static const char* const methods[] = {"read-whole", "read-a-line"};
  char path[256];
  breve_files files = {0};
  breve_runtime_config config = with_root(&files, "root", false, 0);
  path_in_box(path, sizeof path, "root/zeros");
  put("root/zeros", "");
  CHECK(truncate(path, 64 << 20) == 0);
  for (int bounded = 0; bounded < 2; ++bounded) {
    clerk c;
    if (!open_clerk(&c, config)) return;
    breve_world* plain = c.world;
    breve_world_config limits = breve_world_config_default();
    if (bounded)
      limits.budget = 1000000;
    else
      limits.memory_limit = (size_t)32 << 20;
    if (CHECK_STATUS(BREVE_OK, breve_world_create(c.runtime, c.program, &limits, &c.world))) {
      const breve_keyword file = {"of", breve_value_string("zeros")};
      for (int i = 0; i < 2; ++i)
        CHECK_STATUS(bounded ? BREVE_ERROR_BUDGET : BREVE_ERROR_MEMORY,
                     breve_object_call(c.world, breve_world_controller(c.world), methods[i], &file, 1, NULL));
      breve_world_destroy(c.world);
    }
    c.world = plain;
    close_clerk(&c);
  }
  breve_files_release(&files);
}

static void directories_are_searched_in_their_order(void) {
  clerk c;
  breve_files files = {0};
  with_root(&files, "root", false, 0);
  if (!open_clerk(&c, with_root(&files, "other", true, 0))) return;
  put("other/a.txt", "hidden\n");
  reads(&c, "a.txt", "first");
  reads(&c, "c.txt", "elsewhere");
  CHECK(does(&c, "write", "x", "made.txt"));
  CHECK_STATUS(BREVE_OK, ask(&c, "finish", NULL, NULL, NULL));
  CHECK_TEXT("-", content("root/made.txt"));
  CHECK_TEXT("x", content("other/made.txt"));
  close_clerk(&c);
  breve_files_release(&files);
}

static void two_runtimes_share_files_and_keep_them(void) {
  clerk one, two;
  breve_files files = {0};
  const breve_runtime_config config = with_root(&files, "root", false, 0);
  if (!open_clerk(&one, config) || !open_clerk(&two, config)) return;
  CHECK_STATUS(BREVE_OK, breve_files_release(&files));
  CHECK(files.user == NULL && files.open_for_reading == NULL);
  reads(&one, "a.txt", "first");
  close_clerk(&one);
  reads(&two, "a.txt", "first");
  close_clerk(&two);
}

static void what_is_no_directory_is_refused(void) {
  breve_files files = {0};
  char path[256];
  path_in_box(path, sizeof path, "outside.txt");
  CHECK_STATUS(BREVE_ERROR_FILE, breve_files_add_directory(path, false, 0, &files));
  CHECK_STATUS(BREVE_ERROR_FILE, breve_files_add_directory("/no/such/directory", false, 0, &files));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_files_add_directory(NULL, false, 0, &files));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_files_add_directory(box, false, 0, NULL));
  CHECK(files.user == NULL);
  CHECK_STATUS(BREVE_OK, breve_files_release(&files));
  CHECK_STATUS(BREVE_OK, breve_files_release(NULL));
}

/* --- a host that opens files itself -------------------------------------------------------------------------------- */

static struct {
  char written[64];
  size_t at, closed, dropped;
  bool fails;
} memory;

static bool read_memory(void* handle, void* bytes, size_t size, size_t* got) {
  (void)handle;
  if (memory.fails) return false;
  *got = 0;
  for (; *got < size && memory.at < 5; ++*got) ((char*)bytes)[*got] = "hello"[memory.at++];
  return true;
}
static bool write_memory(void* handle, const void* bytes, size_t size) {
  (void)handle;
  if (memory.fails) return false;
  snprintf(memory.written, sizeof memory.written, "%.*s", (int)size, (const char*)bytes);
  return true;
}
static bool close_memory(void* handle, bool keep) {
  (void)handle;
  ++memory.closed;
  memory.dropped += !keep;
  return true;
}
static bool open_memory(void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                        void* sink) {
  (void)user, (void)world;
  if (strcmp(name, "secret") == 0) {
    reason(sink, "it is ", 6);
    reason(sink, "a secret", 8);
    return false;
  }
  *file = (breve_file){NULL, read_memory, write_memory, close_memory, "a path"};
  memory.at = 0;
  return strcmp(name, "none") != 0;
}
static bool open_memory_to_write(void* user, breve_world* world, const char* name, bool append, breve_file* file,
                                 breve_write_fn reason, void* sink) {
  (void)append;
  return open_memory(user, world, name, file, reason, sink);
}

static void a_host_may_open_files_itself(void) {
  clerk c;
  memset(&memory, 0, sizeof memory);
  breve_runtime_config config = breve_runtime_config_default();
  config.files.open_for_reading = open_memory;
  config.files.open_for_writing = open_memory_to_write;
  if (!open_clerk(&c, config)) return;
  reads(&c, "any/name at all", "hello");
  reads(&c, "none", "none");
  reads(&c, "secret", "none");
  CHECK(strstr(c.said.warning, "cannot read file 'secret': it is a secret") != NULL);
  CHECK(does(&c, "write", "bytes", "x"));
  CHECK_STATUS(BREVE_OK, ask(&c, "finish", NULL, NULL, NULL));
  CHECK_TEXT("bytes", memory.written);
  memory.fails = true;
  CHECK(does(&c, "write", "lost", "x"));
  CHECK_STATUS(BREVE_OK, ask(&c, "finish", NULL, NULL, NULL));
  CHECK(memory.dropped == 1);
  CHECK(ask(&c, "read", NULL, "x", NULL) != BREVE_OK);
  close_clerk(&c);
  CHECK(memory.closed == 4);
  breve_files others = config.files;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_files_add_directory("/", false, 0, &others));
}

void files_suite(void) {
  if (!make_box()) return;
  RUN(by_default_nothing_is_touched);
  RUN(rights_are_given_one_by_one);
  RUN(files_below_a_directory_are_read);
  RUN(nothing_leads_out_of_a_directory);
  RUN(what_is_written_gets_its_name_when_it_is_closed);
  RUN(files_are_bounded);
  RUN(a_long_file_counts_as_work_and_as_memory);
  RUN(directories_are_searched_in_their_order);
  RUN(two_runtimes_share_files_and_keep_them);
  RUN(what_is_no_directory_is_refused);
  RUN(a_host_may_open_files_itself);
  remove_box();
}
