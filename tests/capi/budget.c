/* Budgets: what never ends by itself is cut, at the same turn everywhere, and the world goes on. */
#include "scene.h"

/* Everything that can go on for ever. Each class is a controller's helper; `go` of the controller names what to do. */
static const char* const endless_text =
    "@use Control. @use Mobile. @use Shape.\n"
    "Controller Endless.\n"
    "Control : Endless {\n"
    "  + variables:\n"
    "    n, calls (int).\n"
    "    k (list).\n"
    "  + to touch: calls += 1.\n"
    "  + to go-while: while 1: n += 1.\n"
    "  + to go-for:\n"
    "    i (int).\n"
    "    for i = 0, 1, i++: n += 1.\n"
    "  + to go-foreach:\n"
    "    i (int).\n"
    "    push 1 onto k.\n"
    "    foreach i in k: { push i onto k. n += 1. }\n"
    "  + to go-nothing: while 1: {}\n"
    "  + to go-until: while !calls: {}\n"
    "  + to go-until-object:\n"
    "    o (object).\n"
    "    while !o: {}\n"
    "  + to go-recursion: n += 1. self go-recursion. self go-recursion.\n"
    "  + to go-mutual: n += 1. self go-mutual-other.\n"
    "  + to go-mutual-other: n += 1. self go-mutual.\n"
    "  + to go-by-name: n += 1. callMethodNamed(self, \"go-by-name\", {}). callMethodNamed(self, \"go-by-name\", {}).\n"
    "  + to go-new: while 1: { n += 1. new Thing enable-auto-free. }\n"
    "  + to go-many: n = | (1000000000 new Bare) |.\n"
    "  + to go-init: new Mother.\n"
    "  + to go-destroy: free (new Phoenix).\n"
    "  + to go-sort: k = { 3, 2, 1 }. sort k with compare.\n"
    "  + to compare one a (int) other b (int): while 1: n += 1.\n"
    "  + to go-announce:\n"
    "    self observe instance self for-notification \"again\" with-method \"go-again\".\n"
    "    self announce message \"again\".\n"
    "  + to go-again: n += 1. self announce message \"again\". self announce message \"again\".\n"
    "  + to go-print: print (new Teller).\n"
    "  + to go-text: n = |\"$self\"|. free (new Teller). k = { (new Teller) }. print k, k.\n"
    "  + to go-function: while isa(\"Object\"): n += 1.\n"
    "  + to go-broadcast:\n"
    "    push self onto k. push self onto k. k go-broadcast.\n"
    "  + to go-steps: self set-integration-step to .000000001. self iterate.\n"
    /* in an iteration */
    "  + to plan-schedule: self schedule method-call \"go-on\" at-time getTime() + 1e-9.\n"
    "  + to go-on: n += 1. self schedule method-call \"go-on\" at-time getTime() + 1e-15.\n"
    "  + to plan-repeat: self schedule-repeating method-call \"touch\" with-interval 1e-12.\n"
    "  + to catch-key-k-down: self go-while.\n"
    "  + to click on item (object): self go-while.\n"
    "}\n"
    "NULL : Bare { }\n"
    "Object : Thing { }\n"
    "Object : Mother { + to init: new Mother. new Mother. }\n"
    "Object : Phoenix { + to destroy: free (new Phoenix). free (new Phoenix). }\n"
    "Object : Teller { + to get-description: return \"$self $self\". }\n";

static breve_status call(scene* s, const char* method) {
  return breve_object_call(s->world, breve_world_controller(s->world), method, NULL, 0, NULL);
}

static void whatever_does_not_end_is_cut_and_the_world_goes_on(void) {
  static const char* const methods[] = {
      "go-while",     "go-for",    "go-foreach",  "go-nothing",  "go-until",     "go-until-object",
      "go-recursion", "go-mutual", "go-by-name",  "go-new",      "go-many",      "go-init",
      "go-destroy",   "go-sort",   "go-announce", "go-function", "go-broadcast", "go-steps",
  };
  for (size_t i = 0; i < sizeof methods / sizeof *methods; ++i) {
    scene s;
    breve_world_config config = breve_world_config_default();
    config.budget = 30000;
    config.depth_limit = 300; /* errors of depth in callbacks are survived: only the budget ends these */
    if (!scene_open_text(&s, endless_text, &config)) return;
    printf("  %s\n", methods[i]);
    const breve_status status = call(&s, methods[i]);
    if (strcmp(methods[i], "go-recursion") == 0 || strcmp(methods[i], "go-mutual") == 0 ||
        strcmp(methods[i], "go-init") == 0 || strcmp(methods[i], "go-broadcast") == 0)
      CHECK_STATUS(BREVE_ERROR_DEPTH, status);
    else
      CHECK_STATUS(BREVE_ERROR_BUDGET, status);
    CHECK(breve_world_last_error(s.world)->status == status);
    CHECK_STATUS(BREVE_OK, call(&s, "touch"));
    CHECK(int_of(&s, "calls") == 1);
    uint64_t hash;
    CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hash));
    scene_close(&s);
  }
}

