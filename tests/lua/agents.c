/* Agents in Lua: classes, calls both ways, values, errors. Run with each build of Lua. */
#include "scene.h"

#define MAIN "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"

static void classes_in_lua_derive_from_the_library(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN "local Bird = breve.class('Bird', 'Mobile')\n"
               "function Bird:init() self.age = 0 self:set_velocity(breve.vector(1, 0, 0)) end\n"
               "function Bird:iterate() self.age = self.age + 1 end\n"
               "function Main:init() self:set_iteration_step(1) self:set_integration_step(1) self.bird = Bird() end\n"
               "function Main:age() return self.bird.age end\n"
               "function Main:x() return self.bird:get_location().x end\n",
          NULL))
    return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_NEAR(2, stage_number(&s, "age"), 0);
  CHECK_NEAR(2, stage_number(&s, "x"), 1e-12);
  CHECK_TEXT("", s.told);
  stage_end(&s);
}

/* One selector in all ways of calling it. */
static void selectors_map_by_one_rule(void) {
  stage s;
  stage_begin(&s);
  s.steve =
      "@use Control.\n"
      "Control : Base {\n"
      "  + to add-up first a (float) second b (float): return a - b.\n"
      "  + to scale by f (float): return f * 2.\n"
      "  + to with-default by f = 4 (float): return f.\n"
      "  + to call-lua: return (self mix-up left 7 right 2).\n"
      "  + to call-single: return (self halve value 9.0).\n"
      "}\n";
  if (!stage_open(&s,
                  "breve.use 'Steve.tz'\n"
                  "local Main = breve.class('Main', 'Base')\nbreve.main(Main)\n"
                  "function Main:named() return self:add_up{first = 5, second = 3} end\n"
                  "function Main:single() return self:scale(4) end\n"
                  "function Main:defaulted() return self:with_default() end\n"
                  "function Main:mix_up(left, right) return left * 10 + right end\n"
                  "function Main:halve(value) return value / 2 end\n"
                  "function Main:both() return self:mix_up(1, 2) * 100 + self:mix_up{right = 4, left = 3} end\n"
                  "function Main:missing() return self:add_up{first = 5} end\n"
                  "function Main:too_many() return self:scale(1, 2) end\n"
                  "function Main:unknown() return self:nothing() end\n",
                  NULL))
    return;
  CHECK_NEAR(2, stage_number(&s, "named"), 0);
  CHECK_NEAR(8, stage_number(&s, "single"), 0);
  CHECK_NEAR(4, stage_number(&s, "defaulted"), 0);
  CHECK_NEAR(72, stage_number(&s, "call-lua"), 0);
  CHECK_NEAR(4.5, stage_number(&s, "call-single"), 0);
  CHECK_NEAR(1234, stage_number(&s, "both"), 0);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "missing", NULL));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "too-many", NULL));
  CHECK(strstr(breve_world_last_error(s.world)->message, "scale(by)") != NULL);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "unknown", NULL));
  stage_end(&s);
}

/* steve derives from Lua, which derives from steve; each calls the other's methods, and super. */
static void languages_derive_from_each_other(void) {
  stage s;
  stage_begin(&s);
  s.steve =
      "@use Mobile.\n"
      "Mobile : Animal { + to legs: return 4. + to speed at t (float): return t. }\n"
      "Bird : Eagle { + to legs: return (super legs) + 100. + to speed at t (float): return (super speed at t) * 2. "
      "}\n";
  if (!stage_open(
          &s,
          "breve.use 'Steve.tz'\n" MAIN "local Bird = breve.class('Bird', 'Animal')\n"
          "function Bird:legs() return Bird.super.legs(self) / 2 end\n"
          "function Bird:speed(t) return Bird.super.speed(self, t + 1) end\n" /* keyword `at`, as it overrides */
          "local Hen = breve.class('Hen', Bird)\n"
          "function Hen:legs() return Hen.super.legs(self) + 0.5 end\n"
          "function Main:bird() return Bird():legs() end\n"
          "function Main:hen() return Hen():legs() end\n"
          "function Main:eagle() return breve.new('Eagle'):legs() end\n"
          "function Main:eagle_speed() return breve.new('Eagle'):speed(3) end\n"
          "function Main:kinds() local e = breve.new('Eagle') "
          "return (e:is_a(Bird) and 1 or 0) + (e:is_a('Animal') and 10 or 0) + (e:is_a(Hen) and 100 or 0) + "
          "(e:class_name() == 'Eagle' and 1000 or 0) end\n",
          NULL))
    return;
  CHECK_NEAR(2, stage_number(&s, "bird"), 0);
  CHECK_NEAR(2.5, stage_number(&s, "hen"), 0);
  CHECK_NEAR(102, stage_number(&s, "eagle"), 0);
  CHECK_NEAR(8, stage_number(&s, "eagle-speed"), 0);
  CHECK_NEAR(1011, stage_number(&s, "kinds"), 0);
  stage_end(&s);
}

