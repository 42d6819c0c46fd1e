/* breve.h: worlds of agents for a host program. This header is the manual.
 *
 *     breve_runtime* runtime;  breve_program* program;  breve_world* world;
 *     breve_runtime_create(NULL, &runtime);
 *     breve_program_compile(runtime, "hello.tz", text, size, &program);
 *     breve_world_create(runtime, program, NULL, &world);
 *     while (!breve_world_ended(world) && breve_world_step(world) == BREVE_OK) draw(world);
 *
 * A runtime is what the host provides: memory, callbacks, modules. A program is a set of compiled classes; it never
 * changes. A world is one running simulation of a program. An object is one instance in a world. There is no global
 * initialisation, and no state outside these that a result could depend on. Two runtimes in one process share nothing
 * but the worker threads of oneTBB, which are started when a world first asks for them (breve_world_set_workers) and
 * belong to the process; the arenas that hand them tasks belong to the runtime.
 *
 * Rules that hold for every function, unless its comment says otherwise:
 * - Errors are values. A function that can fail returns a breve_status. Results go through out-parameters, which are
 *   written only on BREVE_OK. The text of an error is in breve_world_last_error or breve_runtime_last_error. The
 *   library never aborts, prints or exits.
 * - A NULL handle, NULL text or NULL out-parameter gives BREVE_ERROR_ARGUMENT; a function that returns its result
 *   directly returns 0, false or NULL. Numbers that are NaN or infinite where a finite one is needed give
 *   BREVE_ERROR_ARGUMENT.
 * - An id of an object that no longer exists gives BREVE_ERROR_STALE; it never names another object, whatever is
 *   restored. So does an id of another world of the same runtime. An id of a world of another runtime is not
 *   recognised: two runtimes may use the same ids, and such an id may name an object of this world. The null object,
 *   where a live one is needed, gives BREVE_ERROR_ARGUMENT.
 * - Any function may run out of memory and return BREVE_ERROR_MEMORY. Any function that reads or changes joints,
 *   springs or the energy of bodies may return BREVE_ERROR_SCRIPT if their state cannot be computed because numbers
 *   overflow.
 * - A pointer of a script (BREVE_TYPE_POINTER) can be read, but not passed in: that gives BREVE_ERROR_UNSUPPORTED.
 * - Texts are UTF-8 or plain bytes, terminated by a zero byte; a text that is given with a size may contain zero bytes.
 * - Threads: a world, with all its objects, is used by one thread at a time; so is a runtime while it compiles or
 *   creates a world. A program may be used by any number of threads. Different worlds may be used by different threads;
 *   the runtime's callbacks are then called by those threads.
 * - Functions marked "Runs script" may call the callbacks of the runtime. A callback may call any function of this
 *   header; a function that cannot work inside a running script says so and returns BREVE_ERROR_BUSY there.
 * - Fields that hold an enumerator are uint32_t; their comment names the enumeration.
 * - Structs that begin with struct_size may grow: later headers append fields. Their initialisers, breve_X_default, are
 *   compiled into the host, so that struct_size states how much of the struct the host knows. A function never reads or
 *   writes beyond it; fields that the host does not know have their defaults, and a setter leaves them unchanged. A
 *   host runs with the library of its header or a later one: a struct_size that is larger than the library's gives
 *   BREVE_ERROR_ARGUMENT. All other structs and all enumerators are frozen: they do not change as long as BREVE_ABI
 *   stays the same. BREVE_ABI rises with every change that would break a host that is not recompiled;
 *   breve_runtime_create compares it.
 * - Names: the thing comes first, then what is done to it. breve_THING_PROPERTY reads a property and
 *   breve_THING_set_PROPERTY writes it; a plural denotes a list, and _count belongs to functions that take an index.
 *   _get, _set and _size are for items that are accessed by name, key or index: variables, lists, hashes. _read copies
 *   many items at once to memory of the host, or into a handle of it (breve_list_read, breve_scene_read). _create and
 *   _destroy are for handles; objects are also created by _create, but freed by _free, as `free` does in scripts.
 *   _queue_ is for input, which waits for the next iteration. A struct that describes an object to be created is called
 *   breve_THING_description if other structs say more about a THING (joints: breve_drive, breve_joint_info), else
 *   breve_THING, as breve_spring and breve_geometry.
 * - Functions that return a breve_value take a `world` that is not const even if they change nothing of the simulation:
 *   the world keeps the table of the lists and hashes that a host refers to (breve_ref), and puts a zero byte behind
 *   strings.
 * - Units: lengths, masses and angles are the program's own (length units, kg, rad); times are simulated seconds.
 */
#ifndef BREVE_BREVE_H
#define BREVE_BREVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(BREVE_SHARED)
#ifdef BREVE_BUILDING
#define BREVE_API __declspec(dllexport)
#else
#define BREVE_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define BREVE_API __attribute__((visibility("default")))
#else
#define BREVE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* For the initialisers below: sets all bytes to 0, including the padding between fields. */
static inline void breve_clear(void* bytes, size_t size) {
  size_t i;
  for (i = 0; i < size; ++i) ((unsigned char*)bytes)[i] = 0;
}

/* ---- versions ---------------------------------------------------------------------------------------------------- */

/* Number of the binary interface that this header describes. A library with a different number is incompatible. */
#define BREVE_ABI 4

/* "major.minor.patch" of the library. Never NULL. */
BREVE_API const char* breve_version(void);

/* BREVE_ABI of the library, to compare with the one of the header. */
BREVE_API uint32_t breve_abi(void);

/* ---- statuses ---------------------------------------------------------------------------------------------------- */

typedef enum breve_status {
  BREVE_OK = 0,
  BREVE_ERROR_ARGUMENT = 1,     /* a value that the function cannot accept: NULL, NaN, a wrong struct_size */
  BREVE_ERROR_STALE = 2,        /* an id or reference of something that no longer exists */
  BREVE_ERROR_BUSY = 3,         /* may not be called while a script of that world runs */
  BREVE_ERROR_MEMORY = 4,       /* the world's memory limit was reached, or the allocator returned NULL */
  BREVE_ERROR_SCRIPT = 5,       /* a run-time error in a script */
  BREVE_ERROR_COMPILE = 6,      /* a program that does not compile: see breve_runtime_diagnostic */
  BREVE_ERROR_BUDGET = 7,       /* a call or an iteration that used up its budget */
  BREVE_ERROR_DEPTH = 8,        /* calls nested beyond the depth limit */
  BREVE_ERROR_IMAGE = 9,        /* a snapshot that is damaged, or of another program or version */
  BREVE_ERROR_FILE = 10,        /* a module or file that cannot be found or read */
  BREVE_ERROR_UNSUPPORTED = 11, /* something that this build cannot do */
  BREVE_ERROR_NOT_FOUND = 12,   /* no class, method, keyword, variable, element or key with that name */
  BREVE_ERROR_TYPE = 13,        /* a value that does not convert to the required type */
  BREVE_ERROR_NO_BODY = 14,     /* an object without a position in space, such as the controller, was asked for its
                                   pose */
  BREVE_ERROR_INTERNAL = 15,    /* a defect of the library itself; please report it */
  BREVE_ERROR_INTERRUPTED = 16, /* breve_world_interrupt stopped the call */
  BREVE_ERROR_RELOAD = 17       /* a program that cannot replace the running one */
} breve_status;

/* "BREVE_ERROR_STALE" and so on; "BREVE_ERROR_INTERNAL" for a number that is not a status. Never NULL. */
BREVE_API const char* breve_status_name(breve_status status);

/* ---- handles and ids --------------------------------------------------------------------------------------------- */

typedef struct breve_runtime breve_runtime;
typedef struct breve_program breve_program;
typedef struct breve_world breve_world;

/* One instance in a world. All zero is the null object. Compare both fields to compare objects. Each world of a runtime
   starts its generations at a different number, the first one at 1. Worlds of different runtimes may use the same
   ids. */
typedef struct breve_object {
  uint32_t index, generation;
} breve_object;

/* A list or hash that a breve_value refers to; valid until script runs in its world again (see breve_value). */
typedef struct breve_ref {
  uint32_t index, epoch;
} breve_ref;

/* A method name with its keywords, prepared by breve_world_prepare; valid for the lifetime of that world. */
typedef struct breve_selector {
  uint32_t index, generation;
} breve_selector;

/* ---- errors ------------------------------------------------------------------------------------------------------ */

/* One active method when an error occurred. Texts are never NULL. */
typedef struct breve_frame {
  const char* class_name; /* class of the receiver */
  const char* method;
  const char* file;      /* of the code that was running in it, or "" */
  uint32_t line, column; /* of that code, from 1; 0 if not known. The position of the caller is in the next frame */
  const char* receiver;  /* the object, in a few words: "Bird 0xc", with the number that `print` shows */
  const char* arguments; /* each keyword with the value that its parameter had then: "target (3, 0, 1) weight 2"; long
                            values are truncated. Both texts are "" in the middle of a deep recursion, and if memory ran
                            out */
} breve_frame;

/* The last error of a world or runtime. Everything in it is owned by that world or runtime until its next call. */
typedef struct breve_error {
  uint32_t status;       /* breve_status */
  const char* message;   /* what is wrong, one line or more; never NULL */
  const char* help;      /* what to do, or "" if the message is sufficient; never NULL */
  const char* file;      /* the script file, or "" if the error has no position in a file */
  uint32_t line, column; /* from 1; 0 if not known */
  uint32_t length;       /* bytes from there on that the error is about */
  size_t frame_count;
  const breve_frame* frames; /* the call chain, innermost call first; NULL if frame_count is 0 */
  const char* text;          /* all of the above, formatted for people to read; ends with a newline */
} breve_error;

/* ---- runtime ----------------------------------------------------------------------------------------------------- */

/* The kind of a text that a world prints. */
typedef enum breve_channel {
  BREVE_CHANNEL_PRINT = 0,   /* a script's own output, exactly as written */
  BREVE_CHANNEL_WARNING = 1, /* whole lines: something doubtful; the run continues as usual */
  BREVE_CHANNEL_ERROR = 2    /* whole lines: a run-time error in a script's callback, which was abandoned; the run
                                continues */
} breve_channel;

/* @param user   breve_runtime_config.user
   @param world  the world that prints; it is usable, even while breve_world_create has not returned it yet
   @param text   `size` bytes, followed by a zero byte; owned by the library until the function returns */
typedef void (*breve_print_fn)(void* user, breve_world* world, breve_channel channel, const char* text, size_t size);

/* Returns memory of `size` bytes aligned to `alignment` (a power of two), or NULL: the call in progress then fails with
   BREVE_ERROR_MEMORY. All memory that a world keeps is allocated here, by the thread that uses the world; while that
   thread computes physics with several workers (breve_world_set_workers), by any of these, one at a time. Programs and
   runtimes, which do not belong to a world, and texts that live for one call use the C++ allocator; if that runs out of
   memory, the call also returns BREVE_ERROR_MEMORY. See docs/limits.md. */
typedef void* (*breve_allocate_fn)(void* user, size_t size, size_t alignment);

/* Releases memory of breve_allocate_fn, with the same size and alignment. */
typedef void (*breve_release_fn)(void* user, void* memory, size_t size, size_t alignment);

/* The text of a module, provided by the host. */
typedef struct breve_module {
  const char* name; /* as messages show it; each name is loaded once. NULL: the requested name */
  const char* text; /* not NULL unless size is 0 */
  size_t size;
  void* cookie; /* the host's own, for breve_release_module_fn */
} breve_module;

/* Finds the module that a directive names: "Boids.tz" for `@use Boids.`, the name as written for `@include`. The
   classes of the class library are always available; if the host finds a module with the same name, that module is used
   instead.
   @param from    name of the file that contains the directive; "" for the file given to breve_program_load
   @param module  zeroed; to be filled in
   Returns false if there is no such module; that is an error only if there is no library class of that name either. */
typedef bool (*breve_resolve_module_fn)(void* user, const char* name, const char* from, breve_module* module);

/* The library has copied the module, and the host may free it. Called once for each module that was resolved. */
typedef void (*breve_release_module_fn)(void* user, const breve_module* module);

/* A program contains `@path "directory".`, or the library was asked to search there. */
typedef void (*breve_add_path_fn)(void* user, const char* directory);

/* For callbacks that return bytes: call it with `sink` as often as needed; the pieces are concatenated. */
typedef void (*breve_write_fn)(void* sink, const char* bytes, size_t size);

/* A file that a host has opened for a script. The functions get `handle`; they must not call the library. Frozen: it
   never grows. */
typedef struct breve_file {
  void* handle;
  /* For a file opened for reading: reads up to `size` bytes and stores the number read; 0 is the end of the file.
     Returns false if reading fails. */
  bool (*read)(void* handle, void* bytes, size_t size, size_t* got);
  /* For a file opened for writing: writes all the bytes. Returns false if not all could be written. */
  bool (*write)(void* handle, const void* bytes, size_t size);
  /* Called once, as the last call. `keep` is false if writing failed: the written data should then be discarded.
     Returns false if the data could not be kept. NULL: nothing to do. */
  bool (*close)(void* handle, bool keep);
  const char* path; /* the result of `findFile` in the script; copied at once. NULL: the name as written */
} breve_file;

/* Opens the file that a script names (text, image, mesh, archive), with the name exactly as the script writes it.
   @param file    zeroed; to be filled in
   @param reason  to refuse a file that may exist, call it with `sink` and the reason, worded as the end of a sentence
   Returns false if the file is not opened; without a reason this means that the file does not exist. */
typedef bool (*breve_open_for_reading_fn)(void* user, breve_world* world, const char* name, breve_file* file,
                                          breve_write_fn reason, void* sink);

/* The same for a file to be written. @param append  keep the contents; otherwise they are replaced when it is closed */
typedef bool (*breve_open_for_writing_fn)(void* user, breve_world* world, const char* name, bool append,
                                          breve_file* file, breve_write_fn reason, void* sink);

