/* Vectors and matrices as values of Lua: small blocks of numbers, that never change, with operators. A vector is known
   by its size and a mark at its front, which costs less than to compare metatables. */
#include <math.h>
#include <string.h>

#include "binding.h"

static const char vector_mark = 'v', matrix_mark = 'm';

bl_vector* bl_to_vector(lua_State* L, int index) {
  bl_vector* v = lua_rawlen(L, index) == sizeof(bl_vector) ? (bl_vector*)lua_touserdata(L, index) : NULL;
  return v && v->tag == &vector_mark ? v : NULL;
}

bl_matrix* bl_to_matrix(lua_State* L, int index) {
  bl_matrix* m = lua_rawlen(L, index) == sizeof(bl_matrix) ? (bl_matrix*)lua_touserdata(L, index) : NULL;
  return m && m->tag == &matrix_mark ? m : NULL;
}

double* bl_push_vector(lua_State* L, bl_lib* lib) {
  bl_vector* v = (bl_vector*)lua_newuserdatauv(L, sizeof *v, 0);
  v->tag = &vector_mark;
  lua_rawgeti(L, LUA_REGISTRYINDEX, lib->vectors);
  lua_setmetatable(L, -2);
  return v->v;
}

double* bl_push_matrix(lua_State* L, bl_lib* lib) {
  bl_matrix* m = (bl_matrix*)lua_newuserdatauv(L, sizeof *m, 0);
  m->tag = &matrix_mark;
  lua_rawgeti(L, LUA_REGISTRYINDEX, lib->matrices);
  lua_setmetatable(L, -2);
  return m->m;
}

/* The result of an operator, whose metatable is its first upvalue. */
static double* new_vector(lua_State* L) {
  bl_vector* v = (bl_vector*)lua_newuserdatauv(L, sizeof *v, 0);
  v->tag = &vector_mark;
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_setmetatable(L, -2);
  return v->v;
}

static const double* need_vector(lua_State* L, int index) {
  const bl_vector* v = bl_to_vector(L, index);
  if (!v) luaL_typeerror(L, index, "vector");
  return v->v;
}

static int vector_add(lua_State* L) {
  const double *a = need_vector(L, 1), *b = need_vector(L, 2);
  double* r = new_vector(L);
  r[0] = a[0] + b[0], r[1] = a[1] + b[1], r[2] = a[2] + b[2];
  return 1;
}

static int vector_subtract(lua_State* L) {
  const double *a = need_vector(L, 1), *b = need_vector(L, 2);
  double* r = new_vector(L);
  r[0] = a[0] - b[0], r[1] = a[1] - b[1], r[2] = a[2] - b[2];
  return 1;
}

static int vector_scale(lua_State* L) {
  const bl_vector* v = bl_to_vector(L, 1);
  const double s = luaL_checknumber(L, v ? 2 : 1);
  const double* a = v ? v->v : need_vector(L, 2);
  double* r = new_vector(L);
  r[0] = a[0] * s, r[1] = a[1] * s, r[2] = a[2] * s;
  return 1;
}

static int vector_divide(lua_State* L) {
  const double *a = need_vector(L, 1), s = luaL_checknumber(L, 2);
  double* r = new_vector(L);
  r[0] = a[0] / s, r[1] = a[1] / s, r[2] = a[2] / s;
  return 1;
}

static int vector_negate(lua_State* L) {
  const double* a = need_vector(L, 1);
  double* r = new_vector(L);
  r[0] = -a[0], r[1] = -a[1], r[2] = -a[2];
  return 1;
}

static int vector_equal(lua_State* L) {
  const bl_vector *a = bl_to_vector(L, 1), *b = bl_to_vector(L, 2);
  lua_pushboolean(L, a && b && a->v[0] == b->v[0] && a->v[1] == b->v[1] && a->v[2] == b->v[2]);
  return 1;
}

static int vector_text(lua_State* L) {
  const double* a = need_vector(L, 1);
  lua_pushfstring(L, "(%f, %f, %f)", a[0], a[1], a[2]);
  return 1;
}

