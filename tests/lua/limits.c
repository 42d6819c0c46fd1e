/* What bounds agents in Lua: budget, memory, the sandbox; what a snapshot holds; a changed file. */
#include <stdlib.h>

#include "scene.h"

#define MAIN "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"

static bool open_bounded(stage* s, const char* text, uint64_t budget) {
  breve_world_config config = breve_world_config_default();
  stage_begin(s);
  config.budget = budget;
  return stage_open(s, text, &config);
}

static void loops_count_in_the_budget(void) {
  stage s;
  if (!open_bounded(&s,
                    MAIN "function Main:endless() while true do end end\n"
                         "function Main:caught() while true do pcall(function() while true do end end) end end\n"
                         "function Main:threads() local f = coroutine.wrap(function() while true do end end) f() end\n"
                         "function Main:short() for i = 1, 1000 do end return 1 end\n",
                    100000))
    return;
  CHECK_STATUS(BREVE_ERROR_BUDGET, stage_call(&s, "endless", NULL));
  CHECK_STATUS(BREVE_ERROR_BUDGET, stage_call(&s, "caught", NULL));
  const breve_status inside = stage_call(&s, "threads", NULL);
  CHECK(inside == BREVE_ERROR_BUDGET || inside == BREVE_ERROR_SCRIPT);
  CHECK_NEAR(1, stage_number(&s, "short"), 0);
  stage_end(&s);
}

/* Functions of Lua's libraries work at one stretch. Without being counted, each of these would go on for minutes to
 * ages. */
static void functions_of_libraries_count_in_the_budget(void) {
  static const char* const works[] = {
      "('a'):rep(30000):find(('.-'):rep(30) .. 'b')",
      "('a'):rep(30000):match(('a*'):rep(20) .. 'b')",
      "for w in ('a'):rep(30000):gmatch(('a?'):rep(30) .. ('a'):rep(30) .. 'b') do end",
      "('('):rep(100000):gsub('%b()', '')",
      "local s = ('a'):rep(1000000) while true do s:find(('a'):rep(1000) .. 'b', 1, true) end",
      "('').rep('', 1e15)",
      "local t = {} for i = 1, 50000 do t[i] = i end while true do table.insert(t, 1, 0) end",
      "local t = {} for i = 1, 50000 do t[i] = i end while true do table.remove(t, 1) t[#t + 1] = 1 end",
      "table.move({}, 1, 1e15, 2)",
      "local t = {} for i = 1, 50000 do t[i] = i % 7 end while true do table.sort(t) end",
      "local t = {} for i = 1, 50000 do t[i] = '' end while true do table.concat(t) end",
      "local t = {} for i = 1, 50000 do t[i] = i end while true do table.unpack(t) end",
      "local t = {} for i = 1, 50000 do t['k' .. i] = i end while true do next(t) end",
      "local t = {} for i = 1, 50000 do t[i] = i end while true do pairs(t) end",
      "local s = ('x'):rep(1000000) while true do s:byte(1, 100000) end",
      "local s = ('x'):rep(1000000) while true do utf8.len(s) end",
      "local s = ('x'):rep(1000000) while true do local t = s .. 'y' end",
      "local s = ('x '):rep(100000) while true do load(s) end",
      "local s = ('1'):rep(1000000) while true do tonumber(s, 3) end",
      "while true do pcall(string.rep, '', 1e15) end",
  };
  for (size_t i = 0; i < sizeof works / sizeof *works; ++i) {
    char text[512];
    stage s;
    snprintf(text, sizeof text, MAIN "function Main:work() %s end\n", works[i]);
    if (!open_bounded(&s, text, 300000)) return;
    if (!CHECK_STATUS(BREVE_ERROR_BUDGET, stage_call(&s, "work", NULL))) printf("  %s\n", works[i]);
    stage_end(&s);
  }
}