/* The files that the scripts of a runtime may access. All zero: none. Frozen: it never grows. */
typedef struct breve_files {
  void* user;                                 /* passed to the callbacks */
  breve_open_for_reading_fn open_for_reading; /* NULL: none is read */
  breve_open_for_writing_fn open_for_writing; /* NULL: none is written */
  /* A runtime calls `retain` when it is created, and `release` when neither it nor its programs and worlds can use the
     callbacks any more. NULL: nothing to do. */
  void (*retain)(void* user);
  void (*release)(void* user);
} breve_files;

/* Other resources outside the world that scripts may use, for breve_runtime_config.rights. See docs/sandbox.md. */
typedef enum breve_right {
  BREVE_RIGHT_SLEEP = 1,     /* `sleep` blocks the thread */
  BREVE_RIGHT_REAL_TIME = 2, /* the real-time clock: `getRealTime`, `getRunningTime` */
  BREVE_RIGHT_ENTROPY = 4    /* a seed from the operating system: `randomSeedFromDevRandom` */
} breve_right;

/* Runs a shell command for a script (`system`), and passes its output to `write`. Returns false if it could not be
   run. */
typedef bool (*breve_system_fn)(void* user, breve_world* world, const char* command, breve_write_fn write, void* sink);

/* A request that a server has received. Texts are never NULL, and everything stays valid until it is answered. Frozen:
   it never grows. */
typedef struct breve_request {
  const char* method; /* "GET", "POST" or "PUT" */
  const char* target; /* what the peer asks for, as it was sent: "/move_1_2" */
  const char* from;   /* address of the peer */
  const void* body;
  size_t body_size;
} breve_request;

/* What a world answers; valid during the call. Frozen: it never grows. */
typedef struct breve_response {
  uint32_t status;  /* of HTTP: 200, 404 ... */
  const char* type; /* of the body: "text/html; charset=utf-8" */
  const void* body;
  size_t body_size;
} breve_response;

/* A server that a host has opened for a script. The functions get `handle`, are called by the thread that steps the
   world, and must not call the library. Frozen: it never grows. */
typedef struct breve_server {
  void* handle;
  /* Fills in the first request that waits. Returns false if none does; it does not wait for one. */
  bool (*next)(void* handle, breve_request* request);
  /* Answers the request that `next` gave last. */
  void (*answer)(void* handle, const breve_response* response);
  void (*close)(void* handle); /* called once, as the last call. NULL: nothing to do */
  const char* url;             /* where peers find it: "http://127.0.0.1:8080"; copied at once */
} breve_server;

/* The network that the scripts of a runtime may use. All zero: none. Frozen: it never grows. */
typedef struct breve_network {
  void* user; /* passed to the callbacks */
  /* Opens a server for a script (NetworkServer). NULL: none is opened.
     @param port    0: any that is free
     @param server  zeroed; to be filled in
     @param reason  to say why it is not opened, call it with `sink` and the reason, worded as the end of a sentence
     Returns false if it is not opened. */
  bool (*listen)(void* user, breve_world* world, uint32_t port, breve_server* server, breve_write_fn reason,
                 void* sink);
  /* Sends a request for a script (URL, `send-over-network`) and waits for the answer. NULL: none is sent.
     @param method  "GET", "POST" or "PUT"
     @param write   passes on the body of the answer, or the reason why there is none, worded as the end of a sentence
     Returns false if there is no answer. */
  bool (*fetch)(void* user, breve_world* world, const char* method, const char* url, const void* body, size_t size,
                breve_write_fn write, void* sink);
  /* A runtime calls `retain` when it is created, and `release` when neither it nor its programs and worlds can use the
     callbacks any more. NULL: nothing to do. */
  void (*retain)(void* user);
  void (*release)(void* user);
} breve_network;

/* The entry of a plugin: it adds the plugin's functions and classes with breve_runtime_add_function and
   breve_runtime_add_class. It is called while a program is compiled and can add nothing else. See plugin.h.
   @param abi  breve_abi() of the library; BREVE_PLUGIN compares it with the one of the header
   Returns BREVE_OK. Any other status refuses the plugin; the message is that of the failed call on `runtime`. */
typedef breve_status (*breve_plugin_fn)(breve_runtime* runtime, uint32_t abi);

/* A plugin that a host has opened. Frozen: it never grows. */
typedef struct breve_plugin {
  breve_plugin_fn entry;
  void* library;                /* the host's own, for `close` */
  void (*close)(void* library); /* called once, when the runtime and all its programs and worlds are gone, so that
                                   nothing of the plugin can be called any more. NULL: nothing to do */
} breve_plugin;

/* Opens the plugin that a program names: `@plugin "file"(entry).` Called once for each pair of file and entry that the
   programs of a runtime name. breve_plugin_open opens a shared library.
   @param from    name of the file that contains the directive
   @param plugin  zeroed; to be filled in
   @param reason  to say why the plugin is not opened, call it with `sink` and the reason, worded as the end of a
                  sentence
   Returns false if the plugin is not opened: the program does not compile. */
typedef bool (*breve_open_plugin_fn)(void* user, const char* file, const char* entry, const char* from,
                                     breve_plugin* plugin, breve_write_fn reason, void* sink);

typedef struct breve_runtime_config {
  size_t struct_size;         /* set by breve_runtime_config_default */
  void* user;                 /* passed to every callback. Default NULL */
  breve_allocate_fn allocate; /* memory of worlds; NULL, with `release` NULL: the C++ allocator. Default NULL */
  breve_release_fn release;   /* both or neither. Default NULL */
  breve_print_fn print;       /* output, warnings, errors that did not stop the run; NULL: discarded. Default NULL */
  breve_resolve_module_fn resolve_module; /* NULL: only the class library. Default NULL */
  breve_release_module_fn release_module; /* NULL: modules need no release. Default NULL */
  breve_add_path_fn add_path;             /* NULL: @path has no effect. Default NULL */
  breve_files files;                      /* the files that scripts may access. Default: none */
  breve_system_fn system;                 /* NULL: running a command is an error in the script. Default NULL */
  uint32_t worker_threads;                /* reserved: must be 0. Default 0 */
  uint32_t rights;                        /* sum of breve_right. Default 0 */
  breve_open_plugin_fn open_plugin;       /* NULL: @plugin is an error of the program. Default NULL */
  breve_network network;                  /* the network that scripts may use. Default: none */
} breve_runtime_config;

/* The defaults named above. */
static inline breve_runtime_config breve_runtime_config_default(void) {
  breve_runtime_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  return config;
}

/* Implements breve_runtime_create, with the same results.
   @param abi  BREVE_ABI of the header that the host was compiled with
   BREVE_OK; BREVE_ERROR_ARGUMENT; BREVE_ERROR_UNSUPPORTED: the library has a different one. */
BREVE_API breve_status breve_runtime_create_for(uint32_t abi, const breve_runtime_config* config,
                                                breve_runtime** runtime);

/* Creates a runtime. Runs no script and calls no callback.
   @param config  copied; NULL: the defaults
   @param runtime to be released with breve_runtime_destroy
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, allocate without release or release without allocate, an unknown
   right, a reserved field that is not 0. BREVE_ERROR_UNSUPPORTED: the library's BREVE_ABI differs from this
   header's. */
static inline breve_status breve_runtime_create(const breve_runtime_config* config, breve_runtime** runtime) {
  return breve_runtime_create_for(BREVE_ABI, config, runtime);
}

/* Adds callbacks for breve_runtime_config.files that let scripts read, and optionally write, the files below a
   directory. Scripts name a file by its path from there, with '/'. Absolute paths, '..', symbolic links, files that are
   not regular and files beyond a size are refused; nothing else in the file system can be reached, even if directories
   are moved in the meantime. A written file gets its name when it is closed and replaces an older file; appended data
   is written at once. Directories are not created.
   @param directory  must exist. It is opened now and stays open until the files are released
   @param may_write  if false, nothing below it can be written
   @param most_bytes limit for reading or writing one file; 0: 256 MiB
   @param files      all zero, or filled by an earlier call: this directory is then searched after the earlier ones
   BREVE_OK; BREVE_ERROR_ARGUMENT: NULL, or `files` has callbacks of another origin; BREVE_ERROR_FILE: the directory
   does not exist; BREVE_ERROR_MEMORY. After an error `files` is unchanged. */
BREVE_API breve_status breve_files_add_directory(const char* directory, bool may_write, uint64_t most_bytes,
                                                 breve_files* files);

/* Releases `files` after the host has created its runtimes with it, or if it is not needed.
   @param files  of breve_files_add_directory; all zero afterwards
   BREVE_OK, also for NULL. */
BREVE_API breve_status breve_files_release(breve_files* files);

/* What breve_network_open allows. */
typedef struct breve_network_config {
  size_t struct_size;  /* set by breve_network_config_default */
  const char* address; /* numeric, on which servers listen; NULL: "127.0.0.1", this machine only. Default NULL */
  double timeout; /* s of real time, above 0 and at most 3600, that a peer may take to send a request or an answer, and
                     a world to answer a request: it gets status 503 then. Default 10 */
  uint64_t most_bytes; /* of a request or an answer, at least 1. Default 1 MiB */
  bool remote;         /* scripts may send requests to other machines. Default false: to this one only */
  bool reserved[7];    /* must be false. Default false */
} breve_network_config;

/* The defaults named above. */
static inline breve_network_config breve_network_config_default(void) {
  breve_network_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  config.timeout = 10;
  config.most_bytes = 1048576;
  return config;
}

/* Makes callbacks for breve_runtime_config.network that speak HTTP. Servers receive requests in threads of their own; a
   world answers them between its iterations, in the thread that steps it.
   @param config   copied; NULL: the defaults
   @param network  overwritten; to be released with breve_network_release
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, a number out of range, an address that is not numeric, a
   reserved field that is true; BREVE_ERROR_UNSUPPORTED: the library was built without the network. */
BREVE_API breve_status breve_network_open(const breve_network_config* config, breve_network* network);

/* Releases `network` after the host has created its runtimes with it, or if it is not needed.
   @param network  of breve_network_open; all zero afterwards
   BREVE_OK, also for NULL. */
BREVE_API breve_status breve_network_release(breve_network* network);

/* Releases the host's handle of a runtime. Programs and worlds made with it remain valid, with its callbacks, until
   they are destroyed. BREVE_OK, also for NULL; BREVE_ERROR_BUSY from a callback of a compilation or of
   breve_world_create on it. */
BREVE_API breve_status breve_runtime_destroy(breve_runtime* runtime);

/* The error of the last failed call on this runtime (runtime, program and world creation); NULL if no call failed. */
BREVE_API const breve_error* breve_runtime_last_error(const breve_runtime* runtime);

/* ---- program ----------------------------------------------------------------------------------------------------- */

/* Compiles the module `name`, which the runtime's resolve_module provides, and everything that it loads. Runs no
   script.
   @param program to be released with breve_program_destroy
   BREVE_OK, perhaps with warnings: see breve_runtime_diagnostic; BREVE_ERROR_FILE: no such module; BREVE_ERROR_COMPILE:
   the diagnostics list all errors; BREVE_ERROR_BUSY from a callback of another compilation. */
BREVE_API breve_status breve_program_load(breve_runtime* runtime, const char* name, breve_program** program);

/* Compiles a program given as text, and everything that it loads. Otherwise like breve_program_load.
   @param name  as messages show it
   @param text  `size` bytes, copied; NULL only if size is 0 */
BREVE_API breve_status breve_program_compile(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                             breve_program** program);

/* Releases the host's handle of a program; does nothing for NULL. Its worlds remain valid. */
BREVE_API void breve_program_destroy(breve_program* program);

typedef enum breve_severity {
  BREVE_SEVERITY_ERROR = 0,
  BREVE_SEVERITY_WARNING = 1,
  BREVE_SEVERITY_NOTE = 2
} breve_severity;

/* One message of the compiler. Owned by the runtime until it compiles again. */
typedef struct breve_diagnostic {
  uint32_t severity;     /* breve_severity */
  const char* code;      /* stable, for machines: "unknown-variable" */
  const char* message;   /* what is wrong */
  const char* help;      /* what to do, or "" */
  const char* file;      /* "" if it has no position */
  uint32_t line, column; /* from 1, column in bytes; 0 if it has no position */
  uint32_t length;       /* bytes from there on that the message is about */
  const char* text;      /* all of the above with the source line and a caret, for people; ends with a newline */
} breve_diagnostic;

/* The number of diagnostics of the last compilation on this runtime, whether it succeeded or not. */
BREVE_API size_t breve_runtime_diagnostic_count(const breve_runtime* runtime);

/* The diagnostic at `index`, in order of files and positions; the files are in order of loading.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_runtime_diagnostic(const breve_runtime* runtime, size_t index,
                                                breve_diagnostic* diagnostic);

/* A lint: a check for code that is legal but doubtful. It can be turned off. Texts live as long as the process. */
typedef struct breve_lint_info {
  const char* code;    /* breve_diagnostic.code: "lint-unused-variable" */
  uint32_t severity;   /* breve_severity. WARNING: most likely a mistake; NOTE: may deserve a look */
  const char* summary; /* one line: what it finds */
} breve_lint_info;

/* The number of lints that the compiler has. */
BREVE_API size_t breve_lint_count(void);

/* The lint at `index`, in order of their codes. BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_lint(size_t index, breve_lint_info* lint);

/* Turns a lint off for later compilations on this runtime. In a program a comment does the same: `# allow:
   lint-unused-variable` after a statement or on the line before it, or, for a whole file, at its beginning.
   BREVE_OK, also if it was off before; BREVE_ERROR_NOT_FOUND: there is no such lint. */
BREVE_API breve_status breve_runtime_allow_lint(breve_runtime* runtime, const char* code);

/* A class of a program. Texts are owned by the program. */
typedef struct breve_class_info {
  const char* name;
  const char* alias;  /* "" if it has none */
  const char* parent; /* name, or "" for a root class */
} breve_class_info;

/* The number of classes of a program, including those of the class library that it uses. */
BREVE_API size_t breve_program_class_count(const breve_program* program);

/* The class at `index`; parents come before their descendants.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_program_class(const breve_program* program, size_t index, breve_class_info* info);

/* ---- world ------------------------------------------------------------------------------------------------------- */

