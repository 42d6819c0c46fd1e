// What agents in Lua cost: 1,000 boids beside the same in plain Lua with a grid of its own, vectors beside tables, and
// a call of a native method. All in one process, with one Lua; CPU time, the least of several rounds. Claims: boids at
// most 0.5 times, vectors at most 0.8 times, a call at most 150 ns; the boids' places agree. Exits 1 if one does not
// hold.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <lua.hpp>
#include <sstream>
#include <string>

#include "breve/breve.hpp"
#include "breve/breve_lua.h"

namespace {

constexpr int kRounds = 5;
constexpr double kBoids = 0.5, kVectors = 0.8, kCall = 150;  // the claims
constexpr double kPlaces = 1e-9;
const std::string kFolder = BREVE_BENCH_FOLDER;

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The text of a program, which prints twelve decimals instead of the six that bench_language compares.
std::string text_of(const std::string& file) {
  std::ifstream in(kFolder + file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t at; (at = text.find("%.6f")) != std::string::npos;) text.replace(at, 4, "%.12f");
  return text;
}

int collect(lua_State* L) {
  auto& said = *static_cast<std::string*>(lua_touserdata(L, lua_upvalueindex(1)));
  said += std::string(luaL_checkstring(L, 1)) + '\n';
  return 0;
}

/// Seconds of a file in plain Lua, and what it prints.
double run_plain(const std::string& file, std::string& said) {
  lua_State* L = luaL_newstate();
  luaL_openlibs(L);
  lua_pushlightuserdata(L, &said);
  lua_pushcclosure(L, collect, 1);
  lua_setglobal(L, "print");
  luaL_dostring(L, ("package.path = '" + kFolder + "language/?.lua'").c_str());
  const double start = now();
  if (luaL_dostring(L, text_of(file).c_str()) != LUA_OK) std::printf("%s\n", lua_tostring(L, -1));
  const double seconds = now() - start;
  lua_close(L);
  return seconds;
}

void keep(void* user, breve_world*, breve_channel, const char* text, std::size_t size) {
  static_cast<std::string*>(user)->append(text, size);
}

/// A world of a file; what it prints goes to `said`.
breve::World world_of(const std::string& file, std::string& said) {
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &said;
  config.print = keep;
  auto runtime = breve::Runtime::create(config).or_throw();
  const std::string text = text_of(file);
  breve_program* program = nullptr;
  const auto note = [](void*, const char* why, std::size_t size) {
    std::printf("%.*s\n", static_cast<int>(size), why);
  };
  breve_lua_compile(runtime.get(), nullptr, file.c_str(), text.data(), text.size(), note, nullptr, &program);
  return runtime.world(breve::Program(program)).or_throw();
}

double run_boids(std::string& said) {
  const double start = now();
  breve::World world = world_of("lua/boids.lua", said);
  for (int i = 0; i < 50; ++i) world.step().or_throw();
  return now() - start;
}

double run_method(breve::World& world, const char* method, int count) {
  const double start = now();
  world.call(world.controller(), method, {{"count", count}}).or_throw();
  return now() - start;
}

/// The largest difference of two texts of numbers.
double difference(const std::string& a, const std::string& b) {
  std::istringstream left(a), right(b);
  double largest = 0, x = 0, y = 0;
  int count = 0;
  for (; left >> x && right >> y; ++count) largest = std::max(largest, std::abs(x - y));
  return count == 3000 ? largest : INFINITY;
}

bool row(const char* what, double got, double most, const char* unit) {
  std::printf("%-44s %8.3g %s (at most %g)\n", what, got, unit, most);
  return got <= most;
}

}  // namespace

int main() {
  double plain_boids = 1e9, boids = 1e9, tables = 1e9, vectors = 1e9, empty = 1e9, calls = 1e9;
  std::string plain_said, said, ignored;
  constexpr int kIterations = 1'000'000;
  breve::World world = world_of("lua/vectors.lua", ignored);
  for (int round = 0; round < kRounds; ++round) {
    plain_said.clear(), said.clear();
    plain_boids = std::min(plain_boids, run_plain("language/boids.lua", plain_said));
    boids = std::min(boids, run_boids(said));
    tables = std::min(tables, run_plain("language/vectors.lua", ignored));
    vectors = std::min(vectors, run_method(world, "turn", kIterations));
    empty = std::min(empty, run_method(world, "empty", kIterations));
    calls = std::min(calls, run_method(world, "call-native", kIterations));
  }
  bool good = row("1,000 boids, 50 iterations, over plain Lua", boids / plain_boids, kBoids, "x");
  good = row("largest difference of their places", difference(plain_said, said), kPlaces, " ") && good;
  good = row("vectors, 1e6 turns, over tables", vectors / tables, kVectors, "x") && good;
  good = row("a call of a native method", (calls - empty) / kIterations * 1e9, kCall, "ns") && good;
  return good ? 0 : 1;
}