static void note_reason(void* sink, const char* text, size_t size) {
  char* const why = sink;
  const size_t length = strlen(why), room = 511 - length;
  strncat(why, text, size < room ? size : room);
}

/* The reason for which a file cannot be added; the classes of the runtime stay as they are. */
static void not_added(stage* s, const char* text, size_t size, const char* part) {
  char why[512] = "";
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_lua_add(s->runtime, NULL, "wrong.lua", text, size, note_reason, why));
  if (!CHECK(strstr(why, part) != NULL)) printf("%s\n", why);
}

/* A program in steve has the classes of a file in Lua that was added before. */
static void classes_of_a_file_are_added_for_programs_in_steve(void) {
  static const char* const birds[] = {
      "local Bird = breve.class('Bird', 'Mobile')\nfunction Bird:legs() return 2 end\n",
      "local Bird = breve.class('Bird', 'Mobile')\nfunction Bird:legs() return 3 end\n"};
  static const char* const broken = "breve.class('Bird', 'Mobile')\nerror('broken')";
  static const char* const text =
      "@use Control.\n@use Bird.\nController Field.\n"
      "Bird : Griffin { + to legs: return (super legs) + 2. }\n"
      "Control : Field { + to count: return ((new Griffin) legs) * 10 + ((new Bird) legs). }\n";
  const double expected[] = {42, 53};
  stage s;
  stage_begin(&s);
  /* A later file replaces a class of that name. A wrong file replaces nothing. */
  for (int i = 0; i < 2; ++i) {
    CHECK_STATUS(BREVE_OK, breve_lua_add(s.runtime, NULL, "bird.lua", birds[i], strlen(birds[i]), NULL, NULL));
    not_added(&s, "function (", 10, "wrong.lua:1");
    not_added(&s, "\033Lua", 4, "wrong.lua: this is bytecode");
    not_added(&s, broken, strlen(broken), "broken");
    if (!CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "field.tz", text, strlen(text), &s.program))) break;
    if (!CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &s.world))) break;
    CHECK_NEAR(expected[i], stage_number(&s, "count"), 0);
    CHECK_STATUS(BREVE_OK, breve_world_destroy(s.world));
    breve_program_destroy(s.program);
    s.world = NULL;
    s.program = NULL;
  }
  breve_lua_config config = breve_lua_config_default();
  config.allow = 1u << 9;
  const char* const bird = birds[0];
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_add(s.runtime, &config, "bird.lua", bird, strlen(bird), NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_add(NULL, NULL, "bird.lua", bird, strlen(bird), NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_add(s.runtime, NULL, NULL, bird, strlen(bird), NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_add(s.runtime, NULL, "bird.lua", NULL, 1, NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_lua_add(s.runtime, NULL, "empty.lua", NULL, 0, NULL, NULL));
  stage_end(&s);
}

/* Classes of two files in one program are refused; after a reload, calls of the earlier one's are errors. */
static void a_world_runs_the_classes_of_one_file(void) {
  static const char* const files[] = {
      "breve.class('Bird', 'Mobile')\nlocal Bird = breve.class('Hen', 'Bird')\n"
      "function Bird:legs() return 2 end\n",
      "local Spider = breve.class('Spider', 'Mobile')\n"
      "function Spider:legs() return 8 end\n"};
  static const char* const one =
      "@use Control.\n@use Hen.\nController Field.\n"
      "Control : Field { + to count: return ((new Hen) legs). }\n";
  static const char* const both =
      "@use Control.\n@use Hen.\n@use Spider.\nController Field.\n"
      "Control : Field { + to count: return ((new Hen) legs) + ((new Spider) legs). }\n";
  stage s;
  breve_program* program = NULL;
  stage_begin(&s);
  CHECK_STATUS(BREVE_OK, breve_lua_add(s.runtime, NULL, "hen.lua", files[0], strlen(files[0]), NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_lua_add(s.runtime, NULL, "spider.lua", files[1], strlen(files[1]), NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "both.tz", both, strlen(both), &program));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_world_create(s.runtime, program, NULL, &s.world));
  const char* why = breve_runtime_last_error(s.runtime)->message;
  if (!CHECK(strstr(why, "hen.lua") && strstr(why, "spider.lua") && strstr(why, "require"))) printf("%s\n", why);
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "one.tz", one, strlen(one), &s.program));
  if (CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &s.world))) {
    CHECK_NEAR(2, stage_number(&s, "count"), 0);
    CHECK_STATUS(BREVE_OK, breve_world_reload(s.world, program));
    /* The Spider's file takes over at its first call, as a changed file does; then the Hen has no methods any more. */
    CHECK_NEAR(10, stage_number(&s, "count"), 0);
    breve_value result;
    CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "count", &result));
    why = breve_world_last_error(s.world)->message;
    if (!CHECK(strstr(why, "require the other") != NULL)) printf("%s\n", why);
  }
  breve_program_destroy(program);
  stage_end(&s);
}