/* The kind of a node of a profile and of an event of a trace. See "profiles". */
typedef enum breve_profile_kind {
  BREVE_PROFILE_WORLD = 0,    /* the root: everything that the world did */
  BREVE_PROFILE_STAGE = 1,    /* the world itself: "iteration" and its parts, such as "script", "motion", "rotation",
                                 "collision", "neighbors", "schedule", "notifications", "input"; "garbage" */
  BREVE_PROFILE_METHOD = 2,   /* a method written in steve */
  BREVE_PROFILE_NATIVE = 3,   /* a method of the class library that is implemented in C++ */
  BREVE_PROFILE_FUNCTION = 4, /* a function, such as sqrt */
  BREVE_PROFILE_ACT = 5       /* "new" and "free", of a class; "sort"; "print" */
} breve_profile_kind;

/* Something begins or ends. Texts are never NULL and are valid until the function returns. */
typedef struct breve_trace_event {
  bool begins;            /* false: it ends, perhaps by an error; it is the last one that began and has not ended */
  uint32_t kind;          /* breve_profile_kind */
  double seconds;         /* wall time since the profile started, minus the time spent in the breve_trace_fn */
  const char* class_name; /* the class of the method or of the operation; "" if there is none */
  const char* name;       /* method, function, operation or stage */
  const char* file;       /* where the method is declared; "" for anything else */
  uint32_t line;          /* of the declaration; 0 for anything else */
  uint32_t call_line;     /* of the call, in the calling method's file; 0 if it was not called by a script */
  uint64_t iteration;     /* breve_world_iteration at that time */
} breve_trace_event;

/* Called at each begin and end while a profile with a trace runs. It may call functions that do not run script;
   functions that do return BREVE_ERROR_BUSY for this world. */
typedef void (*breve_trace_fn)(void* user, const breve_trace_event* event);

/* A variable of the controller, and the text of the value that it gets before the controller's `init` runs: an int, a
   float, a vector written as (x, y, z), or any text for a string. */
typedef struct breve_setting {
  const char* name;
  const char* value;
} breve_setting;

typedef struct breve_world_config {
  size_t struct_size;           /* set by breve_world_config_default */
  uint64_t seed;                /* of the world's random generator: any number. Default 1 */
  const char* const* arguments; /* what scripts read as arguments, copied; [0] is the program's name. Default NULL */
  size_t argument_count;        /* 0 if arguments is NULL. Default 0 */
  size_t memory_limit;          /* bytes that the world may take from the runtime's allocator; 0: no limit. Beyond it:
                                   BREVE_ERROR_MEMORY, and the world stays usable. Default 0 */
  uint64_t budget;              /* loop iterations and calls (see "budgets" below) in one iteration, or in one call by
                                   the host outside of an iteration; 0: no limit. Beyond it: BREVE_ERROR_BUDGET. Default
                                   0 */
  uint32_t depth_limit;         /* nested calls; 0: the default of 5000. Beyond it: BREVE_ERROR_DEPTH */
  uint32_t advance_limit;       /* iterations that one breve_world_advance may run; the remaining time is then
                                   discarded; 0: no limit. Default 0 */
  double iteration_step;        /* s, the exact duration of each iteration; set after the controller's init; 0: as the
                                   script sets it. Default 0 */
  double integration_step;      /* s, the longest sub-step: an iteration is divided into the smallest number of equal
                                   sub-steps that are not longer. Set after the controller's init; 0: as the script sets
                                   it. Default 0 */
  bool strict;                  /* doubtful operations that give warnings become errors. Default false */
  bool verbose;                 /* more messages: one for each obsolete method that is used. Default false */
  bool coarse_random;           /* random[] of floats and vectors draws from 32,768 values, as programs written for the
                                   original breve expect. Default false */
  bool profile;                 /* start a profile before anything runs, like breve_world_profile_start with `trace` and
                                   `trace_user` below. Default false */
  bool reserved[4];             /* must be false */
  void* user;                   /* the host's own, for breve_world_user. Default NULL */
  uint64_t call_budget;         /* the same for each call that the world makes within an iteration; 0: no limit. Beyond
                                   it only that call is abandoned. Default 0 */
  uint32_t nesting_limit;       /* nesting depth of host calls in callbacks of host calls: at most 200; 0: the default
                                   of 64. Beyond it: BREVE_ERROR_DEPTH */
  uint32_t dimension;           /* 2: the world is flat (z = 0, rotations about z) from before the controller's init; 3:
                                   it is not, and a PlanarControl is an error; 0: the controller decides. Default 0 */
  breve_trace_fn trace;         /* for `profile`; NULL: no events. Default NULL */
  void* trace_user;             /* Default NULL */
  const char* accuracy;         /* rung of the accuracy ladder, a name for breve_rung_find; copied. It is set before the
                                   controller's init, and single settings that init makes stay. If init chooses another
                                   rung, this one is set again after it, and a warning says so if init made settings of
                                   the other one. NULL: as the script sets it. Default NULL */
  double length_unit;           /* m, about the size of the bodies, set after the controller's init: thresholds of lengths
                                   and speeds are multiples of it, and in a flat world sizes of 0.1 to 10 units are best;
                                   from 1e-9 to 1e9; 0: as the script sets it. Default 0 */
  const breve_setting* settings; /* copied; NULL: none. BREVE_ERROR_ARGUMENT if the controller has no variable of that
                                    name, or if the text is not a value of its type. Default NULL */
  size_t setting_count;          /* 0 if settings is NULL. Default 0 */
  double patience;               /* s of real time: if one iteration, or one call by the host, takes longer, this is
                                    reported once on BREVE_CHANNEL_WARNING with the current position in the script; 0:
                                    never. Default 0 */
  uint64_t physics_budget;       /* work of the physics of one iteration, see "budgets" below; 0: 1,000,000 or `budget`,
                                    whichever is more, and no limit if `budget` is 0. Default 0 */
} breve_world_config;

/* Budgets. Each loop iteration, each call of a method or function and each new object counts 1, no matter who makes the
   call: sort, broadcasts, announcements, init and destroy, calls by name. An integration step of the world also counts
   1. An operation on much data counts as many loop iterations as take about the same time (docs/limits.md). Neither
   time nor instructions are counted, so that a call is cut off at the same place in every run, on every machine and in
   every build. The call that uses the last unit of the budget is still made; the next one is the error.
   - `budget` applies to a whole iteration, and to each function of this header that runs script outside of one. When it
     is used up, the call is abandoned as by a run-time error, the rest of the iteration is not run, and the function
     returns BREVE_ERROR_BUDGET. Calls that a callback makes count against the budget of the call that invoked the
     callback.
   - `call_budget` applies to each `iterate`, `post-iterate`, scheduled call, input or collision handler, and `destroy`
     of auto-free: an object that does not terminate does not prevent the others from running. An abandoned call is
     reported on BREVE_CHANNEL_ERROR and counted in breve_stats.errors; the iteration continues. A collision handler
     does not use up its controller's budget; a handler of announcements uses the announcer's. Scheduled calls may
     schedule calls: only `budget` limits an iteration.
   - `physics_budget` applies to the motion of bodies, in units that take about as long as a loop iteration;
     breve_physics_counters.work is the number of units that an iteration used. Exceeding it is not an error: bodies
     that used up their part of it are moved to the end of the iteration in one coarse step of rung `fast`, and the
     guard reports it ("finished coarsely"). A crowd for which even that would take too long gives BREVE_ERROR_BUDGET:
     more than 8,000 pairs that may touch, and more than one for each 125 units of the budget. */

/* The defaults named above. */
static inline breve_world_config breve_world_config_default(void) {
  breve_world_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  config.seed = 1;
  return config;
}

/* Creates a world of `program` and its controller, and runs the controller's `init`. Runs script.
   @param config  copied; NULL: the defaults
   @param world   to be released with breve_world_destroy
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, a step that is negative or not finite, a reserved field;
   BREVE_ERROR_SCRIPT, _BUDGET, _DEPTH, _INTERRUPTED, _MEMORY, or another status of a host function: `init` failed, and
   no world is created; see breve_runtime_last_error. */
BREVE_API breve_status breve_world_create(breve_runtime* runtime, const breve_program* program,
                                          const breve_world_config* config, breve_world** world);

/* Destroys a world and frees everything that it holds. Runs no script: no object's `destroy` is called.
   BREVE_OK, also for NULL; BREVE_ERROR_BUSY while a script of it runs, and for a world of a batch (breve_batch_run):
   nothing is destroyed then. */
BREVE_API breve_status breve_world_destroy(breve_world* world);

/* breve_world_config.user. */
BREVE_API void* breve_world_user(const breve_world* world);

/* The error of the last failed call on this world; NULL if no call failed. */
BREVE_API const breve_error* breve_world_last_error(const breve_world* world);

/* Runs one iteration: input, `iterate`, motion and collisions, `post-iterate`, scheduled calls. Runs script. Also steps
   a world that has ended or is paused: that decision is the host's.
   BREVE_OK; BREVE_ERROR_BUSY while a script of it runs; BREVE_ERROR_SCRIPT, _BUDGET, _DEPTH, _MEMORY: the failing call
   is abandoned and the rest of the iteration is not run; the world is consistent and may be stepped, snapshotted or
   destroyed (restore a snapshot to undo). */
BREVE_API breve_status breve_world_step(breve_world* world);

/* For a game loop: advances the world by `seconds` of simulated time. Runs as many whole iterations as fit, keeps the
   remainder for the next call, and stops when the program ends the simulation. Does nothing while the world is paused.
   Runs script.
   @param seconds   finite, >= 0
   @param fraction  may be NULL. How far the remainder reaches into the next iteration, in [0, 1): draw poses at pose
                    before the last iteration * (1 - fraction) + current pose * fraction
   Returns the same statuses as breve_world_step. After an error the time that was not run is discarded. */
BREVE_API breve_status breve_world_advance(breve_world* world, double seconds, double* fraction);

/* Simulated seconds since the start. */
BREVE_API double breve_world_time(const breve_world* world);

/* Iterations completed since the start; an iteration that an error ended early does not count. */
BREVE_API uint64_t breve_world_iteration(const breve_world* world);

/* Duration of one iteration, s. */
BREVE_API double breve_world_iteration_step(const breve_world* world);

/* Has the program ended the simulation? */
BREVE_API bool breve_world_ended(const breve_world* world);

/* Has the program or the host paused the simulation? See breve_world_advance. */
BREVE_API bool breve_world_paused(const breve_world* world);

/* Pauses or continues. */
BREVE_API breve_status breve_world_set_paused(breve_world* world, bool paused);

/* The seed that the world's generator was last seeded with. */
BREVE_API uint64_t breve_world_seed(const breve_world* world);

/* Draws a number from [0, 1] from the world's own generator, as a script would. This changes the rest of the run. */
BREVE_API breve_status breve_world_draw_random(breve_world* world, double* number);

/* ---- objects ----------------------------------------------------------------------------------------------------- */

/* The controller; null if the program freed it. */
BREVE_API breve_object breve_world_controller(const breve_world* world);

/* The live objects of a class and its descendants, in order of creation.
   @param class_name  name or alias; NULL: every object
   @param objects     room for `capacity` ids; NULL only if capacity is 0
   @param count       the total number, even if it exceeds capacity; at most capacity ids are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program has no such class. */
BREVE_API breve_status breve_world_objects(const breve_world* world, const char* class_name, breve_object* objects,
                                           size_t capacity, size_t* count);

/* Does the id name a live object? False for the null object. */
BREVE_API bool breve_object_alive(const breve_world* world, breve_object object);

/* The name of the object's class, owned by the program; NULL if the object is null or no longer exists. */
BREVE_API const char* breve_object_class(const breve_world* world, breve_object object);

/* Is the object an instance of `class_name` (name or alias) or of a descendant?
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program has no such class. */
BREVE_API breve_status breve_object_is_a(const breve_world* world, breve_object object, const char* class_name,
                                         bool* result);

/* Creates an object, as `new` does in a script. Runs script (`init`).
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such class; BREVE_ERROR_SCRIPT, _BUDGET, _DEPTH, _MEMORY: `init` failed. */
BREVE_API breve_status breve_object_create(breve_world* world, const char* class_name, breve_object* object);

/* Frees an object, as `free` does in a script. Runs script (`destroy`, `delete`).
   BREVE_OK; BREVE_ERROR_SCRIPT, _BUDGET, _DEPTH: a `destroy` or `delete` failed; the object is freed nevertheless. */
BREVE_API breve_status breve_object_free(breve_world* world, breve_object object);

typedef struct breve_pose {
  double location[3]; /* of the centre, world frame */
  double rotation[4]; /* unit quaternion (w, x, y, z): world = rotation * own frame */
} breve_pose;

/* The pose of an object. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_pose(const breve_world* world, breve_object object, breve_pose* pose);

/* Moves an object to a pose at once; a link takes its whole assembly along. The quaternion may have any length except
   0.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite, or a quaternion of length 0; nothing is changed;
   BREVE_ERROR_SCRIPT: the joints' state cannot be computed. */
BREVE_API breve_status breve_object_set_pose(breve_world* world, breve_object object, const breve_pose* pose);

/* Lets an object without physics reach a pose at the end of the next iteration: it moves there with constant velocity,
   pushes and carries the bodies with physics that it touches on the way, and then stops.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: as for breve_object_set_pose, or the object has physics. */
BREVE_API breve_status breve_object_set_target(breve_world* world, breve_object object, const breve_pose* pose);

/* The pose that breve_object_set_target or a script has set and that the object has not reached yet.
   @param moves  false: it has none
   @param pose   may be NULL; written only if it has one
   BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_target(const breve_world* world, breve_object object, bool* moves,
                                           breve_pose* pose);

/* Velocity of the centre, length units per second, world frame. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_velocity(const breve_world* world, breve_object object, double velocity[3]);

/* An object without physics that has a velocity, including a Stationary, pushes and carries bodies with physics.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite. */
BREVE_API breve_status breve_object_set_velocity(breve_world* world, breve_object object, const double velocity[3]);

