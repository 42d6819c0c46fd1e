/* Fields of many agents at once, from and to an array of the host. */
#include <stdio.h>
#include <string.h>

#include "binding.h"

/* On the stack of Lua during a transfer. */
enum { AT_JOB = 1, AT_FIELD = 2 };

typedef struct transfer {
  bl_world* w;
  const breve_object* objects;
  size_t count;
  const char* field;
  breve_array array; /* with its stride */
  bool writes;       /* into the fields */
  breve_status status;
} transfer;

static void* row(const transfer* t, size_t i) { return (char*)t->array.numbers + i * t->array.stride; }

static void put(const transfer* t, size_t i, const double* numbers) {
  for (uint32_t k = 0; k < t->array.width; ++k) {
    const float single = (float)numbers[k];
    const bool is_single = t->array.number == BREVE_NUMBER_FLOAT;
    const size_t size = is_single ? sizeof single : sizeof *numbers;
    memcpy((char*)row(t, i) + k * size, is_single ? (const void*)&single : (const void*)&numbers[k], size);
  }
}

static void get(const transfer* t, size_t i, double* numbers) {
  for (uint32_t k = 0; k < t->array.width; ++k) {
    float single;
    if (t->array.number == BREVE_NUMBER_FLOAT) {
      memcpy(&single, (const char*)row(t, i) + k * sizeof single, sizeof single);
      numbers[k] = (double)single;
    } else {
      memcpy(&numbers[k], (const char*)row(t, i) + k * sizeof *numbers, sizeof *numbers);
    }
  }
}

static int refuse(lua_State* L, transfer* t, size_t i, breve_status status, const char* why) {
  char number[24];
  snprintf(number, sizeof number, "%zu", i);
  t->status = status;
  lua_pushfstring(L, "objects[%s]: %s", number, why);
  return lua_error(L);
}

/* Push the agent and its field. */
static void push_field(lua_State* L, transfer* t, size_t i) {
  if (!breve_object_alive(t->w->world, t->objects[i]))
    refuse(L, t, i, BREVE_ERROR_STALE, "the object has been freed, or is one of another world");
  bl_push_object(L, t->w, t->objects[i]);
  lua_pushvalue(L, AT_FIELD);
  lua_rawget(L, -2);
}

static void check_field(lua_State* L, transfer* t, size_t i) {
  const bool numbers = t->array.width == 1;
  push_field(L, t, i);
  if (numbers ? lua_type(L, -1) != LUA_TNUMBER : !bl_to_vector(L, -1)) {
    const breve_status status = lua_isnil(L, -1) ? BREVE_ERROR_NOT_FOUND : BREVE_ERROR_TYPE;
    char why[160];
    snprintf(why, sizeof why, "the field '%.60s' is of type %s; rows of %s need a %s", t->field, luaL_typename(L, -1),
             numbers ? "1 number" : "3 numbers", numbers ? "number" : "vector");
    refuse(L, t, i, status, why);
  }
  lua_pop(L, 2);
}

static void read_field(lua_State* L, transfer* t, size_t i) {
  push_field(L, t, i);
  const double number = lua_tonumber(L, -1);
  put(t, i, t->array.width == 1 ? &number : bl_to_vector(L, -1)->v);
  lua_pop(L, 2);
}

/* A whole number stays an integer of Lua where the field had one. */
static void write_field(lua_State* L, transfer* t, size_t i) {
  double numbers[3];
  lua_Integer whole = 0;
  get(t, i, numbers);
  push_field(L, t, i);
  const bool was_whole = lua_isinteger(L, -1) != 0;
  lua_pop(L, 1);
  lua_pushvalue(L, AT_FIELD);
  if (t->array.width == 3)
    memcpy(bl_push_vector(L, t->w->lib), numbers, sizeof numbers);
  else if (was_whole && lua_numbertointeger(numbers[0], &whole) && (double)whole == numbers[0])
    lua_pushinteger(L, whole);
  else
    lua_pushnumber(L, numbers[0]);
  lua_rawset(L, -3);
  lua_pop(L, 1);
}

/* A function of Lua. All fields are checked before one is read or written. */
static int run_transfer(lua_State* L) {
  transfer* t = (transfer*)lua_touserdata(L, AT_JOB);
  lua_settop(L, AT_JOB);
  lua_pushstring(L, t->field);
  for (size_t i = 0; i < t->count; ++i) check_field(L, t, i);
  for (size_t i = 0; i < t->count; ++i) t->writes ? write_field(L, t, i) : read_field(L, t, i);
  return 0;
}

static size_t row_size(const breve_array* array) {
  return array->width * (array->number == BREVE_NUMBER_FLOAT ? sizeof(float) : sizeof(double));
}

static const char* wrong_array(const breve_array* array) {
  if (array->number > BREVE_NUMBER_DOUBLE) return "array.number is not a breve_number";
  if (array->width != 1 && array->width != 3) return "array.width must be 1 for numbers, 3 for vectors";
  if (array->stride != 0 && array->stride < row_size(array)) return "array.stride is less than a row";
  return array->numbers ? NULL : "array.numbers is NULL";
}

static breve_status transfer_all(const breve_world* world, const breve_object* objects, size_t count, const char* field,
                                 const breve_array* array, bool writes, breve_write_fn reason, void* sink) {
  if (!world || !field || !array || (!objects && count != 0)) return BREVE_ERROR_ARGUMENT;
  if (count == 0) return BREVE_OK;
  const char* wrong = wrong_array(array);
  if (wrong) {
    bl_tell(reason, sink, wrong);
    return BREVE_ERROR_ARGUMENT;
  }
  bl_world* w = (bl_world*)breve_world_state(world, BL_STATE);
  if (!w) {
    bl_tell(reason, sink, "the world has no class that is written in Lua");
    return BREVE_ERROR_NOT_FOUND;
  }
  transfer t = {w, objects, count, field, *array, writes, BREVE_ERROR_MEMORY};
  if (t.array.stride == 0) t.array.stride = row_size(array);
  lua_State* L = w->running;
  if (!lua_checkstack(L, 4)) return BREVE_ERROR_MEMORY;
  lua_pushcfunction(L, run_transfer);
  lua_pushlightuserdata(L, &t);
  if (lua_pcall(L, 1, 0, 0) == LUA_OK) return BREVE_OK;
  bl_tell(reason, sink, lua_isstring(L, -1) ? lua_tostring(L, -1) : breve_status_name(t.status));
  lua_pop(L, 1);
  return t.status;
}

breve_status breve_lua_objects_get(const breve_world* world, const breve_object* objects, size_t count,
                                   const char* field, const breve_array* array, breve_write_fn reason, void* sink) {
  return transfer_all(world, objects, count, field, array, false, reason, sink);
}

breve_status breve_lua_objects_set(breve_world* world, const breve_object* objects, size_t count, const char* field,
                                   const breve_array* array, breve_write_fn reason, void* sink) {
  return transfer_all(world, objects, count, field, array, true, reason, sink);
}