static void values_of_each_type_go_both_ways(void) {
  stage s;
  stage_begin(&s);
  s.steve =
      "@use Control.\n"
      "Control : Base {\n"
      "  + variables: kept (list). table (hash). m (matrix).\n"
      "  + to keep those l (list): kept = l. return |kept|.\n"
      "  + to get-kept: return kept.\n"
      "  + to third: return kept{2}.\n"
      "  + to look-up from h (hash): return h{\"b\"}.\n"
      "  + to make-table: table{\"x\"} = 5. table{7} = \"seven\". return table.\n"
      "  + to get-matrix: return [(1, 2, 3), (4, 5, 6), (7, 8, 9)].\n"
      "  + to echo of l (list): return l{0}.\n"
      "}\n";
  if (!stage_open(
          &s,
          "breve.use 'Steve.tz'\nlocal Main = breve.class('Main', 'Base')\nbreve.main(Main)\n"
          "function Main:some_lists() local n = self:keep{1, 'two', breve.vector(1, 2, 3)} "
          "  local back = self:get_kept() "
          "  return n == 3 and #back == 3 and back[1] == 1 and back[2] == 'two' and back[3] == breve.vector(1, 2, 3) "
          "end\n"
          "function Main:some_hashes() local t = self:make_table() "
          "  return self:look_up({a = 1, b = 6}) == 6 and t.x == 5 and t[7] == 'seven' end\n"
          "function Main:some_matrices() local m = self:get_matrix() return m[1] == 1 and m[6] == 6 and m[9] == 9 end\n"
          "function Main:some_objects() return self:echo{self} == self and self:echo{breve.controller()} == self end\n"
          "function Main:numbers() return math.type(self:echo{3}) == 'integer' and math.type(self:echo{3.0}) == "
          "'float' "
          "  and self:echo{2^40} == 2^40 and self:echo{true} == 1 and self:echo{'a\\0b'} == 'a\\0b' end\n"
          "function Main:nested() local t = self:echo{{1, {2, {3}}}} return t[2][2][1] == 3 end\n"
          "function Main:cycle() local t = {} t[1] = t return pcall(self.echo, self, t) == false end\n"
          "function Main:functions() return pcall(self.echo, self, {print}) == false end\n",
          NULL))
    return;
  static const char* const all[] = {"some-lists", "some-hashes", "some-matrices", "some-objects",
                                    "numbers",    "nested",      "cycle",         "functions"};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
    if (!CHECK_NEAR(1, stage_number(&s, all[i]), 0)) printf("  %s\n", all[i]);
  stage_end(&s);
}