/* Angular velocity, rad/s; for a kinematic object in its own frame. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_rotational_velocity(const breve_world* world, breve_object object,
                                                        double velocity[3]);

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite. */
BREVE_API breve_status breve_object_set_rotational_velocity(breve_world* world, breve_object object,
                                                            const double velocity[3]);

/* Red, green, blue and alpha, each from 0 to 1; alpha 0 is invisible. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_color(const breve_world* world, breve_object object, double rgba[4]);

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite. */
BREVE_API breve_status breve_object_set_color(breve_world* world, breve_object object, const double rgba[4]);

typedef enum breve_shape_kind {
  BREVE_SHAPE_SPHERE = 0,
  BREVE_SHAPE_BOX = 1,
  BREVE_SHAPE_CONVEX = 2,
  BREVE_SHAPE_MESH = 3,         /* triangles; they need be neither convex nor closed */
  BREVE_SHAPE_HEIGHT_FIELD = 4, /* ground: a grid of triangles, seen from above */
  BREVE_SHAPE_CYLINDER = 5,     /* exact; its polygons, for display, have 32 sides */
  BREVE_SHAPE_CAPSULE = 6       /* likewise: all points within a radius of a line segment */
} breve_shape_kind;

/* The shape that an object is drawn with, in its own frame around its centre. */
typedef struct breve_shape {
  uint32_t kind;  /* breve_shape_kind */
  double radius;  /* of the sphere around the centre that encloses the shape; a sphere's own radius */
  double size[3]; /* edges of the box around the centre, along the shape's axes, that encloses it; a box's own edges */
  size_t vertex_count; /* 0 for a sphere */
  size_t face_count;   /* polygons; 0 for a sphere */
  size_t index_count;  /* sum of the faces' vertices */
} breve_shape;

/* BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_shape(const breve_world* world, breve_object object, breve_shape* shape);

/* The vertices of the shape: x, y, z of each, in its own frame.
   @param vertices  room for 3 * `capacity` numbers; NULL only if capacity is 0. At most capacity vertices are written
   BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_shape_vertices(const breve_world* world, breve_object object, double* vertices,
                                                   size_t capacity);

/* The faces of the shape. Each is a convex polygon with its vertices counter-clockwise as seen from outside.
   @param sizes    number of vertices of each face; room for `face_capacity`, NULL only if that is 0
   @param indices  the vertices of one face after the other; room for `index_capacity`, NULL only if that is 0
   At most these numbers are written. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_shape_faces(const breve_world* world, breve_object object, uint32_t* sizes,
                                                size_t face_capacity, uint32_t* indices, size_t index_capacity);

/* ---- bodies ------------------------------------------------------------------------------------------------------ */

/* Rigid bodies, joints between them, springs, contacts. All of them are objects of the class library, whether a script
   or a host created them, so that both see the same ones: a script may drive a joint of the host, a host may read a
   joint of a script. If a host creates objects of a class, the class must be part of the program: `@use MultiBody.`
   includes links and joints, `@use Spring.` includes springs; breve_program_create_library includes everything.
   Functions of the sections from here to "values" that position, connect or change bodies cannot be used in force
   methods (BREVE_ERROR_SCRIPT there). See docs/physics.md for models, frames and sources. */

/* Creates a program that has no text of its own: the whole class library.
   @param controller  class of the controller: "PhysicalControl" or "Control"; NULL: "PhysicalControl"
   @param program     to be released with breve_program_destroy
   BREVE_OK; BREVE_ERROR_COMPILE: there is no such class; BREVE_ERROR_BUSY as for breve_program_compile. */
BREVE_API breve_status breve_program_create_library(breve_runtime* runtime, const char* controller,
                                                    breve_program** program);

/* A description of a shape. Only the fields of its kind are read. */
typedef struct breve_geometry {
  size_t struct_size;         /* set by breve_geometry_default */
  uint32_t kind;              /* breve_shape_kind. Default BREVE_SHAPE_SPHERE */
  uint32_t reserved;          /* must be 0 */
  double radius;              /* of a sphere, cylinder or capsule, > 0. Default 1 */
  double size[3];             /* edges of a box, each > 0. Default 1, 1, 1 */
  const double* vertices;     /* of a convex solid or a mesh: x, y, z of each vertex. Default NULL */
  size_t vertex_count;        /* Default 0 */
  const uint32_t* face_sizes; /* vertices of each face, 3 or more. A convex solid must contain the origin; its faces
                                 list their vertices in order around the face, in either direction. Faces of a mesh are
                                 counter-clockwise from outside: if they close a solid, that is the shape, otherwise the
                                 shape is a surface with two sides. Default NULL */
  size_t face_count;          /* Default 0 */
  const uint32_t* indices;    /* the vertices of one face after the other, as numbers of vertices. Default NULL */
  size_t index_count;         /* sum of face_sizes. Default 0 */
  const double* heights;      /* of a height field: `columns` values along x for each of `rows` along z; the ground
                                 below is solid. The origin is the middle of the grid at height 0. Default NULL */
  uint32_t columns, rows;     /* 2 to 4097. Default 0 */
  double tile;                /* edge of a cell, > 0. Default 1 */
  double density;             /* > 0; mass is density times volume. Default 1 */
  double height; /* of a cylinder about y, whose caps are at +-height/2 (in a flat world it is a disc about z); of a
                    capsule along y, the distance between the centres of its round ends; > 0. Default 1 */
} breve_geometry;

/* The defaults named above. */
static inline breve_geometry breve_geometry_default(void) {
  breve_geometry geometry;
  breve_clear(&geometry, sizeof geometry);
  geometry.struct_size = sizeof geometry;
  geometry.kind = BREVE_SHAPE_SPHERE;
  geometry.radius = 1;
  geometry.size[0] = geometry.size[1] = geometry.size[2] = 1;
  geometry.tile = 1;
  geometry.density = 1;
  geometry.height = 1;
  return geometry;
}

/* Creates a Shape object. Many bodies may use the same one. Runs script (`init`).
   BREVE_OK; BREVE_ERROR_ARGUMENT: a size or density that is not finite and > 0, faces that do not form a convex solid
   around the origin or a mesh, an index that is not below vertex_count, a height that is not finite; no object is
   created then; BREVE_ERROR_NOT_FOUND: the program does not use the class of such a shape. */
BREVE_API breve_status breve_shape_create(breve_world* world, const breve_geometry* geometry, breve_object* shape);

/* Gives a body its shape, for display and collisions, and the corresponding mass. Runs script (`set-shape`).
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_SCRIPT: the object is not a shape. */
BREVE_API breve_status breve_object_set_shape(breve_world* world, breve_object object, breve_object shape);

/* Do gravity, forces and contacts move a body? BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_physics(const breve_world* world, breve_object object, bool* enabled);

/* BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_set_physics(breve_world* world, breve_object object, bool enabled);

/* Mass of a body: density times volume of its shape. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_mass(const breve_world* world, breve_object object, double* mass);

/* Sets a force and a torque at the centre of mass, world frame, until they are replaced. NULL leaves the respective one
   unchanged. BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite; nothing is changed. */
BREVE_API breve_status breve_object_set_force(breve_world* world, breve_object object, const double force[3],
                                              const double torque[3]);

/* The force and torque that were set. @param force, torque  each may be NULL. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_force(const breve_world* world, breve_object object, double force[3],
                                          double torque[3]);

/* Coefficients of a body's surface, as set by set-friction and set-restitution. If both bodies of a pair have them, the
   pair uses the geometric mean of each friction coefficient and the maximum of each other coefficient. */
typedef struct breve_material {
  double static_friction, dynamic_friction; /* >= 0 */
  double restitution;                       /* along the normal, 0 to 1 */
  double tangential_restitution;            /* -1 to 1 */
  double threshold;                         /* m/s; approaches below this speed do not bounce. >= 0 */
} breve_material;

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: outside these ranges; nothing is changed. */
BREVE_API breve_status breve_object_set_material(breve_world* world, breve_object object,
                                                 const breve_material* material);

/* The surface of a body as breve_object_set_material, set-friction and set-restitution have set it. static_friction,
   dynamic_friction and restitution are -1 if they were not set; then set-mu and set-e decide.
   BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_material(const breve_world* world, breve_object object, breve_material* material);

/* Lets resting bodies sleep. Initially off. */
BREVE_API breve_status breve_world_set_sleeping(breve_world* world, bool on);

/* The value set by breve_world_set_sleeping. False for NULL. */
BREVE_API bool breve_world_sleeping(const breve_world* world);

/* Is a resting body asleep until something touches or changes it? BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_asleep(const breve_world* world, breve_object object, bool* asleep);

/* ---- joints and springs ------------------------------------------------------------------------------------------ */

typedef enum breve_joint_kind {
  BREVE_JOINT_REVOLUTE = 0,  /* rotates about the normal */
  BREVE_JOINT_PRISMATIC = 1, /* slides along the normal, initially from -2 to 2 */
  BREVE_JOINT_FIXED = 2,
  BREVE_JOINT_UNIVERSAL = 3, /* rotates about the normal (fixed in the parent) and parent_point x normal (in the
                                child) */
  BREVE_JOINT_BALL = 4       /* rotates about any axis; the middle angle stays within pi/2 - 0.35 */
} breve_joint_kind;

/* Which bodies a joint connects, and where. */
typedef struct breve_joint_description {
  size_t struct_size;     /* set by breve_joint_description_default */
  uint32_t kind;          /* breve_joint_kind */
  bool keep_rotation;     /* the child is moved, but not rotated. The part of its rotation that the joint can make is
                             the position where the joint starts, counted from `rotation`; the part that it cannot make
                             is added to `rotation`. Default false */
  bool reserved[3];       /* must be false */
  breve_object parent;    /* null: the world. Default null */
  breve_object child;     /* a body that can move */
  double parent_point[3]; /* in the parent's own frame, or the world's. Default 0 */
  double child_point[3];  /* in the child's own frame. Default 0 */
  double rotation[4];     /* quaternion (w, x, y, z) of any length except 0: at joint position zero the child's rotation
                             is the parent's times this. Default 1, 0, 0, 0 */
  double normal[3];       /* in the parent's own frame, of any length except 0; ignored for BREVE_JOINT_FIXED. Default
                             1, 0, 0 */
  double other_axis[3];   /* the second axis of BREVE_JOINT_UNIVERSAL, the third of BREVE_JOINT_BALL, at zero, in the
                             parent's own frame; its component along the normal is removed. Default 0: derived from
                             parent_point. Ignored for other kinds */
} breve_joint_description;

/* The defaults named above. */
static inline breve_joint_description breve_joint_description_default(breve_joint_kind kind) {
  breve_joint_description description;
  breve_clear(&description, sizeof description);
  description.struct_size = sizeof description;
  description.kind = kind;
  description.rotation[0] = 1;
  description.normal[0] = 1;
  return description;
}

/* Creates a joint: an object of class RevoluteJoint and so on. Both bodies get physics; the child, with everything
   attached to it, is moved so that the two points coincide. A joint between bodies that are already connected closes a
   loop and moves nothing. The two points of a joint never drift apart. Runs script (`init`).
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT:
   parent and child are the same, the child is a Stationary, or something is not finite or has length 0; no joint is
   created then. */
BREVE_API breve_status breve_joint_create(breve_world* world, const breve_joint_description* description,
                                          breve_object* joint);

/* Disconnects the joint; the joint object stays alive. Does nothing if the joint is not connected.
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a joint. */
BREVE_API breve_status breve_joint_break(breve_world* world, breve_object joint);

/* The state of a joint. Positions and velocities have one number for each axis (1, 1, 0, 2, 3 by kind), the rest is 0;
   they are positive when the parent rotates or moves along the axis relative to the child. */
typedef struct breve_joint_info {
  uint32_t kind; /* breve_joint_kind */
  bool linked;   /* if false, all of the following is zero */
  bool loop;     /* closes a loop: acts as a constraint */
  breve_object parent, child;
  double position[3]; /* rad or m; a revolute joint counts whole revolutions */
  double velocity[3]; /* rad/s or m/s */
  double force[3];    /* on the child, in the last sub-step, world frame, N */
  double torque[3];   /* on the child about the joint's point, world frame, N*m */
  double hard_limit;  /* the maximum for a motor: 500 times the child's mass */
} breve_joint_info;

/* BREVE_OK; BREVE_ERROR_TYPE: the object is not a joint. */
BREVE_API breve_status breve_joint_state(const breve_world* world, breve_object joint, breve_joint_info* info);

/* Motor, spring, damper and limits of a joint. Forces are N*m or N, positions rad or m, speeds rad/s or m/s. */
typedef struct breve_drive {
  size_t struct_size;     /* set by breve_drive_default */
  double motor_speed[3];  /* the motor's target, for each axis. Default 0 */
  double strength_limit;  /* the most that it uses to reach it, clamped to 0 .. hard_limit, reported once; 0: no motor.
                             Default 0 */
  double double_strength; /* 1/s, added to the motor's speed outside of double_min .. double_max. Default 0 */
  double double_min, double_max; /* Default 0 */
  double damping;                /* force per speed, >= 0. Default 0 */
  double stiffness;              /* of a spring in the joint, force per position, >= 0. Default 0 */
  double rest[3];                /* where that spring is relaxed. Default 0 */
  double force[3];               /* along the axes, until replaced. Default 0 */
  double low[3], high[3];        /* limits; -INFINITY and INFINITY: none. Default none, but see breve_joint_kind */
  double limit_restitution;      /* at the limits, 0 to 1. Default 0 */
} breve_drive;

/* All zero, to be filled in by breve_joint_drive. */
static inline breve_drive breve_drive_default(void) {
  breve_drive drive;
  breve_clear(&drive, sizeof drive);
  drive.struct_size = sizeof drive;
  return drive;
}

/* BREVE_OK; BREVE_ERROR_TYPE: the object is not a joint; BREVE_ERROR_ARGUMENT: it is not linked. */
BREVE_API breve_status breve_joint_drive(const breve_world* world, breve_object joint, breve_drive* drive);