/* One instruction may go through megabytes. Uncounted, the first loop would run 200,000 times, and for a minute. */
static void instructions_that_go_through_much_count_it(void) {
  static const struct {
    const char* work;
    double most;
  } works[] = {
      {"local a, b = ('x'):rep(1000000), ('x'):rep(999999) .. 'x' while true do self.n = self.n + 1 self.b = a == b "
       "end",
       6000},
      {"local a = ('x'):rep(1000000) while true do self.n = self.n + 1 self.b = a < a end", 6000},
      {"local t = {} for i = 1, 100000 do t[i] = i end local function f(...) self.n = self.n + 1 return f(...) end "
       "f(table.unpack(t))",
       3000},
      {"local t = {} for i = 1, 100000 do t[i] = i end local function f(...) while true do self.n = self.n + 1 "
       "coroutine.wrap(function(...) return ... end)(...) end end f(table.unpack(t))",
       3000},
      /* Once they are gone, instructions count as before. */
      {"do local a = ('x'):rep(1000000) end for i = 1, 600 do local b = ('y'):rep(5000) end "
       "for i = 1, 100000 do self.n = self.n + 1 end",
       1e9},
  };
  for (size_t i = 0; i < sizeof works / sizeof *works; ++i) {
    char text[512];
    stage s;
    snprintf(text, sizeof text, MAIN "function Main:work() self.n = 0 %s end function Main:count() return self.n end\n",
             works[i].work);
    if (!open_bounded(&s, text, 1000000)) return;
    CHECK_STATUS(works[i].most < 1e9 ? BREVE_ERROR_BUDGET : BREVE_OK, stage_call(&s, "work", NULL));
    const double count = stage_number(&s, "count");
    if (!CHECK(count >= 5 && count < works[i].most)) printf("  %g times: %s\n", count, works[i].work);
    stage_end(&s);
  }
}

/* A file is run once without a world, and once more for each: neither goes on for ever, whatever it catches. */
static void a_file_that_never_ends_is_refused(void) {
  static const char* const texts[] = {
      "while true do end",
      "while true do pcall(function() while true do end end) end",
      "coroutine.wrap(function() while true do pcall(function() while true do end end) end end)()",
      "('a'):rep(30000):find(('.-'):rep(30) .. 'b')",
      "local t = {} for i = 1, 1e9 do t[i] = {} end",
      "local s = 'x' while true do s = s .. s end",
      "local a, b = ('x'):rep(1000000), ('x'):rep(999999) .. 'x' while true do local c = a == b end",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
    char text[512];
    stage s;
    stage_begin(&s);
    snprintf(text, sizeof text, MAIN "%s\n", texts[i]);
    const breve_status status = stage_compile(&s, text);
    if (!CHECK(status == BREVE_ERROR_COMPILE || status == BREVE_ERROR_MEMORY)) printf("  %s\n", texts[i]);
    stage_end(&s);
  }
  stage s;
  breve_world_config config = breve_world_config_default();
  stage_begin(&s);
  config.budget = 300000;
  /* Only where there is a world are random numbers others than 0.5. */
  CHECK_STATUS(BREVE_OK, stage_compile(&s, MAIN "if math.random() ~= 0.5 then while true do end end\n"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_create(s.runtime, s.program, &config, &s.world));
  stage_end(&s);
}

/* Equal elements keep their order: Lua's own sort would leave them as its clock had it. */
static void sorting_is_stable_and_tables_move_as_in_lua(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN "function Main:stable() local t = {} for i = 1, 500 do t[i] = {i * 7 % 10, i} end "
               "  table.sort(t, function(a, b) return a[1] < b[1] end) "
               "  for i = 2, 500 do local a, b = t[i - 1], t[i] if a[1] > b[1] or (a[1] == b[1] and a[2] > b[2]) then "
               "return false end end return true end\n"
               "function Main:numbers() local t = {5, 2, 8, 1, 9, 3} table.sort(t) return table.concat(t) == '123589' "
               "  and not pcall(table.sort, {1, 'a'}) and not pcall(table.sort, {2, 1}, 5) end\n"
               "function Main:moved() local t = {1, 2, 3} table.insert(t, 4) table.insert(t, 1, 0) local r = "
               "table.remove(t, 2) return table.concat(t) == '0234' and r == 1 and table.remove(t) == 4 and "
               "  table.remove({}) == nil and not pcall(table.insert, t, 9, 1) and not pcall(table.insert, t) and not "
               "pcall(table.remove, t, 9) end\n"
               "function Main:errors() local ok, text = pcall(function() ('x'):rep({}) end) "
               "  return text:match(\"^agents.lua:%d+: bad argument #1 to 'rep' %(number expected, got table%)$\") ~= "
               "nil end\n",
          NULL))
    return;
  static const char* const claims[] = {"stable", "numbers", "moved", "errors"};
  for (size_t i = 0; i < sizeof claims / sizeof *claims; ++i)
    if (!CHECK_NEAR(1, stage_number(&s, claims[i]), 0)) printf("  %s\n", claims[i]);
  stage_end(&s);
}

static void memory_counts_against_the_limit(void) {
  stage s;
  breve_world_config config = breve_world_config_default();
  breve_stats stats = breve_stats_default();
  stage_begin(&s);
  config.memory_limit = 8 << 20;
  if (!stage_open(&s,
                  MAIN "function Main:fill() local t = {} for i = 1, 1e7 do t[i] = {i} end end\n"
                       "function Main:text() return #string.rep('x', 1e9) end\n"
                       "function Main:small() return #string.rep('x', 1000) end\n",
                  &config))
    return;
  for (int i = 0; i < 3; ++i) {
    CHECK_STATUS(BREVE_ERROR_MEMORY, stage_call(&s, "fill", NULL));
    CHECK_STATUS(BREVE_ERROR_MEMORY, stage_call(&s, "text", NULL));
    CHECK_NEAR(1000, stage_number(&s, "small"), 0);
  }
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.memory_used <= config.memory_limit && stats.memory_peak <= config.memory_limit);
  stage_end(&s);
}