static void vectors_have_operators(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN "local v = breve.vector\n"
               "function Main:sums() return v(1, 2, 3) + v(1, 1, 1) - v(0, 0, 1) == v(2, 3, 3) and -v(1, 0, 0) == "
               "v(-1, 0, 0) end\n"
               "function Main:products() return v(1, 2, 3) * 2 == v(2, 4, 6) and 2 * v(1, 2, 3) == v(2, 4, 6) and v(2, "
               "4, 6) / 2 == v(1, 2, 3) "
               "  and v(1, 2, 3):dot(v(1, 1, 1)) == 6 and v(1, 0, 0):cross(v(0, 1, 0)) == v(0, 0, 1) end\n"
               "function Main:parts() local x, y, z = v(1, 2, 3):unpack() return x == 1 and y == 2 and z == 3 and v(4, "
               "5, 6).y == 5 and v(4, 5, 6)[3] == 6 "
               "  and v(3, 4, 0):length() == 5 and v(0, 3, 0):unit() == v(0, 1, 0) and v(0, 0, 0):unit() == v() end\n"
               "function Main:refusals() return not pcall(function() return v(1, 2, 3) + 1 end) and not "
               "pcall(function() return v() * v() end) "
               "  and not pcall(function() local a = v() a.x = 1 end) and not pcall(v, 'x') and v(1, 2, 3) ~= 5 and "
               "v().w == nil end\n"
               "function Main:texts() return tostring(v(1, 2.5, 3)) == '(1.0, 2.5, 3.0)' end\n",
          NULL))
    return;
  static const char* const all[] = {"sums", "products", "parts", "refusals", "texts"};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
    if (!CHECK_NEAR(1, stage_number(&s, all[i]), 0)) printf("  %s\n", all[i]);
  stage_end(&s);
}

/* Lua calls steve calls Lua, and there it fails. */
static void errors_have_one_chain_of_both_languages(void) {
  stage s;
  stage_begin(&s);
  s.steve = "@use Control.\nControl : Base {\n  + to middle:\n    return (self inner by 2).\n}\n";
  if (!stage_open(&s,
                  "breve.use 'Steve.tz'\nlocal Main = breve.class('Main', 'Base')\nbreve.main(Main)\n"
                  "local function helper(n)\n" /* line 4 */
                  "  if n > 1 then error('too deep') end\n"
                  "end\n"
                  "function Main:inner(by)\n" /* line 7 */
                  "  helper(by)\n"
                  "end\n"
                  "function Main:outer()\n"
                  "  local x = self:middle()\n" /* line 11 */
                  "  return x\n"
                  "end\n",
                  NULL))
    return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "outer", NULL));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK_TEXT("too deep", error->message);
  CHECK_TEXT("agents.lua", error->file);
  CHECK(error->line == 5);
  CHECK(error->frame_count == 4);
  if (error->frame_count == 4) {
    CHECK_TEXT("helper", error->frames[0].method);
    CHECK_TEXT("inner", error->frames[1].method);
    CHECK(error->frames[1].line == 8 && strcmp(error->frames[1].file, "agents.lua") == 0);
    CHECK_TEXT("middle", error->frames[2].method);
    CHECK(error->frames[2].line == 4 && strcmp(error->frames[2].file, "Steve.tz") == 0);
    CHECK_TEXT("outer", error->frames[3].method);
    CHECK(error->frames[3].line == 11);
  }
  stage_end(&s);
}

