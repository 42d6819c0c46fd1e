/* What the files of the Lua binding share. The binding is written in C, on breve.h and Lua's own headers alone: Lua
   raises errors past its callers, by longjmp or by a C++ exception, and in C there is nothing that such a jump could
   skip. */
#ifndef BREVE_LUA_BINDING_H
#define BREVE_LUA_BINDING_H

#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>

#include "breve/breve.h"
#include "breve/breve_lua.h"

#define BL_KEYWORDS 16  /* most keywords of a method that is called from Lua */
#define BL_PARAMETERS 8 /* most parameters of a method that is written in Lua: see breve_method */
#define BL_PLACES 32    /* most places that are kept of an error */
#define BL_STATE "lua"  /* name of the state, see breve_world_set_state */

/* ---- what is known without a world ---- */

/* A method that a Lua file defines. */
typedef struct bl_method {
  struct bl_class* owner;
  char* name;     /* in Lua: "set_goal" */
  char* selector; /* in steve: "set-goal" */
  char* file;     /* where its function begins */
  uint32_t line;
  int index; /* among all methods of the program, from 1 */
  size_t count;
  char* keywords[BL_PARAMETERS];
  char* parameters[BL_PARAMETERS]; /* the same, as Lua spells them */
} bl_method;

typedef struct bl_class {
  struct bl_program* program;
  char *name, *parent;
  bl_method** methods;
  size_t method_count;
  char* file; /* where breve.class defines it; "": not known */
  uint32_t line;
  bool settled; /* in a draft: a program had it, and a class of that name replaces it */
} bl_class;

/* The text of a file or module. */
typedef struct bl_text {
  char *name, *bytes;
  size_t size;
} bl_text;

/* What one file defines: shared by the classes of a runtime, and the worlds that run it. */
typedef struct bl_program {
  int holders;
  breve_lua_config config;
  bl_text* texts; /* the first one is the file itself */
  size_t text_count;
  char** uses; /* modules in steve that `breve.use` names */
  size_t use_count;
  bl_class** classes;
  size_t class_count;
  int method_count;
  char* controller; /* NULL: none was named */
} bl_program;

bl_program* bl_program_new(const breve_lua_config* config, const char* name, const char* text, size_t size);
/* A program of the classes of a draft, whose methods are not described yet. NULL: there is no memory. The classes of
   the draft are settled. */
bl_program* bl_program_of_draft(bl_program* draft);
void bl_program_hold(bl_program* program);
void bl_program_drop(void* program);
/* NULL if there is none, or no memory. */
bl_class* bl_program_class(const bl_program* program, const char* name);
bl_text* bl_program_text(bl_program* program, const char* name);
bl_text* bl_program_add_text(bl_program* program, const char* name, const char* bytes, size_t size);
bool bl_program_add_use(bl_program* program, const char* name);
bl_class* bl_program_add_class(bl_program* program, const char* name, const char* parent);
bool bl_class_place(bl_class* owner, const char* file, uint32_t line);
bl_method* bl_class_add_method(bl_program* program, bl_class* owner, const char* name);
bl_method* bl_class_method(const bl_class* owner, const char* name);
/* A copy, with `from` replaced by `to`. */
char* bl_copy(const char* text, char from, char to);

/* ---- what belongs to one Lua state ---- */

typedef struct bl_lib {
  lua_State* main;
  struct bl_world* current;           /* whose code runs, or ran last; NULL: none yet */
  bl_program* loading;                /* its file is being run to be described; NULL: none is */
  bl_program* draft;                  /* in an interpreter: what breve.class adds to outside of files; NULL: nothing */
  breve_program* compiled;            /* ... the program of the draft; NULL: none yet, or the draft has changed */
  uint64_t changes;                   /* ... of the draft */
  bool running_file;                  /* a world's file is being run: its classes are not the world's yet */
  int vectors, matrices;              /* references of their metatables */
  int classes;                        /* ... of a table: name -> class table */
  int sorted_keys;                    /* ... of a function: the keys of a table, in order */
  int save_hook, load_hook;           /* functions of breve.on_save and breve.on_load, or LUA_NOREF */
  size_t steps;                       /* of patterns, not yet counted */
  struct bl_description* description; /* a file runs without a world, in a state of its own; NULL: none does */
} bl_lib;

/* Texts and stacks of a state, by the binary logarithms of their sizes, from a size on that takes time. */
#define BL_LOGARITHMS 48
typedef struct bl_weights {
  uint32_t counts[2][BL_LOGARITHMS];
  size_t most;          /* bytes that one instruction may go through */
  bool after_thread;    /* the next block is the stack of a thread */
  union bl_head* fresh; /* the block that was taken last, if nothing was given back since; NULL: none */
  size_t fresh_size;
} bl_weights;

/* What bounds a file that is run to be described, where no world does. */
typedef struct bl_description {
  lua_State* L;
  size_t used;    /* bytes */
  uint64_t turns; /* as in a world's budget */
  bool exhausted;
  bl_weights weights;
} bl_description;