/* As breve_joint_drive; BREVE_ERROR_ARGUMENT also for numbers outside these ranges; nothing is changed then. */
BREVE_API breve_status breve_joint_set_drive(breve_world* world, breve_object joint, const breve_drive* drive);

/* Sets the position and velocity of a joint; everything attached to the child moves along. NULL leaves the respective
   one unchanged. BREVE_OK; BREVE_ERROR_TYPE; BREVE_ERROR_ARGUMENT: not finite, not linked, or the joint closes a
   loop. */
BREVE_API breve_status breve_joint_set_state(breve_world* world, breve_object joint, const double position[3],
                                             const double velocity[3]);

/* The bodies of the assembly that contains this body, including itself, in order of creation.
   @param links  room for `capacity` ids; NULL only if capacity is 0
   @param count  the total number, even if it exceeds capacity; at most capacity ids are written
   BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_links(const breve_world* world, breve_object object, breve_object* links,
                                          size_t capacity, size_t* count);

/* The joints of this assembly, in order of creation. As breve_object_links. */
BREVE_API breve_status breve_object_joints(const breve_world* world, breve_object object, breve_object* joints,
                                           size_t capacity, size_t* count);

/* Moves the assembly of a body rigidly, so that the body gets this pose. breve_object_set_pose does the same in the
   course of the next step. As breve_object_set_pose. */
BREVE_API breve_status breve_object_set_assembly_pose(breve_world* world, breve_object object, const breve_pose* pose);

/* Do bodies of one assembly collide if no joint connects them directly? Initially off.
   BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_set_self_collisions(breve_world* world, breve_object object, bool on);

/* The value set by breve_object_set_self_collisions. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_self_collisions(const breve_world* world, breve_object object, bool* on);

/* An elastic connection of two bodies: strength (distance - length) + damping (rate of distance), positive pulling. */
typedef enum breve_spring_mode {
  BREVE_SPRING_BOTH = 0,
  BREVE_SPRING_EXPAND_ONLY = 1,  /* pushes, and is slack beyond its length */
  BREVE_SPRING_CONTRACT_ONLY = 2 /* pulls, and is slack below its length */
} breve_spring_mode;

/* The whole description of a spring; the current state is two numbers, which breve_spring_state returns. */
typedef struct breve_spring {
  size_t struct_size;                /* set by breve_spring_default */
  uint32_t mode;                     /* breve_spring_mode. Default BREVE_SPRING_BOTH */
  uint32_t reserved;                 /* must be 0 */
  breve_object from, to;             /* two bodies */
  double from_point[3], to_point[3]; /* in their own frames. Default 0 */
  double length;                     /* m, >= 0. Default 0 */
  double strength;                   /* N/m, >= 0. Default 100 */
  double damping;                    /* N*s/m, >= 0. Default 0.01 */
  double maximum_force;              /* N, in both directions; 0: no limit. Default 0 */
} breve_spring;

/* The defaults named above. */
static inline breve_spring breve_spring_default(void) {
  breve_spring spring;
  breve_clear(&spring, sizeof spring);
  spring.struct_size = sizeof spring;
  spring.strength = 100;
  spring.damping = 0.01;
  return spring;
}

/* Creates a spring: an object of class Spring. Runs script (`init`).
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: both
   ends are the same body, or a number is outside these ranges; no spring is created then. */
BREVE_API breve_status breve_spring_create(breve_world* world, const breve_spring* description, breve_object* spring);

/* Changes the numbers of a spring; its bodies and points stay the same. BREVE_OK; BREVE_ERROR_TYPE: the object is not a
   spring; BREVE_ERROR_ARGUMENT: outside these ranges; nothing is changed then. */
BREVE_API breve_status breve_spring_set_description(breve_world* world, breve_object spring,
                                                    const breve_spring* description);

/* The description of a spring. Its bodies are null if they no longer exist.
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a spring; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_spring_description(const breve_world* world, breve_object spring,
                                                breve_spring* description);

/* The current distance of a spring's points and its force in the last sub-step, N; both 0 if it is not connected.
   @param length, force  may be NULL
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a spring. */
BREVE_API breve_status breve_spring_state(const breve_world* world, breve_object spring, double* length, double* force);

/* ---- accuracy ---------------------------------------------------------------------------------------------------- */

/* Rungs of the accuracy ladder: named sets of settings. */
typedef enum breve_rung {
  BREVE_RUNG_FAST = 0,
  BREVE_RUNG_BALANCED = 1,
  BREVE_RUNG_PRECISE = 2,
  BREVE_RUNG_REFERENCE = 3,
  BREVE_RUNG_CONSERVING = 4
} breve_rung;

typedef enum breve_integrator {
  BREVE_INTEGRATOR_EXPLICIT_EULER = 0,
  BREVE_INTEGRATOR_SEMI_IMPLICIT_EULER = 1,
  BREVE_INTEGRATOR_IMPLICIT_EULER = 2,
  BREVE_INTEGRATOR_VELOCITY_VERLET = 3,
  BREVE_INTEGRATOR_IMPLICIT_MIDPOINT = 4,
  BREVE_INTEGRATOR_RUNGE_KUTTA_4 = 5,
  BREVE_INTEGRATOR_FEHLBERG_4 = 6,
  BREVE_INTEGRATOR_FEHLBERG_5 = 7,
  BREVE_INTEGRATOR_FEHLBERG_ADAPTIVE = 8
} breve_integrator;

/* How bodies with physics are computed. */
typedef struct breve_accuracy {
  size_t struct_size;       /* set by breve_accuracy_default */
  uint32_t rung;            /* breve_rung: the origin of the settings */
  uint32_t integrator;      /* breve_integrator: for smooth motion */
  bool implicit_joints;     /* springs, dampers and motors of joints are implicit (Euler's schemes) */
  bool implicit_spin;       /* the rotation of a free body uses the implicit midpoint rule */
  bool direct;              /* small islands of contacts are solved directly */
  bool locate_impacts;      /* impacts at their time of impact; otherwise at the end of the sub-step */
  bool contact_springs;     /* slow contacts with restitution are springs, where impacts are located */
  bool link_springs;        /* the same where articulated bodies take part */
  bool reserved[2];         /* must be false */
  double step;              /* s, the longest sub-step; 0: the integration step */
  double contact_step;      /* s, the longest sub-step of bodies in contact; 0: `step` */
  double tolerance;         /* of BREVE_INTEGRATOR_FEHLBERG_ADAPTIVE */
  int32_t iterations;       /* maximum of the contact solver, where it is iterative */
  int32_t impacts;          /* maximum number of impacts located in one island and sub-step */
  double contact_stiffness; /* of contact springs, N/m per kg of the mass that they push apart; > 0 */
  double contact_damping;   /* damping ratio of contact springs, 0..0.9; 0: derived from the pair's restitution */
} breve_accuracy;

/* All zero, to be filled in by breve_rung_accuracy or breve_world_accuracy. */
static inline breve_accuracy breve_accuracy_default(void) {
  breve_accuracy accuracy;
  breve_clear(&accuracy, sizeof accuracy);
  accuracy.struct_size = sizeof accuracy;
  return accuracy;
}

/* The settings of a rung. BREVE_OK; BREVE_ERROR_ARGUMENT: unknown rung, or a wrong struct_size. */
BREVE_API breve_status breve_rung_accuracy(breve_rung rung, breve_accuracy* accuracy);

/* The rung of that name: "fast", "balanced", "precise", "reference" or "conserving".
   BREVE_OK; BREVE_ERROR_NOT_FOUND. */
BREVE_API breve_status breve_rung_find(const char* name, breve_rung* rung);

BREVE_API breve_status breve_world_accuracy(const breve_world* world, breve_accuracy* accuracy);

/* In a flat world only the rung, step, contact_step, iterations, impacts and locate_impacts have an effect; the other
   settings belong to integrators and solvers that it does not use, and are stored.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a setting is not finite, negative, or 0 where a positive number is required. */
BREVE_API breve_status breve_world_set_accuracy(breve_world* world, const breve_accuracy* accuracy);

/* A description of a world's settings in words; owned by the world until the next call of this function on it. */
BREVE_API breve_status breve_world_accuracy_text(const breve_world* world, const char** text);

/* Sets the accuracy of a body and its whole assembly; NULL: the world's.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT as breve_world_set_accuracy. */
BREVE_API breve_status breve_object_set_accuracy(breve_world* world, breve_object object,
                                                 const breve_accuracy* accuracy);

/* The settings that apply to a body: those of its assembly, or the world's.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_object_accuracy(const breve_world* world, breve_object object, breve_accuracy* accuracy);

/* ---- space ------------------------------------------------------------------------------------------------------- */

/* Acceleration of all bodies with physics; (0, -9.81, 0) unless changed. */
BREVE_API breve_status breve_world_gravity(const breve_world* world, double gravity[3]);

/* BREVE_OK; BREVE_ERROR_ARGUMENT: not finite. */
BREVE_API breve_status breve_world_set_gravity(breve_world* world, const double gravity[3]);

/* What happens at the ends of space along an axis. */
typedef enum breve_edge {
  BREVE_EDGE_OPEN = 0, /* space is unbounded; the default for all axes */
  BREVE_EDGE_WRAP = 1, /* a body that leaves at one end returns at the other; distances and neighbours work across it */
  BREVE_EDGE_WALL = 2  /* walls that reflect the centres of bodies */
} breve_edge;

/* Sets the extent of space along one axis. At the end of each sub-step, moving kinematic bodies and bodies with physics
   are brought back inside; an assembly moves as a whole, according to its first body, unless it is attached to the
   world. Collision handlers of bodies without physics work across edges that wrap; contacts of bodies with physics act
   only on their own side. Runs no script.
   @param axis       0, 1, 2 for x, y, z
   @param low, high  m, finite, low < high; ignored for BREVE_EDGE_OPEN
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_space(breve_world* world, int axis, breve_edge edge, double low, double high);

/* The extent of space along one axis.
   @param edge, low, high  each may be NULL; low and high are 0 if the axis is open
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_space(const breve_world* world, int axis, breve_edge* edge, double* low,
                                         double* high);

/* ---- grids ------------------------------------------------------------------------------------------------------- */

/* The number of cells of a grid along x, y and z.
   @param grid    an object of class PatchGrid or PatchToroid
   @param counts  three numbers, each at least 1
   BREVE_OK; BREVE_ERROR_STALE; BREVE_ERROR_NOT_FOUND: the object is not a grid, or init-with has not created cells
   yet. */
BREVE_API breve_status breve_grid_size(const breve_world* world, breve_object grid, uint32_t counts[3]);

/* Copies the concentrations of a chemical in all cells of a grid, as get-concentration returns them for one. Runs no
   script.
   @param chemical  an object that the grid tracks (track)
   @param values    amount per volume of space, one number for each cell; the cell with the indices x, y, z is at (x *
                    ny + y) * nz + z. Room for `capacity` numbers; NULL only if capacity is 0
   @param count     the number of cells, even if it exceeds capacity; at most capacity numbers are written
   BREVE_OK; BREVE_ERROR_STALE; BREVE_ERROR_NOT_FOUND as breve_grid_size, and if the grid does not track the chemical.
 */
BREVE_API breve_status breve_grid_concentrations(const breve_world* world, breve_object grid, breve_object chemical,
                                                 double* values, size_t capacity, size_t* count);

/* Sets the concentrations of a chemical in all cells, in the same order. Changes nothing if it fails. Runs no script.
   @param count  the number of cells
   As breve_grid_concentrations; BREVE_ERROR_ARGUMENT: a number that is not finite, or another count. */
BREVE_API breve_status breve_grid_set_concentrations(breve_world* world, breve_object grid, breve_object chemical,
                                                     const double* values, size_t count);

/* ---- threads ----------------------------------------------------------------------------------------------------- */

/* Sets the number of threads that may compute the physics of a world, including the caller's, 1 to 256; initially 1.
   The result does not depend on it. Islands (bodies that touch or are connected, and what they touch) are distributed
   among the threads; islands with a collision handler or a force method are left to the caller's thread. The threads
   are oneTBB's: all runtimes of the process share them, also with a host that uses oneTBB itself. The process has no
   more of them than cores. oneTBB decides when they end; breve_runtime_destroy does not wait for it. Only the caller's
   thread computes a flat world.
   BREVE_OK; BREVE_ERROR_ARGUMENT: out of this range. */
BREVE_API breve_status breve_world_set_workers(breve_world* world, uint32_t workers);

/* The value set by breve_world_set_workers. 0 for NULL. */
BREVE_API uint32_t breve_world_workers(const breve_world* world);

/* ---- physics events and counters --------------------------------------------------------------------------------- */

/* The guard's reaction when physics goes wrong. */
typedef enum breve_guard {
  BREVE_GUARD_OFF = 0, /* a step whose motion cannot be computed gives BREVE_ERROR_SCRIPT */
  BREVE_GUARD_REPORT = 1,
  BREVE_GUARD_REFINE = 2, /* compute that part of the world with smaller steps */
  BREVE_GUARD_REST = 3    /* and stop its motion if that does not help. The default */
} breve_guard;

/* BREVE_OK; BREVE_ERROR_ARGUMENT: there is no such mode. */
BREVE_API breve_status breve_world_set_guard(breve_world* world, breve_guard mode);

/* The mode of the guard; BREVE_GUARD_OFF for NULL. */
BREVE_API breve_guard breve_world_guard(const breve_world* world);

/* One action of the guard. */
typedef struct breve_intervention {
  uint64_t iteration;
  double time;        /* s */
  breve_object body;  /* the body where it was found; it may no longer exist */
  const char* reason; /* in words: "a number is not finite"; lives as long as the library */
  const char* action; /* "reported", "refined", "put to rest" or "finished coarsely"; lives as long as the library */
  double value;       /* the measured value: J, m, rad, 1/s, a count or a ratio */
} breve_intervention;

/* The interventions of the last iteration, in order.
   @param interventions  room for `capacity`; NULL only if capacity is 0
   @param count          the total number, even if it exceeds capacity; at most capacity are written */
BREVE_API breve_status breve_world_interventions(const breve_world* world, breve_intervention* interventions,
                                                 size_t capacity, size_t* count);