/* A steve method fails that Lua has called; Lua may catch it, or hand it on. */
static void errors_of_steve_pass_through_lua(void) {
  stage s;
  stage_begin(&s);
  s.steve = "@use Control.\nControl : Base {\n  + to fail-here:\n    return 1 / 0.\n}\n";
  if (!stage_open(&s,
                  "breve.use 'Steve.tz'\nlocal Main = breve.class('Main', 'Base')\nbreve.main(Main)\n"
                  "function Main:caught() local good, why = pcall(self.fail_here, self) return not good and "
                  "why:find('zero') ~= nil end\n"
                  "function Main:handed_on() return self:fail_here() end\n",
                  NULL))
    return;
  CHECK_NEAR(1, stage_number(&s, "caught"), 0);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "handed-on", NULL));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK_TEXT("Steve.tz", error->file);
  CHECK(error->line == 4 && error->frame_count == 2);
  stage_end(&s);
}

static void objects_are_one_table_as_long_as_they_live(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(&s,
                  MAIN "local Bird = breve.class('Bird', 'Mobile')\n"
                       "function Main:same() local a = Bird{name = 'x'} local b = breve.objects(Bird)[1] return a == b "
                       "and b.name == 'x' end\n"
                       "function Main:gone() local a = Bird() a:free() local ok = pcall(a.get_location, a) "
                       "  return not ok and not breve.alive(a) and tostring(a) == 'an object that is gone' end\n"
                       "function Main:fresh() local a = Bird{mark = 1} a:free() local b = Bird() return b.mark == nil "
                       "and b ~= a end\n"
                       "function Main:set_unknown() breve.set(self, 'x', 1) end\n"
                       "function Main:forged() return not pcall(Bird.super.get_location, {[0] = 12345}) and not "
                       "pcall(Bird.super.get_location, 5) end\n",
                  NULL))
    return;
  static const char* const all[] = {"same", "gone", "fresh", "forged"};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
    if (!CHECK_NEAR(1, stage_number(&s, all[i]), 0)) printf("  %s\n", all[i]);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "set-unknown", NULL));
  stage_end(&s);
}

static void neighbors_come_with_place_and_velocity(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN "local Bird = breve.class('Bird', 'Mobile')\n"
               "function Main:init() for i = 1, 4 do local b = Bird() b:move(breve.vector(i, 0, 0)) "
               "  b:set_velocity(breve.vector(0, i, 0)) b:set_neighborhood_size(1.5) end self:update_neighbors() end\n"
               "function Main:sum() local b, sum = breve.objects(Bird)[2], 0 "
               "  for bird, x, y, z, vx, vy, vz in b:neighbors() do sum = sum + x * 100 + vy if bird == b then return "
               "-1 end end return sum end\n"
               "function Main:freed() local b, count = breve.objects(Bird)[2], 0 "
               "  for bird in b:neighbors() do count = count + 1 breve.objects(Bird)[3]:free() end return count end\n",
          NULL))
    return;
  CHECK_NEAR(404, stage_number(&s, "sum"), 0);
  CHECK_NEAR(1, stage_number(&s, "freed"), 0);
  stage_end(&s);
}

static void handlers_and_schedules_reach_methods_in_lua(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN
          "local Bird = breve.class('Bird', 'Mobile')\n"
          "function Bird:hit(other) self.hits = (self.hits or 0) + 1 self.other = other return 0 end\n"
          "function Bird:later() self.late = breve.time() end\n"
          "function Main:init() self:set_iteration_step(0.1) self:set_integration_step(0.1)\n"
          "  self.a, self.b = Bird(), Bird() self.a:move(breve.vector(-2, 0, 0)) self.b:move(breve.vector(2, 0, 0))\n"
          "  self.a:set_velocity(breve.vector(5, 0, 0))\n"
          "  self.a:handle_collisions{with_type = 'Bird', with_method = 'hit'}\n"
          "  self.a:schedule{method_call = 'later', at_time = 0.3} end\n"
          "function Main:hits() return self.a.hits == 1 and self.a.other == self.b or (self.a.hits or 0) > 0 end\n"
          "function Main:late() return self.a.late end\n",
          NULL))
    return;
  for (int i = 0; i < 8; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_NEAR(1, stage_number(&s, "hits"), 0);
  CHECK_NEAR(0.3, stage_number(&s, "late"), 1e-9);
  CHECK_TEXT("", s.told);
  stage_end(&s);
}