/* ---- what belongs to one world ---- */

/* A method in Lua that runs; they stand on the C stack. */
typedef struct bl_entry {
  struct bl_entry* outer;
  const breve_call* call;
  lua_State* thread;
  const void* below; /* what was on top of the thread's calls before it; NULL: nothing */
  size_t frames;     /* of the profile, when it began */
  bool starts;       /* the profile has not yet seen its function */
} bl_entry;

typedef struct bl_place {
  char function[60], file[120];
  uint32_t line;
} bl_place;

typedef struct bl_pool bl_pool;
typedef struct bl_profile bl_profile;

typedef struct bl_world {
  bl_lib* lib;
  lua_State* L;
  lua_State* running; /* the thread that called breve last */
  breve_world* world;
  bl_program* program; /* whose classes the world has; NULL: none yet */
  bl_program* staged;  /* one that was run for a reload: it takes over when breve calls a method of it. NULL: none */
  int staged_classes, staged_functions; /* references, as below */
  bl_pool* pool;                        /* memory of a state of the world's own; NULL: the state is the host's */
  int objects;                          /* references of tables: index -> object */
  int metas;                            /* ... class -> metatable of its objects */
  int functions;                        /* ... number of a bl_method -> function */
  int handler;                          /* ... bl_handle_error, for this world */
  int raised;                           /* reference of the error that was raised last for a status of breve.h */
  breve_status raised_status;
  bool exhausted; /* the budget is used up */
  bl_entry* entry;
  const breve_call* failed; /* the call whose places are kept */
  bl_place places[BL_PLACES];
  size_t place_count;
  bl_profile* profile; /* NULL: none was taken yet */
} bl_world;

/* The world whose code runs. Raises an error if there is none. */
bl_world* bl_current(lua_State* L, bl_lib* lib);
bl_lib* bl_lib_of(lua_State* L); /* of an open library; NULL if it is not open */

/* ---- vectors and matrices (vectors.c) ---- */

typedef struct bl_vector {
  const void* tag;
  double v[3];
} bl_vector;

typedef struct bl_matrix {
  const void* tag;
  double m[9];
} bl_matrix;

/* What a value of Lua is, or NULL. */
bl_vector* bl_to_vector(lua_State* L, int index);
bl_matrix* bl_to_matrix(lua_State* L, int index);
double* bl_push_vector(lua_State* L, bl_lib* lib);
double* bl_push_matrix(lua_State* L, bl_lib* lib);
void bl_open_vectors(lua_State* L, bl_lib* lib); /* into the library's table, which is on top */

/* ---- values (values.c) ---- */

/* Texts in `value` are Lua's: good as long as the value of Lua is on the stack. Returns what is wrong, or NULL. It
   raises no error. */
const char* bl_to_value(lua_State* L, bl_world* w, int index, breve_value* value);
void bl_push_value(lua_State* L, bl_world* w, const breve_value* value);

/* ---- objects (objects.c) ---- */

/* The object that a value of Lua is; the null object if it is not an object. */
breve_object bl_to_object(lua_State* L, int index);
bool bl_is_object(lua_State* L, int index);
void bl_push_object(lua_State* L, bl_world* w, breve_object object);
breve_object bl_need_object(lua_State* L, int index); /* raises an error */
void bl_forget_classes(lua_State* L, bl_world* w);    /* metatables are made anew, for a new program */
void bl_object_gone(void* user, breve_object object);
void bl_switch_program(lua_State* L, bl_world* w); /* the staged program takes over */
/* Why a world does not run the classes of two files. */
void bl_two_files(char* text, size_t room, const bl_program* one, const bl_program* other);
/* Table of the methods of a class, on top: what it has besides those of breve. */
void bl_add_object_methods(lua_State* L, bl_world* w);

/* ---- calls (calls.c, methods.c, keywords.c) ---- */

/* Raise an error for a status of breve.h. */
int bl_fail(lua_State* L, bl_world* w, breve_status status);
/* Push a function that calls the methods of one name, which stand in `methods`. */
void bl_push_selector(lua_State* L, bl_world* w, const char* name, const char* super_of,
                      const breve_method_info* methods, size_t count);
breve_status bl_call_method(void* user, const breve_call* call, breve_value* result);
size_t bl_places(void* user, const breve_call* call, breve_place* places, size_t capacity);
int bl_handle_error(lua_State* L); /* message handler: keeps where an error was raised */
/* One letter too many, one too few, another one, or two that have changed places. */
bool bl_is_one_slip_apart(const char* a, const char* b);
/* Push the function of a method in Lua, which also takes a table of arguments by keyword if it has several parameters.
   @param known  the same method, as breve knows it */
void bl_push_lua_method(lua_State* L, bl_world* w, const bl_method* method, const breve_method_info* known);

/* ---- reasons (reasons.c) ---- */

/* Call `reason` once, if it is not NULL: with a text; with the error that a runtime has just kept; with the errors of
   the compilation of a program, at their places in Lua. */