/* An impulse at a contact. */
typedef struct breve_impact {
  breve_object a, b; /* b may be null: something without an object. Both may no longer exist */
  double time;       /* s */
  double point[3];   /* world frame */
  double normal[3];  /* unit, from b toward a */
  double impulse[3]; /* on a, N*s, world frame */
} breve_impact;

/* The impacts of the last iteration, in the order in which they happened. As breve_world_interventions. */
BREVE_API breve_status breve_world_impacts(const breve_world* world, breve_impact* impacts, size_t capacity,
                                           size_t* count);

/* The energy ledger: where energy is and where it went, J. The first three are current values, the others are sums
   since the start: kinetic + potential + springs - (their sum at the start) = works - losses + residual. */
typedef struct breve_energy {
  size_t struct_size; /* set by breve_energy_default */
  double kinetic;
  double potential;     /* in the field of gravity, 0 at the world's origin */
  double springs;       /* of joints, of Springs and of contacts */
  double motor_work;    /* of the motors of joints */
  double script_work;   /* of forces that scripts and hosts set, and of all their other changes (docs/physics.md) */
  double contact_loss;  /* in contacts, along the normal */
  double friction_loss; /* in contacts, along the surface */
  double drag_loss;     /* of dampers */
  double limit_loss;    /* at the limits of joints */
  double residual;      /* the unexplained rest: the error of the method */
} breve_energy;

/* All zero, to be filled in. */
static inline breve_energy breve_energy_default(void) {
  breve_energy energy;
  breve_clear(&energy, sizeof energy);
  energy.struct_size = sizeof energy;
  return energy;
}

/* The energy ledger of all bodies with physics. BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_energy(const breve_world* world, breve_energy* energy);

/* The energy ledger of a body's assembly. As breve_world_energy; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_energy(const breve_world* world, breve_object object, breve_energy* energy);

/* The cost of the physics of the last iteration: only counts, so that runs can be compared. */
typedef struct breve_physics_counters {
  size_t struct_size;   /* set by breve_physics_counters_default */
  uint64_t sub_steps;   /* of islands; rejected ones are not counted */
  uint64_t evaluations; /* of forces, by trees of bodies */
  uint64_t rejected;    /* steps of step control that were repeated */
  uint64_t islands;
  uint64_t pairs;    /* examined by the narrow phase */
  uint64_t contacts; /* points */
  uint64_t warm;     /* points with an impulse from the last sub-step */
  uint64_t impacts;  /* at their time of impact */
  uint64_t searches; /* for a time of impact */
  uint64_t solver_iterations;
  uint64_t direct;   /* islands solved directly */
  uint64_t sleeping; /* bodies asleep now */
  uint64_t interventions;
  /* In m/s: the largest violation in the solver of the velocity that a contact, limit, motor or loop requires; if rows
     were swept, the largest change in the last sweep. 0 in a flat world, whose engine does not report it. */
  double residual;
  uint64_t work; /* units, see `physics_budget` */
} breve_physics_counters;

/* All zero, to be filled in. */
static inline breve_physics_counters breve_physics_counters_default(void) {
  breve_physics_counters counters;
  breve_clear(&counters, sizeof counters);
  counters.struct_size = sizeof counters;
  return counters;
}

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_physics_counters(const breve_world* world, breve_physics_counters* counters);

/* ---- values ------------------------------------------------------------------------------------------------------ */

typedef enum breve_type {
  BREVE_TYPE_NULL = 0, /* no value */
  BREVE_TYPE_INT = 1,
  BREVE_TYPE_DOUBLE = 2,
  BREVE_TYPE_VECTOR = 3,
  BREVE_TYPE_MATRIX = 4,
  BREVE_TYPE_STRING = 5,
  BREVE_TYPE_OBJECT = 6,
  BREVE_TYPE_LIST = 7,
  BREVE_TYPE_HASH = 8,
  BREVE_TYPE_POINTER = 9, /* opaque: its contents are not accessible, and it cannot be passed in */
  BREVE_TYPE_DATA = 10    /* bytes */
} breve_type;

/* A value of a script. Numbers, vectors, matrices and objects are stored in place. Bytes that the library returns
   belong to it, and a list or hash is a reference: both are valid until script runs in that world again, that is until
   the next function marked "Runs script", or, in a callback, until it returns. An older reference gives
   BREVE_ERROR_STALE; copy bytes that you need longer. Bytes that the host passes are copied by the call. A function
   that takes a value returns BREVE_ERROR_UNSUPPORTED for a BREVE_TYPE_POINTER, BREVE_ERROR_STALE for an object that no
   longer exists, and BREVE_ERROR_ARGUMENT for a type that is not a breve_type. */
typedef struct breve_value {
  uint32_t type; /* breve_type */
  uint32_t reserved;
  union {
    int32_t integer;
    double number;
    double vector[3];
    double matrix[9]; /* row by row */
    struct {
      const char* bytes; /* a string that the library returns is followed by a zero byte */
      size_t size;
    } string;            /* BREVE_TYPE_STRING, BREVE_TYPE_DATA */
    breve_object object; /* null, or an object that may no longer exist */
    breve_ref ref;       /* BREVE_TYPE_LIST, BREVE_TYPE_HASH; all zero: empty, not yet created by the script */
  } as;
} breve_value;

/* Values to pass in. breve_value_string refers to `text` until the call is made; NULL gives the empty string. */
BREVE_API breve_value breve_value_null(void);
BREVE_API breve_value breve_value_int(int32_t integer);
BREVE_API breve_value breve_value_double(double number);
BREVE_API breve_value breve_value_vector(double x, double y, double z);
BREVE_API breve_value breve_value_matrix(const double rows[9]); /* NULL: all zero */
BREVE_API breve_value breve_value_string(const char* text);
BREVE_API breve_value breve_value_object(breve_object object);

/* The text of a value as `print` shows it, owned by the world until the next call of this function on it. Runs script
   (objects describe themselves).
   BREVE_OK; BREVE_ERROR_STALE: the value is a list or hash from before script ran; BREVE_ERROR_TYPE: its reference
   refers to a different type than the value states. */
BREVE_API breve_status breve_value_text(breve_world* world, const breve_value* value, const char** text);

/* Creates an empty list. */
BREVE_API breve_status breve_list_create(breve_world* world, breve_value* list);

/* BREVE_OK; BREVE_ERROR_TYPE: `list` is not a list; BREVE_ERROR_STALE. The same for the functions below. */
BREVE_API breve_status breve_list_size(const breve_world* world, const breve_value* list, size_t* size);

/* The element at `index`, from 0. `world` is not const because an element that is a list or hash is entered in the
   table of references. BREVE_ERROR_NOT_FOUND if index is not below the size. */
BREVE_API breve_status breve_list_get(breve_world* world, const breve_value* list, size_t index, breve_value* element);

/* Reads `count` elements from `first` on, in one call, as breve_list_get. BREVE_ERROR_NOT_FOUND if the list has fewer.
   @param elements  NULL only if count is 0 */
BREVE_API breve_status breve_list_read(breve_world* world, const breve_value* list, size_t first, breve_value* elements,
                                       size_t count);

/* Appends an element. BREVE_ERROR_ARGUMENT for a list that the script has not created yet (all-zero reference). */
BREVE_API breve_status breve_list_push(breve_world* world, const breve_value* list, const breve_value* element);

/* Creates an empty hash. */
BREVE_API breve_status breve_hash_create(breve_world* world, breve_value* hash);

/* The number of keys. BREVE_OK; BREVE_ERROR_TYPE: `hash` is not a hash; BREVE_ERROR_STALE. The same below. */
BREVE_API breve_status breve_hash_size(const breve_world* world, const breve_value* hash, size_t* size);

/* The value of a key; keys of different types differ. `world` is not const for the reason given at breve_list_get.
   BREVE_ERROR_NOT_FOUND if there is no such key. */
BREVE_API breve_status breve_hash_get(breve_world* world, const breve_value* hash, const breve_value* key,
                                      breve_value* element);

/* Sets the value of a key. BREVE_ERROR_ARGUMENT for a hash that the script has not created yet (all-zero reference). */
BREVE_API breve_status breve_hash_set(breve_world* world, const breve_value* hash, const breve_value* key,
                                      const breve_value* element);

/* Creates a list of the keys, in order of insertion. */
BREVE_API breve_status breve_hash_keys(breve_world* world, const breve_value* hash, breve_value* keys);

/* ---- variables and calls ----------------------------------------------------------------------------------------- */

/* Reads an instance variable, declared in the object's class or inherited. `world` is not const for the reason given at
   breve_list_get.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such variable; BREVE_ERROR_UNSUPPORTED: an array. */
BREVE_API breve_status breve_object_get(breve_world* world, breve_object object, const char* name, breve_value* value);

/* Writes an instance variable. The value is converted to the variable's type as in an assignment in a script.
   BREVE_OK; BREVE_ERROR_NOT_FOUND; BREVE_ERROR_TYPE: the value cannot be converted, or is an object of a class that the
   variable does not accept; BREVE_ERROR_UNSUPPORTED: an array, or a pointer. */
BREVE_API breve_status breve_object_set(breve_world* world, breve_object object, const char* name,
                                        const breve_value* value);

/* One keyword with its argument: `to v` in `set-velocity to v`. */
typedef struct breve_keyword {
  const char* name;
  breve_value value;
} breve_keyword;

/* Calls a method by its name and keywords, in any order; keywords with defaults may be omitted. Runs script.
   @param keywords  NULL only if count is 0
   @param result    may be NULL
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such method; BREVE_ERROR_TYPE: an argument is marked as a list, a hash or another
   reference, but refers to something else; BREVE_ERROR_SCRIPT: a run-time error, also for an unknown or missing
   keyword; BREVE_ERROR_BUDGET, _MEMORY; BREVE_ERROR_DEPTH: also if calls of host and script nest too deeply. The world
   is consistent after an error. */
BREVE_API breve_status breve_object_call(breve_world* world, breve_object object, const char* method,
                                         const breve_keyword* keywords, size_t count, breve_value* result);

/* Resolves a method name and its keywords once, for many fast calls. The selector works for any class; the world owns
   it.
   @param keywords  names in the order in which the arguments will be passed; NULL only if count is 0 */
BREVE_API breve_status breve_world_prepare(breve_world* world, const char* method, const char* const* keywords,
                                           size_t count, breve_selector* selector);

/* Calls a prepared method. Runs script.
   @param arguments  in the order of the prepared keywords; NULL only if count is 0
   @param count      must be the prepared count
   @param result     may be NULL
   As breve_object_call; BREVE_ERROR_STALE also for a selector that this world has not prepared. */
BREVE_API breve_status breve_object_call_prepared(breve_world* world, breve_object object, breve_selector selector,
                                                  const breve_value* arguments, size_t count, breve_value* result);

/* ---- many objects at once ---------------------------------------------------------------------------------------- */

/* One call for many objects, whose numbers are in an array of the host: one row for each object, at any address and
   with any stride, for example in a renderer's instance buffer. Each of these functions does the same as the function
   for a single object, in the order of the objects; all ids and numbers are checked first, and if one is refused
   nothing is changed or written. breve_world_objects returns the objects of a class. The functions allocate no memory
   once they have handled the same number of objects. */

typedef enum breve_number {
  BREVE_NUMBER_FLOAT = 0, /* 4 bytes */
  BREVE_NUMBER_DOUBLE = 1 /* 8 bytes */
} breve_number;

typedef struct breve_array {
  void* numbers;   /* the first row; NULL only if there are no objects. A function that reads the array does not write
                      it */
  size_t stride;   /* bytes from one row to the next; 0: the rows are contiguous */
  uint32_t number; /* breve_number */
  uint32_t width;  /* numbers per row; must be the width of the property, otherwise BREVE_ERROR_ARGUMENT */
} breve_array;

typedef enum breve_property {
  BREVE_PROPERTY_LOCATION = 0,            /* 3 */
  BREVE_PROPERTY_ROTATION = 1,            /* 4: w, x, y, z */
  BREVE_PROPERTY_POSE = 2,                /* 7: location, rotation */
  BREVE_PROPERTY_VELOCITY = 3,            /* 3 */
  BREVE_PROPERTY_ROTATIONAL_VELOCITY = 4, /* 3 */
  BREVE_PROPERTY_COLOR = 5                /* 4: red, green, blue, alpha */
} breve_property;

/* @param objects   NULL only if count is 0
   @param property  breve_property
   BREVE_OK; BREVE_ERROR_NO_BODY: one of the objects has no position in space. */
BREVE_API breve_status breve_objects_property(const breve_world* world, const breve_object* objects, size_t count,
                                              uint32_t property, const breve_array* array);

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a number is not finite, or is refused by the function for one
   object; BREVE_ERROR_SCRIPT: as for breve_object_set_pose. If memory runs out during the call, the first rows are
   written. */
BREVE_API breve_status breve_objects_set_property(breve_world* world, const breve_object* objects, size_t count,
                                                  uint32_t property, const breve_array* array);

/* An instance variable of each object: an int or a float is 1 number, a vector 3. The objects may be of several classes
   if the variable has the same type in all of them.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: a class does not have this variable; BREVE_ERROR_TYPE: it has another type;
   BREVE_ERROR_UNSUPPORTED: it is an array. */
BREVE_API breve_status breve_objects_get(const breve_world* world, const breve_object* objects, size_t count,
                                         const char* name, const breve_array* array);

/* As breve_objects_get; BREVE_ERROR_TYPE also for a number that an int cannot represent. */
BREVE_API breve_status breve_objects_set(breve_world* world, const breve_object* objects, size_t count,
                                         const char* name, const breve_array* array);

/* Calls a prepared method of each object, with the same arguments. An object that an earlier call freed is skipped. The
   first call that fails ends the function: the calls before it are done, and their results are written. Runs script.
   @param arguments  as for breve_object_call_prepared
   @param results    one for each object, or NULL; BREVE_TYPE_NULL for a skipped object, and for a text, a list or
                     anything else that does not outlive the next call
   As breve_object_call_prepared. */