static void files_that_are_wrong_are_refused_with_a_reason(void) {
  static const char* const texts[] = {
      "this is not Lua",
      "breve.main('X') error('stop')",
      "local x = 1",
      "breve.class('Two Words') breve.main('Two Words')",
      "breve.class('A', 'Mobile') breve.class('A', 'Mobile')",
      "breve.main(breve.class('A', 'Nobody'))",
      "\033LuaS",
      "breve.new('Mobile')",
      "while true do end",
      "local A = breve.class('A', 'Control') breve.main(A) function A:f(a, b, c, d, e, f, g, h, i) end",
      "require 'nowhere'"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
    stage s;
    stage_begin(&s);
    const breve_status status = stage_compile(&s, texts[i]);
    CHECK(status == BREVE_ERROR_COMPILE || status == BREVE_ERROR_ARGUMENT);
    if (!CHECK(s.why[0] != 0)) printf("  %s\n", texts[i]);
    stage_end(&s);
  }
}

static void modules_are_found_through_the_host(void) {
  stage s;
  stage_begin(&s);
  s.module = "loads = (loads or 0) + 1 return {answer = 42 + loads}";
  if (!stage_open(
          &s,
          "local extra = require 'extra'\nassert(extra == require 'extra')\nassert(require 'breve' == breve)\n" MAIN
          "function Main:answer() return extra.answer end\n",
          NULL))
    return;
  CHECK_NEAR(43, stage_number(&s, "answer"), 0);
  stage_end(&s);
}

/* Finds a node by a path of "Class.method" or "function:line" below the root. If there is none, its calls are 0. */
static breve_profile_node node_at_path(breve_world* world, const char* const* path, size_t length) {
  breve_profile_node node, none;
  size_t count = 0, at = 0;
  memset(&none, 0, sizeof none);
  CHECK_STATUS(BREVE_OK, breve_world_profile_node_count(world, &count));
  for (size_t step = 0; step < length; ++step) {
    size_t found = 0;
    for (size_t i = at + 1; i < count && found == 0; ++i) {
      char name[200];
      if (breve_world_profile_node(world, i, &node) != BREVE_OK) return none;
      if (node.class_name[0] != 0 || node.line == 0)
        sprintf(name, "%s%s%s", node.class_name, node.class_name[0] ? "." : "", node.name);
      else
        sprintf(name, "%s:%u", node.name, (unsigned)node.line);
      if (node.parent == at && strcmp(name, path[step]) == 0) found = i;
    }
    if (found == 0) return none;
    at = found;
  }
  return breve_world_profile_node(world, at, &node) == BREVE_OK ? node : none;
}

/* What runs in an iteration, with the lines of this program. */
static const char* const profiled_program =
    "breve.use 'Steve.tz'\n" MAIN                                                  /* 1 to 3 */
    "local Bird = breve.class('Bird', 'Animal')\n"                                 /* 4 */
    "local function helper(n) return n + 1 end\n"                                  /* 5 */
    "local function walk() coroutine.yield() helper(1) end\n"                      /* 6 */
    "local function fall() helper(0) error('fallen') end\n"                        /* 7 */
    "local function last() return helper(2) end\n"                                 /* 8 */
    "function Bird:init() self.sum = 0 end\n"                                      /* 9 */
    "function Bird:add_up(n) self.sum = helper(self.sum) + n end\n"                /* 10 */
    "function Bird:answer() return 42 end\n"                                       /* 11 */
    "function Bird:iterate()\n"                                                    /* 12 */
    "  self:add_up(1) self:add_up(2)\n"                                            /* 13 */
    "  self:legs()\n"                                                              /* 14 */
    "  self:ask()\n"                                                               /* 15 */
    "  pcall(fall)\n"                                                              /* 16 */
    "  local c = coroutine.create(walk) coroutine.resume(c) coroutine.resume(c)\n" /* 17 */
    "  return last()\n"                                                            /* 18 */
    "end\n"
    "function Main:init() self.bird = Bird() end\n";