static void objects_that_describe_themselves_without_end_are_printed_all_the_same(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 30000;
  config.depth_limit = 300;
  if (!scene_open_text(&s, endless_text, &config)) return;
  const breve_status status = call(&s, "go-print");
  CHECK(status == BREVE_OK || status == BREVE_ERROR_BUDGET);
  CHECK_STATUS(BREVE_OK, call(&s, "touch"));
  scene_close(&s);
}

static void an_iteration_is_cut_as_a_whole(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 5000;
  if (!scene_open_text(&s, endless_text, &config)) return;
  CHECK_STATUS(BREVE_OK, call(&s, "plan-schedule"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world)); /* calls that schedule calls */
  const int first = int_of(&s, "n");
  CHECK(first > 1000 && first < 5000);
  CHECK(breve_world_iteration(s.world) == 0);
  CHECK_STATUS(BREVE_OK, call(&s, "plan-schedule"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world)); /* each iteration has its own */
  CHECK(int_of(&s, "n") > first + 1000);
  CHECK_STATUS(BREVE_OK, call(&s, "touch"));
  scene_close(&s);

  if (!scene_open_text(&s, endless_text, &config)) return;
  CHECK_STATUS(BREVE_OK, call(&s, "plan-repeat"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
  scene_close(&s);

  if (!scene_open_text(&s, endless_text, &config)) return;
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "k", true));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world)); /* the key was delivered */
  scene_close(&s);
}

/* A crowd in which one loops for ever: in its iterate, when it is hit, or when it goes. */
static const char* const crowd_text =
    "@use Control. @use Mobile.\n"
    "Controller Crowd.\n"
    "Control : Crowd {\n"
    "  + variables:\n"
    "    turns, hits, posts, gone, keys (int).\n"
    "  + to init: 3 new Good. new Bad. 3 new Good.\n"
    "  + to make-ghost: (new Ghost) enable-auto-free.\n"
    "  + to collide:\n"
    "    (new Wall) move to (5, 0, 0). (new Runner) set-velocity to (1, 0, 0).\n"
    "  + to catch-key-k-down: keys += 1. while 1: {}\n"
    "}\n"
    "Object : Good {\n"
    "  + variables: me (Crowd object).\n"
    "  + to init: me = (self get-controller).\n"
    "  + to iterate: me::turns += 1.\n"
    "  + to post-iterate: me::posts += 1.\n"
    "}\n"
    "Object : Bad { + to iterate: while 1: {} }\n"
    "Object : Ghost { + to destroy: while 1: {} }\n"
    "Mobile : Runner {\n"
    "  + to init: self handle-collisions with-type \"Wall\" with-method \"bump\".\n"
    "  + to bump: while 1: {}\n"
    "}\n"
    "Mobile : Wall {\n"
    "  + variables: me (Crowd object).\n"
    "  + to init: me = (self get-controller). self handle-collisions with-type \"Runner\" with-method \"bump\".\n"
    "  + to bump: me::hits += 1.\n"
    "}\n";

static void a_call_budget_cuts_one_object_and_leaves_the_others_their_turn(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 100000;
  config.call_budget = 1000;
  if (!scene_open_text(&s, crowd_text, &config)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "turns") == 6 && int_of(&s, "posts") == 6);
  CHECK(s.said.errors == 1 && strstr(s.said.error, "used up its budget") != NULL);
  CHECK(strstr(s.said.error, "Bad") != NULL);
  CHECK(breve_world_iteration(s.world) == 1 && breve_world_time(s.world) > 0);
  CHECK_STATUS(BREVE_OK, call(&s, "make-ghost"));
  CHECK_STATUS(BREVE_OK, call(&s, "collide"));
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "k", true));
  for (int i = 0; i < 100; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "hits") > 0); /* the other side of each contact is called */
  CHECK(int_of(&s, "keys") == 1);
  CHECK(int_of(&s, "turns") == 606);
  size_t ghosts;
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Ghost", NULL, 0, &ghosts));
  CHECK(ghosts == 0);
  breve_stats stats = {0};
  stats.struct_size = sizeof stats;
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.errors > 102);
  scene_close(&s);
}