void bl_tell(breve_write_fn reason, void* sink, const char* text);
void bl_tell_last(const breve_runtime* runtime, breve_status status, breve_write_fn reason, void* sink);
void bl_tell_errors(const breve_runtime* runtime, const bl_program* program, breve_write_fn reason, void* sink);

/* ---- worlds in an interpreter (config.c) ---- */

/* The table at index 1, which becomes the only value on the stack but for one at index 2 that holds what the config
   points to. Raises an error. */
breve_world_config bl_read_config(lua_State* L);

/* ---- profiles (profile.c) ---- */

/* breve calls a method while a profile is taken; the call is over, with or without a profile. */
void bl_profile_call(lua_State* L, bl_world* w, bl_entry* entry);
void bl_profile_return(bl_world* w, const bl_entry* entry);
void bl_profile_event(lua_State* L, lua_Debug* call); /* part of the hook */
/* The method of the program that a function of Lua is; NULL if it is not a method. Needs what lua_getinfo tells for
 * "Su". */
const bl_method* bl_method_at(const bl_program* program, const lua_Debug* function);
void bl_profile_destroy(bl_world* w);
/* A function in C calls breve for the Lua function that called it: tell its line, if a profile is taken. */
void bl_profile_line(lua_State* L, bl_world* w);

/* ---- classes (classes.c) ---- */

void bl_open_classes(lua_State* L, bl_lib* lib); /* into the library's table, which is on top */
int bl_describe_methods(lua_State* L);           /* a function of Lua, with the library as its upvalue */
/* The draft is not what its program was made of any more. */
void bl_draft_changed(bl_lib* lib);
/* Push the class table of that name, or nil. */
void bl_push_class(lua_State* L, bl_lib* lib, const char* name);
/* Push the function that a class table has itself under a name, or nil. */
void bl_push_own(lua_State* L, bl_lib* lib, const char* class_name, const char* name);

/* ---- memory (pools.c) ---- */

#define BL_MUCH (1 << 20) /* bytes: so much is counted at once */

void* bl_allocate(void* pool, void* block, size_t old_size, size_t new_size);                  /* lua_Alloc */
void* bl_allocate_described(void* description, void* block, size_t old_size, size_t new_size); /* likewise */
bl_pool* bl_pool_new(breve_world* world);
void bl_pool_destroy(bl_pool* pool);
void bl_pool_serve(bl_pool* pool, bl_world* w); /* the world that hears about large blocks; at first none */
uint64_t bl_pool_owed(bl_pool* pool);           /* bytes of large blocks, if they are many, and forgets them */
size_t bl_pool_weight(const bl_pool* pool);     /* bytes that one instruction may go through */

/* ---- state, libraries, snapshots ---- */

bl_lib* bl_open(lua_State* L); /* makes the library's table and leaves it on the stack */
/* Into the globals of a state of the world's own. */
void bl_open_safe_libraries(lua_State* L, bl_lib* lib, uint32_t allow);
void bl_open_order(lua_State* L);                 /* pairs and next */
void bl_open_patterns(lua_State* L, bl_lib* lib); /* find, match, gmatch, gsub of string */
void bl_open_metered(lua_State* L, bl_lib* lib);  /* what else works on much at once */
/* Count work, in loop iterations of steve; an error if the budget is used up, or a host interrupts. */
void bl_charge(lua_State* L, bl_lib* lib, uint64_t turns);
int bl_ordered_pairs(lua_State* L);
int bl_sorted_keys(lua_State* L);                  /* a function of Lua: the keys of a table, in order */
void bl_open_functions(lua_State* L, bl_lib* lib); /* breve.new and so on, into the table on top */
/* Run the file of a program with globals of its own, which begin as those of the state. It may raise an error. */
void bl_run_program(lua_State* L, bl_lib* lib, bl_program* program);
bool bl_save(void* user, breve_world* world, breve_write_fn write, void* sink, breve_write_fn reason,
             void* reason_sink);
bool bl_load(void* user, breve_world* world, const char* bytes, size_t size, bool commit);
breve_status bl_bind(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink);
lua_State* bl_description_open(bl_description* description); /* NULL: no memory */
void bl_count_anew(bl_world* w);                             /* a new call has a budget again */
void bl_set_hook(lua_State* L, bl_world* w, bool profiled);
/* Large blocks were taken: the next instruction counts them, and not the one that ends a piece. */
void bl_look_soon(bl_world* w);
/* Run the file of a program that is being described in a state. As breve_lua_add. */
breve_status bl_describe(lua_State* L, bl_lib* lib, bl_program* program, breve_write_fn reason, void* sink);
/* Give the classes of a program to a runtime, and compile a program of it if one is asked for. As breve_lua_compile. */
breve_status bl_register(breve_runtime* runtime, bl_program* program, breve_write_fn reason, void* sink);
breve_status bl_compile(breve_runtime* runtime, bl_program* program, breve_write_fn reason, void* sink,
                        breve_program** compiled);

#endif