static void check_profile(breve_world* world) {
#define BIRD "iteration", "script", "Bird.iterate"
  static const char* const iterate[] = {BIRD};
  static const char* const add[] = {BIRD, "Bird.add-up"};
  static const char* const helper[] = {BIRD, "Bird.add-up", "helper:5"};
  static const char* const legs[] = {BIRD, "Animal.legs"};
  static const char* const answer[] = {BIRD, "Animal.ask", "Bird.answer"};
  static const char* const fall[] = {BIRD, "function:7"}; /* a call by C has no name for it */
  static const char* const walk[] = {BIRD, "function:6"};
  static const char* const last[] = {BIRD, "function:8"}; /* nor has a tail call */
  breve_profile_node n = node_at_path(world, iterate, 3);
  CHECK(n.calls == 5 && n.line == 12 && n.kind == BREVE_PROFILE_METHOD && strstr(n.file, ".lua") != NULL);
  n = node_at_path(world, add, 4);
  CHECK(n.calls == 10 && n.line == 10 && n.call_line == 13 && n.kind == BREVE_PROFILE_METHOD);
  n = node_at_path(world, helper, 5);
  CHECK(n.calls == 10 && n.call_line == 10 && n.kind == BREVE_PROFILE_FUNCTION && strstr(n.file, ".lua") != NULL);
  n = node_at_path(world, legs, 4);
  CHECK(n.calls == 5 && n.call_line == 14);
  CHECK_TEXT("Steve.tz", n.file);
  n = node_at_path(world, answer, 5);
  CHECK(n.calls == 5 && n.line == 11);
  CHECK(node_at_path(world, fall, 4).calls == 5);
  CHECK(node_at_path(world, walk, 4).calls == 5);
  CHECK(node_at_path(world, last, 4).calls == 5);
#undef BIRD
}

static void profiles_have_methods_of_both_languages(void) {
  static const char* const iterate[] = {"iteration", "script", "Bird.iterate"};
  uint64_t hashes[2] = {0, 1};
  for (int profiled = 0; profiled < 2; ++profiled) {
    stage s;
    breve_world_config config = breve_world_config_default();
    stage_begin(&s);
    s.steve = "@use Mobile.\nMobile : Animal {\n+ to legs: return 4.\n+ to ask: return (self answer).\n}\n";
    config.profile = profiled;
    config.budget = 1000000;
    if (!stage_open(&s, profiled_program, &config)) return;
    for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hashes[profiled]));
    CHECK_TEXT("", s.told);
    if (profiled) {
      check_profile(s.world);
      CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
      CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
      CHECK(node_at_path(s.world, iterate, 3).calls == 5);
      CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
      for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
      check_profile(s.world);
    }
    stage_end(&s);
  }
  CHECK(hashes[0] == hashes[1]);
}

int main(void) {
  RUN(classes_in_lua_derive_from_the_library);
  RUN(selectors_map_by_one_rule);
  RUN(languages_derive_from_each_other);
  RUN(classes_of_a_file_are_added_for_programs_in_steve);
  RUN(a_world_runs_the_classes_of_one_file);
  RUN(values_of_each_type_go_both_ways);
  RUN(vectors_have_operators);
  RUN(errors_have_one_chain_of_both_languages);
  RUN(errors_of_steve_pass_through_lua);
  RUN(objects_are_one_table_as_long_as_they_live);
  RUN(neighbors_come_with_place_and_velocity);
  RUN(handlers_and_schedules_reach_methods_in_lua);
  RUN(files_that_are_wrong_are_refused_with_a_reason);
  RUN(modules_are_found_through_the_host);
  RUN(profiles_have_methods_of_both_languages);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