/* A world that has too little for Lua itself is refused, wherever the memory ends. */
static void every_limit_is_survived(void) {
  for (size_t limit = 100000; limit < 1500000; limit += 25000) {
    stage s;
    breve_world_config config = breve_world_config_default();
    stage_begin(&s);
    config.memory_limit = limit;
    if (!CHECK_STATUS(BREVE_OK, stage_compile(&s, MAIN "local B = breve.class('B', 'Mobile')\n"
                                                       "function B:init() self.t = {1, 2, breve.vector(1, 2, 3)} end\n"
                                                       "function Main:init() breve.new(B, 100) end\n")))
      return;
    const breve_status status = breve_world_create(s.runtime, s.program, &config, &s.world);
    CHECK(status == BREVE_OK || status == BREVE_ERROR_MEMORY);
    stage_end(&s);
  }
}

static void nothing_reaches_the_machine(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(
          &s,
          MAIN
          "function Main:closed() return io == nil and os == nil and package == nil and debug == nil and dofile == nil "
          "  and loadfile == nil and collectgarbage == nil and string.dump == nil end\n"
          "function Main:bytecode() return load('\\27Lua') == nil and load(string.char(27) .. 'LuaT', 'x', 'b') == nil "
          "end\n"
          "function Main:loads() x = 5 return load('return x')() == 5 and load('return x', 'n', 't', {x = 6})() == 6 "
          "end\n"
          "function Main:metatables() return not pcall(setmetatable, {}, {__gc = print}) and not pcall(setmetatable, "
          "{}, {__mode = 'k'}) "
          "  and getmetatable(self) == 'Main' and not pcall(setmetatable, self, {}) end\n"
          "function Main:addresses() return tostring({}) == 'table' and tostring(print) == 'function' and not "
          "pcall(string.format, '%p', {}) "
          "  and ('%s'):format({}) == 'table' and tostring(coroutine.create(print)) == 'thread' end\n"
          "function Main:seeds() return not pcall(math.randomseed, 1) end\n"
          "function Main:order() local t, s = {}, '' for i = 1, 50 do t['k' .. i] = i end t[2.5] = 1 t[true] = 1 t[-1] "
          "= 1 "
          "  local last for k in pairs(t) do if type(k) == 'string' then if last and k < last then return false end "
          "last = k else s = s .. tostring(k) end end "
          "  return s == 'true-12.5' and next({}) == nil and next({5}) == 1 and not pcall(pairs, {[{}] = 1}) end\n",
          NULL))
    return;
  static const char* const all[] = {"closed", "bytecode", "loads", "metatables", "addresses", "seeds", "order"};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
    if (!CHECK_NEAR(1, stage_number(&s, all[i]), 0)) printf("  %s\n", all[i]);
  stage_end(&s);
}

static const char* const keeper = MAIN
    "local B = breve.class('B', 'Mobile')\n"
    "local count = 0\n"
    "breve.on_save(function() return {count = count} end)\n"
    "breve.on_load(function(v) count = v.count end)\n"
    "function Main:init() self.b = B{n = 1, s = 'x\\0y', v = breve.vector(1, 2, 3), t = {1, {2}, k = true}} "
    "self.b.loop = {self.b} "
    "  self.b.twice = self.b.t end\n"
    "function Main:change() count = 7 self.b.n = 99 self.b.t[2][1] = 0 self.b.new = 1 self.extra = B() end\n"
    "function Main:intact() local b = self.b return b.n == 1 and b.s == 'x\\0y' and b.v == breve.vector(1, 2, 3) and "
    "b.t[2][1] == 2 and b.t.k == true "
    "  and b.loop[1] == b and b.twice == b.t and b.new == nil and self.extra == nil and count == 0 end\n"
    "function Main:spoil() self.f = print end\n"
    "function Main:draws() return math.random() + math.random(10) end\n";