BREVE_API breve_status breve_objects_call_prepared(breve_world* world, const breve_object* objects, size_t count,
                                                   breve_selector selector, const breve_value* arguments,
                                                   size_t argument_count, breve_value* results);

/* ---- host functions ---------------------------------------------------------------------------------------------- */

/* One call of a host function, for breve_function_fn; valid until that returns. The library fills it in. */
typedef struct breve_call {
  size_t struct_size; /* of the library's breve_call: later libraries append fields */
  breve_world* world;
  breve_object self;            /* the object whose method calls */
  const breve_value* arguments; /* converted to the types that breve_function.parameters names */
  size_t count;                 /* breve_function.parameter_count */
  breve_write_fn reason;        /* to say why the call fails, call it with `sink` and a sentence without period */
  void* sink;
  void* binding; /* of a method of a class of the host: what breve_class.bind gave for this world; else NULL */
} breve_call;

/* A script calls a host function. The callback may call any function of this header: call methods, create and free
   objects, including `self` (the calling method then ends when the callback returns). Functions that cannot work inside
   a running script return BREVE_ERROR_BUSY.
   @param user    breve_function.user
   @param result  initially no value; to be filled in. It is converted to breve_function.result
   Returns BREVE_OK. Any other status is a run-time error in the script, at the call: with the reason that was written,
   otherwise with the message of the world's last error if that has the same status, otherwise with the status's name.
   BREVE_ERROR_BUDGET, _DEPTH, _MEMORY and _INTERRUPTED are kept. The status of a call that failed in the callback can
   be returned unchanged. */
typedef breve_status (*breve_function_fn)(void* user, const breve_call* call, breve_value* result);

/* A function that scripts call like a function of the language: `worldHeight(x, y)`. */
typedef struct breve_function {
  size_t struct_size;          /* set by breve_function_default */
  const char* name;            /* letters, digits and '_'; copied. Required */
  const char* doc;             /* a description, for editors; copied. NULL: none. Default NULL */
  const uint32_t* parameters;  /* `parameter_count` of breve_type, copied: arguments are converted as in an assignment;
                                  BREVE_TYPE_NULL accepts any value unchanged. NULL only if there are none. Default
                                  NULL */
  size_t parameter_count;      /* at most 8. Default 0 */
  uint32_t result;             /* breve_type; BREVE_TYPE_NULL: any value, or none. Default BREVE_TYPE_NULL */
  breve_function_fn call;      /* required */
  void* user;                  /* passed to `call`. Default NULL */
  void (*destroy)(void* user); /* called once, when neither the runtime nor any of its programs and worlds can call the
                                  function any more, by the thread that destroys the last of them; it must not use any
                                  of these. NULL: nothing to do. Default NULL */
} breve_function;

/* The defaults named above. */
static inline breve_function breve_function_default(void) {
  breve_function function;
  breve_clear(&function, sizeof function);
  function.struct_size = sizeof function;
  return function;
}

/* Adds a function for all programs that are compiled and analysed on this runtime from now on. Existing programs do not
   know it. The function is not part of snapshots: the host is responsible for a restored world continuing in the same
   way. A force method, which may run several times for the same time, may not call it. Runs no script.
   @param function  copied
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, no name or no `call`, a name that programs cannot call or that
   belongs to the language or to another function of this runtime, too many parameters, an unknown type or
   BREVE_TYPE_POINTER: `destroy` is not called then. BREVE_ERROR_BUSY from a callback of a compilation, but for the entry
   of a plugin, whose functions belong to the programs that name it. */
BREVE_API breve_status breve_runtime_add_function(breve_runtime* runtime, const breve_function* function);

/* Charges the work of a host function to the budget of the running script, as a number of loop iterations. The call of
   the function itself counts as one. Has no effect if no script runs, or without a budget.
   BREVE_OK; BREVE_ERROR_BUDGET: the budget is used up; BREVE_ERROR_INTERRUPTED: breve_world_interrupt. Return these
   from the callback; if it continues, the script ends when it returns. */
BREVE_API breve_status breve_world_charge(breve_world* world, uint64_t iterations);

/* Whether the world has a budget for iterations or calls. Without one, nothing is counted. */
BREVE_API bool breve_world_has_budget(const breve_world* world);

/* ---- classes of the host ------------------------------------------------------------------------------------------ */

/* A class that the host implements in its own language. Programs use it like a class of the class library: they derive
   classes from it, create objects of it and call its methods. A host class may itself be derived from a class of the
   library, of the host or of a program. Methods with special names work as in steve: `init` runs for each new object,
   from the root class down; `iterate` and `post-iterate` run in each iteration; and `destroy` runs when an object is
   freed. See docs/host_classes.md. */

/* One keyword of a method, with the type of its argument. */
typedef struct breve_parameter {
  const char* keyword;
  uint32_t type;     /* breve_type. Arguments are converted as in an assignment. BREVE_TYPE_NULL: any value, unchanged */
  uint32_t reserved; /* must be 0 */
} breve_parameter;

/* A method of a host class. It is called like a host function; breve_call.self is the receiver. Frozen. */
typedef struct breve_method {
  const char* name;                  /* a selector: "set-goal" */
  const char* doc;                   /* a description, for editors; NULL: none */
  const breve_parameter* parameters; /* NULL only if there are none */
  size_t parameter_count;            /* at most 8 */
  uint32_t result;                   /* breve_type; BREVE_TYPE_NULL: any value, or none */
  bool adopts_keywords; /* true: if the method overrides one that has the same number of keywords but different ones, it
                           takes over those keywords, in their order, so that callers do not have to know which of the
                           two methods they call */
  bool reserved[3];     /* must be false */
  breve_function_fn call;
  void* user; /* passed to `call` */
} breve_method;

/* An instance variable. breve_object_get, breve_object_set and the methods of derived classes can read and write it. */
typedef struct breve_variable {
  const char* name;
  uint32_t type;     /* breve_type, but not BREVE_TYPE_NULL or BREVE_TYPE_POINTER */
  uint32_t reserved; /* must be 0 */
} breve_variable;

/* A position in the host's source code, for the call chain of an error. */
typedef struct breve_place {
  const char* function; /* the name of the function in that source; copied */
  const char* file;     /* copied */
  uint32_t line;        /* counts from 1; 0 if not known */
} breve_place;

/* Called when a world is created from a program that contains the class, before anything runs in the world. The function
   must not create objects.
   @param user     breve_class.user
   @param binding  initially NULL; set it to the value that breve_call.binding is to have in this world
   If the function returns a status other than BREVE_OK, the creation of the world fails with the reason that the function
   has written. */
typedef breve_status (*breve_bind_fn)(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink);

/* Called to collect the call chain when an error leaves a method or passes through it. The function must not call functions
   of this header.
   @param call    the call of the method, as for breve_function_fn
   @param places  room for `capacity` places. The function writes the running functions of the host in this call, innermost
                  first; the last one is the method itself. Texts must be valid until the next call of this function
   Returns the total number, even if it exceeds capacity; writes at most capacity places. */
typedef size_t (*breve_places_fn)(void* user, const breve_call* call, breve_place* places, size_t capacity);

/* The description of a host class. */
typedef struct breve_class {
  size_t struct_size;              /* set by breve_class_default */
  const char* name;                /* required */
  const char* alias;               /* another name, as in `(aka Birds)`. NULL: none. Default NULL */
  const char* parent;              /* a class of the library, the host or a program. Default "Object" */
  const char* const* modules;      /* `module_count` modules, such as the module of the parent. Programs load them before
                                      the class, as with @include. NULL only if there are none. Default NULL */
  size_t module_count;             /* Default 0 */
  const char* doc;                 /* a description, for editors. NULL: none. Default NULL */
  const breve_variable* variables; /* NULL only if there are none. Default NULL */
  size_t variable_count;           /* Default 0 */
  const breve_method* methods;     /* NULL only if there are none. Default NULL */
  size_t method_count;             /* Default 0 */
  breve_bind_fn bind;              /* NULL: breve_call.binding is NULL. Default NULL */
  void (*unbind)(void* binding);   /* called when the world is destroyed, or when its program is replaced by one without
                                      the class. It must not call functions of this header. NULL: nothing is called.
                                      Default NULL */
  breve_places_fn places;          /* NULL: call chains contain only the name of the method. Default NULL */
  void* user;                      /* passed to `bind` and `places`. Default NULL */
  void (*destroy)(void* user);     /* as breve_function.destroy. Default NULL */
  const breve_place* method_places; /* where each of the `method_count` methods is declared, for profiles. `function` is
                                       ignored, and `file` may be NULL if it is unknown. NULL: all are unknown. Default
                                       NULL */
} breve_class;

/* Returns a description with the defaults named above. */
static inline breve_class breve_class_default(void) {
  breve_class class_;
  breve_clear(&class_, sizeof class_);
  class_.struct_size = sizeof class_;
  class_.parent = "Object";
  return class_;
}

/* Adds a host class to all programs that are compiled or analysed on this runtime from now on. A program contains the class
   if it uses the name of the class. A class of the same name that a file of the program defines takes precedence over the
   host class, and the host class takes precedence over one of the class library. It replaces an earlier host class of the
   same name; programs that are already compiled keep the earlier class. Does not run script.
   @param description  copied, with everything that it points to
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, a name that a program cannot use, a method without `call`,
   more than 8 parameters, two methods or variables with the same name, or an unknown type; `destroy` is not called then.
   BREVE_ERROR_BUSY from a callback of a compilation. */
BREVE_API breve_status breve_runtime_add_class(breve_runtime* runtime, const breve_class* description);

/* Prepares a selector, as breve_world_prepare does, but for calls like those of `super`: breve_object_call_prepared then
   calls the method of the parent of `class_name`, even if the object's own class overrides it. The selector works for
   objects of `class_name` and its descendants; a call of any other object returns BREVE_ERROR_TYPE.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class; BREVE_ERROR_ARGUMENT: the class does not have a
   parent. */
BREVE_API breve_status breve_world_prepare_super(breve_world* world, const char* class_name, const char* method,
                                                 const char* const* keywords, size_t count, breve_selector* selector);

/* A method of a class, as a program sees it. Texts are owned by the program. */
typedef struct breve_method_info {
  const char* class_name; /* the class that defines it */
  const char* name;
  size_t keyword_count;
  const char* const* keywords;  /* in the order of the declaration; owned by the world until the next call of
                                   breve_world_methods on it */
  const uint32_t* types;        /* breve_type of each, owned likewise; BREVE_TYPE_NULL: any value */
  const bool* defaults;         /* whether each keyword may be left out; owned likewise */
} breve_method_info;

/* Reads the methods of a class, including those that it inherits and does not override, in the order of declaration. The
   methods of the class itself come first.
   @param methods  room for `capacity` methods; NULL only if capacity is 0
   @param count    receives the total number, even if it exceeds capacity; at most capacity methods are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class. */
BREVE_API breve_status breve_world_methods(breve_world* world, const char* class_name, breve_method_info* methods,
                                           size_t capacity, size_t* count);

/* Prints like `print` in a script: passes `size` bytes to the print callback on BREVE_CHANNEL_PRINT, and charges the budget
   of the running script. BREVE_OK; BREVE_ERROR_SCRIPT: too much was printed, or a force method runs. */
BREVE_API breve_status breve_world_print(breve_world* world, const char* text, size_t size);

/* Computes the result of `random[bound]` in a script, from the world's generator: an int from 0 to bound, a number below
   bound, or a vector of such numbers. BREVE_OK; BREVE_ERROR_TYPE: the bound has another type. */
BREVE_API breve_status breve_world_random(breve_world* world, const breve_value* bound, breve_value* result);

/* ---- user data and state of the host ------------------------------------------------------------------------------ */

/* Attaches data of the host to a world; breve_world_user reads it.
   @param destroy  called once, when the world is destroyed or the data is replaced; it must not use this header. NULL:
                   nothing to do */
BREVE_API breve_status breve_world_set_user(breve_world* world, void* user, void (*destroy)(void* user));

/* Attaches data of the host to an object.
   @param destroy  called once: when the object is freed (after its `destroy` methods), when the world is destroyed, when
                   breve_world_restore removes the object, or when the data is replaced; it must not use this header. NULL:
                   nothing to do
   Data is not part of snapshots: an object that a restore creates again does not have any. */
BREVE_API breve_status breve_object_set_user(breve_world* world, breve_object object, void* user,
                                             void (*destroy)(void* user));

/* Reads the user data of an object; NULL if it does not have any. BREVE_OK; BREVE_ERROR_STALE; BREVE_ERROR_ARGUMENT: the
   null object. */
BREVE_API breve_status breve_object_user(const breve_world* world, breve_object object, void** user);

/* State of the host that influences the run of a world. It becomes part of the world's snapshots and of its hash. A world
   may have several states, each with its own name. */
typedef struct breve_state {
  size_t struct_size; /* set by breve_state_default */
  void* user;         /* passed to the callbacks. Default NULL */
  /* Writes the state, as bytes that depend on the run only. It may read the world. It returns false if the state cannot be
     saved; the snapshot or hash then gives BREVE_ERROR_UNSUPPORTED with the reason that was written. NULL: nothing is
     saved, and `load` is not called. Default NULL */
  bool (*save)(void* user, breve_world* world, breve_write_fn write, void* sink, breve_write_fn reason, void* reason_sink);
  /* Reads bytes that `save` wrote. It is called twice: first with commit false, before the world is changed, where it
     returns false if the bytes are not a valid state, and the restore gives BREVE_ERROR_IMAGE; then with commit true, after
     the world has been restored, where false means that memory ran out. Required if `save` is given */
  bool (*load)(void* user, breve_world* world, const char* bytes, size_t size, bool commit);
  /* Called after an object was freed or removed for any reason; its id is stale. It must not use this header. NULL: not
     called. Default NULL */
  void (*gone)(void* user, breve_object object);
  void (*destroy)(void* user); /* as for breve_world_set_user. Default NULL */
} breve_state;

/* The defaults named above. */
static inline breve_state breve_state_default(void) {
  breve_state state;
  breve_clear(&state, sizeof state);
  state.struct_size = sizeof state;
  return state;
}