static int vector_length(lua_State* L) {
  const double* a = need_vector(L, 1);
  lua_pushnumber(L, sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
  return 1;
}

static int vector_dot(lua_State* L) {
  const double *a = need_vector(L, 1), *b = need_vector(L, 2);
  lua_pushnumber(L, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
  return 1;
}

static int vector_cross(lua_State* L) {
  const double *a = need_vector(L, 1), *b = need_vector(L, 2);
  double* r = new_vector(L);
  r[0] = a[1] * b[2] - a[2] * b[1], r[1] = a[2] * b[0] - a[0] * b[2], r[2] = a[0] * b[1] - a[1] * b[0];
  return 1;
}

/* Of length 1; the zero vector stays as it is. */
static int vector_unit(lua_State* L) {
  const double* a = need_vector(L, 1);
  const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), by = length > 0 ? length : 1;
  double* r = new_vector(L);
  r[0] = a[0] / by, r[1] = a[1] / by, r[2] = a[2] / by;
  return 1;
}

static int vector_unpack(lua_State* L) {
  const double* a = need_vector(L, 1);
  for (int i = 0; i < 3; ++i) lua_pushnumber(L, a[i]);
  return 3;
}

/* v.x, v[1], and the methods, which stand in the second upvalue. */
static int vector_index(lua_State* L) {
  const double* a = need_vector(L, 1);
  if (lua_type(L, 2) == LUA_TSTRING) {
    size_t size = 0;
    const char* key = lua_tolstring(L, 2, &size);
    if (size == 1 && key[0] >= 'x' && key[0] <= 'z') {
      lua_pushnumber(L, a[key[0] - 'x']);
      return 1;
    }
    lua_pushvalue(L, 2);
    lua_rawget(L, lua_upvalueindex(2));
    return 1;
  }
  const lua_Integer i = lua_isinteger(L, 2) ? lua_tointeger(L, 2) : 0;
  if (i < 1 || i > 3) return 0;
  lua_pushnumber(L, a[i - 1]);
  return 1;
}

static int unchangeable(lua_State* L) { return luaL_error(L, "vectors and matrices do not change: make a new one"); }

static int make_vector(lua_State* L) {
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = luaL_optnumber(L, i + 1, 0);
  memcpy(new_vector(L), v, sizeof v);
  return 1;
}

static const double* need_matrix(lua_State* L, int index) {
  const bl_matrix* m = bl_to_matrix(L, index);
  if (!m) luaL_typeerror(L, index, "matrix");
  return m->m;
}

static int matrix_equal(lua_State* L) {
  const bl_matrix *a = bl_to_matrix(L, 1), *b = bl_to_matrix(L, 2);
  bool same = a && b;
  for (int i = 0; i < 9 && same; ++i) same = a->m[i] == b->m[i];
  lua_pushboolean(L, same);
  return 1;
}

/* m[i] for i from 1 to 9, row by row. */
static int matrix_index(lua_State* L) {
  const double* a = need_matrix(L, 1);
  const lua_Integer i = lua_isinteger(L, 2) ? lua_tointeger(L, 2) : 0;
  if (i < 1 || i > 9) return 0;
  lua_pushnumber(L, a[i - 1]);
  return 1;
}

static int matrix_text(lua_State* L) {
  const double* a = need_matrix(L, 1);
  luaL_Buffer text;
  luaL_buffinit(L, &text);
  for (int i = 0; i < 9; ++i) {
    luaL_addstring(&text, i == 0 ? "[(" : i % 3 == 0 ? "), (" : ", ");
    lua_pushfstring(L, "%f", a[i]);
    luaL_addvalue(&text);
  }
  luaL_addstring(&text, ")]");
  luaL_pushresult(&text);
  return 1;
}

/* breve.matrix(a, b, c, d, e, f, g, h, i), row by row; without arguments the zero matrix. */
static int make_matrix(lua_State* L) {
  double m[9];
  for (int i = 0; i < 9; ++i) m[i] = luaL_optnumber(L, i + 1, 0);
  bl_matrix* made = (bl_matrix*)lua_newuserdatauv(L, sizeof *made, 0);
  made->tag = &matrix_mark;
  memcpy(made->m, m, sizeof m);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_setmetatable(L, -2);
  return 1;
}

static const luaL_Reg operators[] = {{"__add", vector_add},       {"__sub", vector_subtract},   {"__mul", vector_scale},
                                     {"__div", vector_divide},    {"__unm", vector_negate},     {"__eq", vector_equal},
                                     {"__tostring", vector_text}, {"__newindex", unchangeable}, {NULL, NULL}};
static const luaL_Reg methods[] = {{"length", vector_length}, {"dot", vector_dot},       {"cross", vector_cross},
                                   {"unit", vector_unit},     {"unpack", vector_unpack}, {NULL, NULL}};
static const luaL_Reg matrix_operators[] = {{"__eq", matrix_equal},
                                            {"__index", matrix_index},
                                            {"__tostring", matrix_text},
                                            {"__newindex", unchangeable},
                                            {NULL, NULL}};

static int new_metatable(lua_State* L, const char* name) {
  lua_newtable(L);
  lua_pushstring(L, name);
  lua_setfield(L, -2, "__name");
  lua_pushstring(L, name);
  lua_setfield(L, -2, "__metatable");
  lua_pushvalue(L, -1);
  return luaL_ref(L, LUA_REGISTRYINDEX);
}

void bl_open_vectors(lua_State* L, bl_lib* lib) {
  lib->vectors = new_metatable(L, "vector");
  lua_pushvalue(L, -1);
  luaL_setfuncs(L, operators, 1);
  lua_pushvalue(L, -1);
  lua_newtable(L);
  lua_pushvalue(L, -3);
  luaL_setfuncs(L, methods, 1);
  lua_pushcclosure(L, vector_index, 2);
  lua_setfield(L, -2, "__index");
  lua_pushcclosure(L, make_vector, 1);
  lua_setfield(L, -2, "vector");
  lib->matrices = new_metatable(L, "matrix");
  lua_pushvalue(L, -1);
  luaL_setfuncs(L, matrix_operators, 1);
  lua_pushcclosure(L, make_matrix, 1);
  lua_setfield(L, -2, "matrix");
}