static void snapshots_hold_what_objects_hold(void) {
  static char image[1000000];
  stage s;
  size_t size = 0;
  uint64_t before = 0, changed = 0, after = 0;
  stage_begin(&s);
  if (!stage_open(&s, keeper, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  const double drawn = stage_number(&s, "draws");
  CHECK_STATUS(BREVE_OK, stage_call(&s, "change", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &changed));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before != changed && before == after);
  CHECK_NEAR(1, stage_number(&s, "intact"), 0);
  CHECK_NEAR(drawn, stage_number(&s, "draws"), 0);
  for (size_t cut = 1; cut < 300; cut += 7)
    CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s.world, image, size - cut));
  for (size_t at = 17; at < 300; ++at) { /* whatever byte is wrong: refused, or loaded; never a crash */
    char* spoiled = malloc(size);
    if (!spoiled) return;
    memcpy(spoiled, image, size);
    spoiled[size - at] = (char)(spoiled[size - at] ^ 0x5a);
    const breve_status status = breve_world_restore(s.world, spoiled, size);
    CHECK(status == BREVE_OK || status == BREVE_ERROR_IMAGE || status == BREVE_ERROR_MEMORY);
    free(spoiled);
  }
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_NEAR(1, stage_number(&s, "intact"), 0);
  CHECK_STATUS(BREVE_OK, stage_call(&s, "spoil", NULL));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK(strstr(breve_world_last_error(s.world)->message, "function cannot be saved") != NULL);
  stage_end(&s);
}

/* An image goes into another world of the same program, whose objects have other ids. */
static void snapshots_fit_other_worlds(void) {
  static char image[1000000];
  stage s;
  size_t size = 0;
  uint64_t first = 0, second = 0;
  stage_begin(&s);
  if (!stage_open(&s, keeper, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &first));
  breve_world* other = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &other));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(s.world));
  s.world = other;
  CHECK_STATUS(BREVE_OK, stage_call(&s, "change", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &second));
  CHECK(first == second);
  CHECK_NEAR(1, stage_number(&s, "intact"), 0);
  stage_end(&s);
}

static void changed_files_take_over_with_the_fields_of_objects(void) {
  stage s;
  breve_program* old;
  stage_begin(&s);
  if (!stage_open(&s, MAIN "function Main:init() self.kept = 5 end\nfunction Main:answer() return self.kept end\n",
                  NULL))
    return;
  old = s.program;
  s.program = NULL;
  CHECK_NEAR(5, stage_number(&s, "answer"), 0);
  CHECK_STATUS(BREVE_OK, stage_compile(&s, MAIN "function Main:answer() return self.kept + self:more() end\n"
                                                "function Main:more() return 100 end\n"));
  CHECK_STATUS(BREVE_OK, breve_world_reload(s.world, s.program));
  breve_program_destroy(old);
  CHECK_NEAR(105, stage_number(&s, "answer"), 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  old = s.program;
  s.program = NULL;
  /* One whose controller is another class is refused, and the old one goes on. */
  CHECK_STATUS(BREVE_OK, stage_compile(&s, "local Other = breve.class('Other', 'Control') breve.main(Other)\n"));
  CHECK_STATUS(BREVE_ERROR_RELOAD, breve_world_reload(s.world, s.program));
  breve_program_destroy(old);
  CHECK_NEAR(105, stage_number(&s, "answer"), 0);
  stage_end(&s);
}

/* Same seed, same run, in two worlds at once. */
static void two_worlds_of_one_seed_are_equal(void) {
  uint64_t hashes[2] = {0, 1};
  for (int i = 0; i < 2; ++i) {
    stage s;
    stage_begin(&s);
    if (!stage_open(&s,
                    MAIN "local B = breve.class('B', 'Mobile')\n"
                         "function B:init() self.t = {} self:move(breve.random(breve.vector(9, 9, 9))) end\n"
                         "function B:iterate() for i = 1, 5 do self.t['k' .. math.random(100)] = i end local s = 0 "
                         "  for k, v in pairs(self.t) do s = s * 31 % 1000 + v end self.s = s "
                         "self:set_velocity(breve.vector(s, 0, 0)) end\n"
                         "function Main:init() breve.new(B, 20) end\n",
                    NULL))
      return;
    for (int k = 0; k < 20; ++k) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hashes[i]));
    CHECK_TEXT("", s.told);
    stage_end(&s);
  }
  CHECK(hashes[0] == hashes[1]);
}

int main(void) {
  RUN(loops_count_in_the_budget);
  RUN(functions_of_libraries_count_in_the_budget);
  RUN(instructions_that_go_through_much_count_it);
  RUN(a_file_that_never_ends_is_refused);
  RUN(sorting_is_stable_and_tables_move_as_in_lua);
  RUN(memory_counts_against_the_limit);
  RUN(every_limit_is_survived);
  RUN(nothing_reaches_the_machine);
  RUN(snapshots_hold_what_objects_hold);
  RUN(snapshots_fit_other_worlds);
  RUN(changed_files_take_over_with_the_fields_of_objects);
  RUN(two_worlds_of_one_seed_are_equal);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