/* Makes state of the host a part of the world. Images that were taken with it can be restored only in worlds that have a
   state with this name, and the other way round: otherwise BREVE_ERROR_IMAGE.
   @param name   copied
   @param state  copied; NULL: removes the state with this name
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size, or `save` without `load`; BREVE_ERROR_BUSY from a callback of a
   state of this world. */
BREVE_API breve_status breve_world_set_state(breve_world* world, const char* name, const breve_state* state);

/* breve_state.user of the state with this name; NULL if there is none. */
BREVE_API void* breve_world_state(const breve_world* world, const char* name);

/* Allocates memory with the runtime's allocator, counted against the world's limit and aligned for any type. Returns NULL if
   memory runs out or size is 0. Release it before the world is destroyed, for example in breve_class.unbind. */
BREVE_API void* breve_world_allocate(breve_world* world, size_t size);

/* Releases memory from breve_world_allocate; the size must be the same. Does nothing for NULL. */
BREVE_API void breve_world_release(breve_world* world, void* memory, size_t size);

/* ---- input ------------------------------------------------------------------------------------------------------- */

/* Queues the press (down) or release of a key; the controller's handler runs at the start of the next iteration.
   @param key  one character, perhaps of several bytes of UTF-8, or "up", "down", "left", "right" for the arrow keys;
               otherwise BREVE_ERROR_ARGUMENT */
BREVE_API breve_status breve_world_queue_key(breve_world* world, const char* key, bool down);

/* Queues a click on an object; the null object means a click on empty space. */
BREVE_API breve_status breve_world_queue_click(breve_world* world, breve_object object);

/* An entry of a menu. Texts are owned by the world and valid until script runs in it again. */
typedef struct breve_menu_item {
  breve_object item;
  breve_object owner; /* the controller for the main menu; otherwise the object whose context menu it is in */
  const char* title;  /* "" for a separator */
  const char* method; /* the method of the owner that is called when the item is chosen */
  bool separator, enabled, checked;
} breve_menu_item;

/* The entries of all menus, in order of creation.
   @param items  room for `capacity`; NULL only if capacity is 0
   @param count  the total number, even if it exceeds capacity; at most capacity are written */
BREVE_API breve_status breve_world_menu_items(const breve_world* world, breve_menu_item* items, size_t capacity,
                                              size_t* count);

/* Queues the choice of a menu item. Has no effect if the item is then disabled, or is a separator.
   BREVE_OK; BREVE_ERROR_ARGUMENT: the object is not a menu item. */
BREVE_API breve_status breve_world_queue_choice(breve_world* world, breve_object item);

/* ---- snapshots --------------------------------------------------------------------------------------------------- */

/* A number that is equal for two worlds if their whole state is the same, bit for bit: objects, bodies, scripts, schedule,
   random number generator. BREVE_OK; BREVE_ERROR_BUSY while a script of it runs; BREVE_ERROR_UNSUPPORTED: the host could
   not save a state of its own. */
BREVE_API breve_status breve_world_hash(const breve_world* world, uint64_t* hash);

/* Writes the whole state as an image: portable between runs of one library version on one kind of machine.
   @param image  room for `capacity` bytes; NULL only if capacity is 0
   @param size   the image's size. If it exceeds capacity, nothing is written to image: call again with more room
   BREVE_OK, also for that size query; BREVE_ERROR_BUSY while a script of it runs; BREVE_ERROR_UNSUPPORTED: the host
   could not save a state of its own. Does not change the world. The time that breve_world_advance carries over belongs to
   the host's loop and is not part of the image. */
BREVE_API breve_status breve_world_snapshot(const breve_world* world, void* image, size_t capacity, size_t* size);

/* Restores a snapshot's state in a world of the same program. In the world that the snapshot is from, the ids of that
   time are valid again; ids that were created since are stale, and no new object gets one of them. A world of another
   runtime that has the same number there (the first, the second ...) shares these ids; in any other world the host must
   look its objects up again. The time that breve_world_advance carries over is discarded. Runs no script.
   BREVE_OK; BREVE_ERROR_IMAGE: damaged, or of another program or version: the world is unchanged; BREVE_ERROR_BUSY
   while a script of it runs. */
BREVE_API breve_status breve_world_restore(breve_world* world, const void* image, size_t size);

/* ---- effects and statistics -------------------------------------------------------------------------------------- */

/* One effect of the simulation: it is active only if something in the scene requires it. Texts are owned by the world
   until the next call of breve_world_effects on it. */
typedef struct breve_effect {
  const char* name;
  const char* reason; /* why it is active, in words; "" if it is not */
  bool active;
  uint64_t since;        /* iteration at which it became active */
  breve_object asked_by; /* the first object that requested it; null: the world itself, or an object that no longer
                            exists */
  uint64_t items, calls; /* handled in the last iteration */
  uint64_t bytes;        /* memory that it holds now */
  double seconds;        /* CPU time in the last iteration */
} breve_effect;

/* All effects, active or not, in the order of the step.
   @param effects  room for `capacity`; NULL only if capacity is 0
   @param count    the total number, even if it exceeds capacity; at most capacity are written */
BREVE_API breve_status breve_world_effects(const breve_world* world, breve_effect* effects, size_t capacity,
                                           size_t* count);

typedef struct breve_stats {
  size_t struct_size; /* set by breve_stats_default */
  uint64_t iterations;
  double time;         /* simulated, s */
  uint64_t objects;    /* live */
  uint64_t bodies;     /* objects with a position in space */
  uint64_t heap_cells; /* strings, lists, hashes, objects on the script heap */
  size_t memory_used;  /* bytes, of this world */
  size_t memory_peak;  /* the maximum so far */
  size_t memory_limit; /* 0: none */
  uint64_t errors;     /* run-time errors that did not stop the run */
  uint64_t warnings;
} breve_stats;

/* All zero, to be filled in. */
static inline breve_stats breve_stats_default(void) {
  breve_stats stats;
  breve_clear(&stats, sizeof stats);
  stats.struct_size = sizeof stats;
  return stats;
}

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_stats(const breve_world* world, breve_stats* stats);

/* ---- profiles ---------------------------------------------------------------------------------------------------- */

/* A profile is a tree: each node is something that ran, below the node that called it, with a separate node for each
   calling line. Time is wall time while the world runs; the host's own time between its calls is not included. The tree
   also contains the world's own work, so that the totals of a node's children and its own time add up to its total, and
   everything adds up to the total of the root. A call of something that is already active (recursion) is counted in the
   upper node. The cost of profiling is measured at the start and subtracted, see breve_world_profile_cost: times of
   methods that take only a few nanoseconds are estimates.
   A profile does not change the world: hash, random numbers, budgets and order stay the same. A world without a profile
   has no overhead. Its memory counts against the world's limit: if that is reached, the profile ends and keeps what it
   has, the run continues, and breve_world_profile_stop reports it. A tree has at most 100,000 nodes; beyond that, the
   time of new ones counts as their caller's. Methods that breve_world_reload replaces keep their nodes. */

/* One node. Texts are never NULL and live until the world's next profile starts. */
typedef struct breve_profile_node {
  size_t parent;          /* its index; lower than the node's own index, and 0 for the root, which is node 0 */
  uint32_t kind;          /* breve_profile_kind */
  const char* class_name; /* the class of the method or of the operation; "" if there is none */
  const char* name;       /* method, function, operation or stage */
  const char* file;       /* where the method is declared; "" for anything else */
  uint32_t line;          /* of the declaration; 0 for anything else */
  uint32_t call_line;     /* of the call, in the calling method's file; 0 if it was not called by a script */
  uint64_t calls;         /* 0 for the root */
  double self_seconds;    /* without the time of what it called */
  double total_seconds;   /* with the time of what it called */
} breve_profile_node;

/* Starts a profile of a world; the previous one is dropped. To include `init`: breve_world_config.profile.
   @param trace  called at every begin and end; NULL: none. Its own time does not count
   BREVE_OK; BREVE_ERROR_BUSY while a script of this world runs; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_world_profile_start(breve_world* world, breve_trace_fn trace, void* user);

/* Stops the profile and keeps its results. Does nothing if it has stopped.
   BREVE_OK; BREVE_ERROR_MEMORY: it ended earlier because memory ran out, and holds the results up to then;
   BREVE_ERROR_NOT_FOUND: there has been no profile; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_profile_stop(breve_world* world);

/* The number of nodes of the profile, also while it is running.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: there has been no profile; BREVE_ERROR_BUSY while a script of this world runs;
   BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_world_profile_node_count(const breve_world* world, size_t* count);

/* The node at `index`, in depth-first order from the root: a node, then its first child with everything below it.
   As breve_world_profile_node_count; BREVE_ERROR_NOT_FOUND also if index is not below the count. */
BREVE_API breve_status breve_world_profile_node(const breve_world* world, size_t index, breve_profile_node* node);

/* The cost of profiling that was subtracted from the nodes, s: an estimate. As breve_world_profile_node_count. */
BREVE_API breve_status breve_world_profile_cost(const breve_world* world, double* seconds);

/* Whether a profile is running. A binding of another language checks this first: without a profile it need not report its
   functions. False for NULL. */
BREVE_API bool breve_world_is_profiled(const breve_world* world);

/* Reports that a function of the host's own language begins inside a host function or method that a script called: it
   becomes a node below the running one. Functions that a callback enters and does not leave end when the callback
   returns. Has no effect without a profile, or while nothing of the world runs. Runs no script.
   @param class_name  the class whose method it is; NULL or "": it is a function, of the kind BREVE_PROFILE_FUNCTION
   @param place       its declaration and name. Its address identifies the function in this profile: the texts are copied
                      when it is entered for the first time, and later changes are ignored
   BREVE_OK; BREVE_ERROR_ARGUMENT: `place`, its `function` or its `file` is NULL; BREVE_ERROR_BUSY inside a
   breve_trace_fn. */
BREVE_API breve_status breve_world_profile_enter(breve_world* world, const char* class_name, const breve_place* place);

/* Reports that the function that was entered last ends. Has no effect if something else was entered since.
   BREVE_OK; BREVE_ERROR_BUSY inside a breve_trace_fn. */
BREVE_API breve_status breve_world_profile_leave(breve_world* world);

/* Sets the line from which the running function of the host makes its next call: breve_profile_node.call_line of the
   function that it enters or calls next, which is 0 otherwise. BREVE_OK. */
BREVE_API breve_status breve_world_profile_line(breve_world* world, uint32_t line);

/* ---- reload and evaluate ----------------------------------------------------------------------------------------- */

/* Replaces the program that a world runs with a changed one. The program is compiled beforehand, so that a text with
   errors changes nothing. All or nothing: after an error the world runs the old program, unchanged. Runs no script: a
   new or changed `init` runs only for new objects.
   Methods are the new program's from the next call on. Objects stay the same: ids, order of creation, poses, scheduled
   calls, observers, collision handlers and menus (these by method name) are kept, and so are the values of variables
   that still have their name; new variables start at zero. If a variable has another type, its old value is converted
   as in an assignment; if that is impossible it starts at zero, with a warning. Classes are identified by their names,
   including aliases. Values of type breve_selector stay valid. Snapshots belong to the program that they were taken
   with: older ones are refused. The world releases the old program. During the reload the world's objects and lists
   exist twice, which counts against its memory limit.
   @param program  of any runtime; the world keeps it, and the host may destroy its handle afterwards
   BREVE_OK; BREVE_ERROR_BUSY while a script of this world runs; BREVE_ERROR_RELOAD: the change is impossible because a
   class with existing objects was removed or descends from a different class of the class library (a Mobile cannot
   become a Stationary), or the controller's class is a different one; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_world_reload(breve_world* world, const breve_program* program);

/* Runs statements as if they were in a method of an object's class: they may use its variables, `self` and `super`. The
   final period may be omitted. Assigning to a name that is not a variable of the object creates a variable of the
   world's session: it holds values of any type and is available to later statements, whatever `self` is, until the
   world is destroyed. Session variables are part of snapshots (a restored world has those of the image), but not of
   breve_world_hash. Warnings about the statements go to the print callback. Runs script.
   @param self    null: the controller
   @param text    `size` bytes; NULL only if size is 0
   @param result  may be NULL: the value of the last statement if it is an expression, or the value of `return`;
                  otherwise null
   BREVE_OK; BREVE_ERROR_COMPILE: nothing was run; the text of the error holds all diagnostics, with positions such as
   "input:1:5"; otherwise as breve_object_call. */
BREVE_API breve_status breve_world_evaluate(breve_world* world, breve_object self, const char* text, size_t size,
                                            breve_value* result);

/* The session variables as a hash from names to values; setting a key of the hash sets the variable. Before the first
   one is created, it is a hash that the script has not created yet. */
BREVE_API breve_status breve_world_session(breve_world* world, breve_value* hash);

/* Whether these statements can be run as they are. False while a bracket, string or comment is open or the last statement
   is incomplete, so that the user should be asked for another line. True for a text with other errors, and for an empty
   one. */
BREVE_API bool breve_statements_complete(const char* text, size_t size);

/* Stops the script that runs in a world: the function of this header that runs it returns BREVE_ERROR_INTERRUPTED
   within 50 ms (not counting callbacks of the host and one sub-step of physics, which is completed), and the call is
   abandoned as by a run-time error. Where it stops is not deterministic: two interrupted runs may differ. Does nothing
   if no script runs, or for NULL.
   May be called by any thread, and by a signal handler, as long as the world exists. */
BREVE_API void breve_world_interrupt(breve_world* world);

#ifdef __cplusplus
}
#endif

/* The rest of the interface, in parts: space.h (queries, collision filters, forces), events.h (the events of an
   iteration), step.h (game loops), batch.h (many worlds), record.h (logs of input, and replays), debug_draw.h (lines
   that show what the simulation does), plugin.h (functions and classes in shared libraries). */
#include "breve/batch.h"
#include "breve/debug_draw.h"
#include "breve/events.h"
#include "breve/plugin.h"
#include "breve/record.h"
#include "breve/space.h"
#include "breve/step.h"

#endif