static void the_whole_iteration_is_bounded_also_where_each_call_is(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 1500;
  config.call_budget = 1000;
  const char* text =
      "@use Control. Controller Two. Control : Two { + variables: n (int). + to init: 2 new Bad. }\n"
      "Object : Bad { + to iterate: while 1: {} }\n";
  if (!scene_open_text(&s, text, &config)) return;
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
  CHECK(s.said.errors == 1); /* the first was cut alone, the second with the iteration */
  CHECK(breve_world_iteration(s.world) == 0);
  scene_close(&s);
}

static void loop_inside(breve_world* world, void* context) {
  breve_status* inner = context;
  *inner = breve_object_call(world, breve_world_controller(world), "spin", NULL, 0, NULL);
}

static void what_a_callback_calls_counts_to_the_call_it_is_in(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 1000;
  const char* text =
      "@use Control. Controller Echo. Control : Echo { + variables: n, calls (int).\n"
      "  + to spin: while 1: {}\n"
      "  + to talk: print \"hello\". while n < 10: n += 1.\n"
      "  + to quiet: n = 7.\n"
      "}\n";
  if (!scene_open_text(&s, text, &config)) return;
  breve_status inner = BREVE_OK;
  s.said.on_print = loop_inside;
  s.said.context = &inner;
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&s, "talk"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, inner);
  CHECK(int_of(&s, "n") <= 1); /* nothing was left for the outer call */
  CHECK_STATUS(BREVE_OK, call(&s, "quiet"));
  CHECK(int_of(&s, "n") == 7);
  scene_close(&s);
}

/* The warning comes between two pieces of the budget: what the host calls there also has a piece. */
static void what_the_warning_of_lost_patience_calls_has_the_same_budget(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 200000;
  config.patience = 1e-9;
  if (!scene_open_text(&s, "@use Control. Controller Slow. Control : Slow { + to spin: while 1: {} }\n", &config))
    return;
  breve_status inner = BREVE_OK;
  s.said.on_warning = loop_inside;
  s.said.context = &inner;
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&s, "spin"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, inner);
  CHECK(s.said.warnings == 1);
  scene_close(&s);
}

static void every_function_that_runs_script_has_a_budget_of_its_own(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 1000;
  const char* text =
      "@use Control. Controller Own. Control : Own { + to spin: while 1: {} }\n"
      "Object : Slow { + to init: while 1: {} }\n"
      "Object : Last { + to destroy: while 1: {} }\n"
      "Object : Teller { + to get-description: while 1: {} }\n";
  if (!scene_open_text(&s, text, &config)) return;
  breve_object made, last, teller;
  const char* shown;
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&s, "spin"));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_object_create(s.world, "Slow", &made));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Last", &last));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Teller", &teller));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_object_free(s.world, last));
  CHECK(!breve_object_alive(s.world, last)); /* gone all the same */
  const breve_value value = breve_value_object(teller);
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_value_text(s.world, &value, &shown));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);

  breve_world* world = NULL;
  const char* endless = "@use Control. Controller Never. Control : Never { + to init: while 1: {} }\n";
  if (!scene_open_text(&s, text, NULL)) return;
  breve_program* program;
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "never.tz", endless, strlen(endless), &program));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_create(s.runtime, program, &config, &world));
  breve_program_destroy(program);
  scene_close(&s);
}

/* One of each thing that counts. `n` tells how far it came. */
static const char* const golden_text =
    "@use Control. @use Object.\n"
    "Controller Golden.\n"
    "Control : Golden {\n"
    "  + variables: n, i, j (int). k (list). t (Thing object). s (string). v (vector).\n"
    "  + to init: k = { 5, 3, 4, 1 }. t = new Thing. self observe instance t for-notification \"x\" with-method "
    "\"hear\".\n"
    "  + to hear: n += 1.\n"
    "  + to compare one a (int) other b (int): n += 1. return a - b.\n"
    "  + to add one a (int) two b = 2 (int): n += 1. return a + b.\n"
    "  + to fib of m (int): n += 1. if m < 2: return m. return (self fib of m - 1) + (self fib of m - 2).\n"
    "  + to go:\n"
    "    n = 0.\n"
    "    for i = 0, i < 17, i++: n += 1.\n"
    "    while j < 5: { j++. n += 1. if j == 3: n += 0. else { n += 0. } }\n"
    "    foreach i in k: n += 1.\n"
    "    for i = 10, i > 0, i -= 2: for j = 0, j < 3 && n > 0, j++: { v += (1, 0, 0) * 2. n += 1. }\n"
    "    i = (self add one 1 two 2). i = (self add one i).\n"
    "    n += 1. self fib of 6.\n"
    "    sort k with compare.\n"
    "    t tell. n += 1.\n"
    "    k = 4 new Thing. n += 1. k get-age. n += 1.\n"
    "    free k. n += 1.\n"
    "    i = sin(0.0) + sqrt(4.0). n += 1.\n"
    "    s = \"$t $i\". n += 1. i = (t call-method named \"tell\"). n += 1.\n"
    "    while 1: n += 1.\n"
    "}\n"
    "Object : Thing {\n"
    "  + to init: controller::n += 1.\n"
    "  + to tell: self announce message \"x\". self announce message \"x\".\n"
    "  + to destroy: super destroy. controller::n += 1.\n"
    "  + to get-description: return \"thing\".\n"
    "}\n";

static void a_cut_falls_at_the_same_iteration_in_every_build(void) {
  static const struct {
    uint64_t budget;
    int n;
  } cuts[] = {{84, 77},   {85, 77},    {86, 77},       {87, 78},       {88, 78},       {90, 79},
              {92, 79},   {97, 82},    {102, 82},      {107, 83},      {112, 85},      {117, 89},
              {122, 91},  {127, 96},   {132, 101},     {137, 106},     {142, 111},     {147, 116},
              {152, 121}, {157, 126},  {162, 131},     {172, 141},     {182, 151},     {192, 161},
              {212, 181}, {1000, 969}, {65535, 65504}, {65536, 65505}, {65537, 65506}, {200000, 199969}};
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts; ++i) {
    scene s;
    breve_world_config config = breve_world_config_default();
    config.budget = cuts[i].budget; /* init needs less than 84 */
    if (!scene_open_text(&s, golden_text, &config)) return;
    CHECK_STATUS(BREVE_ERROR_BUDGET, call(&s, "go"));
    if (!CHECK(int_of(&s, "n") == cuts[i].n)) printf("  {%d, %d},\n", (int)cuts[i].budget, int_of(&s, "n"));
    scene_close(&s);
  }
}

/* Boxes that depend on each other in a row; the first one that is read wants the end. */
static const char* const boxes_text =
    "@use Control. Controller Keeper.\n"
    "Object : Box (aka Boxes) {\n"
    "  + to dearchive:\n"
    "    i (int).\n"
    "    print \"read\".\n"
    "    for i = 0, i < 1000000, i++: {}\n"
    "    return 1.\n"
    "  + to destroy: (getController()) count.\n"
    "}\n"
    "Control : Keeper {\n"
    "  + variables: xml (string). destroyed (int).\n"
    "  + to count: destroyed++.\n"
    "  + to write:\n"
    "    i (int). first, box, last (object).\n"
    "    first = new Box. last = first.\n"
    "    for i = 1, i < 100, i++: { box = new Box. last add-dependency on box. last = box. }\n"
    "    xml = (first archive-as-xml-string).\n"
    "    free (all Boxes).\n"
    "    destroyed = 0.\n"
    "  + to read: self parse-xml-network-request from-string xml.\n"
    "}\n";

static void interrupt_it(breve_world* world, void* context) {
  (void)context;
  breve_world_interrupt(world);
}

static void an_archive_that_is_interrupted_leaves_none_of_its_objects(void) {
  scene s;
  size_t count = 0;
  memset(&s, 0, sizeof s);
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &s.said;
  config.print = remember;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s.runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "boxes.tz", boxes_text, strlen(boxes_text), &s.program));
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &s.world));
  CHECK_STATUS(BREVE_OK, call(&s, "write"));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  s.said.on_print = interrupt_it;
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED, call(&s, "read"));
  CHECK(s.said.prints == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Box", NULL, 0, &count));
  CHECK(count == 0);
  CHECK(int_of(&s, "destroyed") == 99); /* that of the first one was cut short */
  scene_close(&s);
}

void budget_suite(void) {
  RUN(whatever_does_not_end_is_cut_and_the_world_goes_on);
  RUN(objects_that_describe_themselves_without_end_are_printed_all_the_same);
  RUN(an_iteration_is_cut_as_a_whole);
  RUN(a_call_budget_cuts_one_object_and_leaves_the_others_their_turn);
  RUN(the_whole_iteration_is_bounded_also_where_each_call_is);
  RUN(what_a_callback_calls_counts_to_the_call_it_is_in);
  RUN(what_the_warning_of_lost_patience_calls_has_the_same_budget);
  RUN(every_function_that_runs_script_has_a_budget_of_its_own);
  RUN(an_archive_that_is_interrupted_leaves_none_of_its_objects);
  RUN(a_cut_falls_at_the_same_iteration_in_every_build);
}
