/* What learns and evolves, driven by a host through the general calls: a network, a genetic algorithm, CMA-ES, NSGA-II,
   Push, and archives of them. The program has nothing of its own but the test of the individuals. */
#include "scene.h"

static const char* const program =
    "@use Control.\n@use SFFNetwork.\n@use CMAEvolutionStrategy.\n@use MultiObjectiveSearch.\n"
    "@use RealVectorIndividual.\n@use Push.\n"
    "Controller Host.\n"
    "RealVectorIndividual : Point { + to init: self set-genome of-length 2 from -1.0 to 1.0. }\n"
    "GeneticAlgorithm : Search {\n"
    "  + to end-fitness-test of point (object):\n"
    "    point set-fitness to 1 - |(point get-genes){0}| - |(point get-genes){1} - .5|.\n"
    "}\n"
    "Control : Host { }\n";

/* Calls a method; what fails is shown. */
static breve_value ask(breve_world* world, breve_object object, const char* method, const breve_keyword* keywords,
                       size_t count) {
  breve_value result = breve_value_null();
  if (!CHECK_STATUS(BREVE_OK, breve_object_call(world, object, method, keywords, count, &result)))
    printf("%s: %s\n", method, breve_world_last_error(world)->text);
  return result;
}
static breve_value ask_one(breve_world* world, breve_object object, const char* method, const char* keyword,
                           breve_value value) {
  const breve_keyword keywords[] = {{keyword, value}};
  return ask(world, object, method, keywords, 1);
}
static double number_of(breve_value value) {
  CHECK(value.type == BREVE_TYPE_DOUBLE || value.type == BREVE_TYPE_INT);
  return value.type == BREVE_TYPE_INT ? value.as.integer : value.as.number;
}

static breve_object made(breve_world* world, const char* class_name) {
  breve_object object = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(world, class_name, &object));
  return object;
}

/* A list of numbers. */
static breve_value list_of(breve_world* world, const double* numbers, size_t count) {
  breve_value list = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_list_create(world, &list));
  for (size_t i = 0; i < count; ++i) {
    const breve_value item = breve_value_double(numbers[i]);
    CHECK_STATUS(BREVE_OK, breve_list_push(world, &list, &item));
  }
  return list;
}
/* A list of such lists. */
static breve_value rows_of(breve_world* world, const double* numbers, size_t rows, size_t columns) {
  breve_value list = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_list_create(world, &list));
  for (size_t i = 0; i < rows; ++i) {
    const breve_value row = list_of(world, numbers + i * columns, columns);
    CHECK_STATUS(BREVE_OK, breve_list_push(world, &list, &row));
  }
  return list;
}
/* The numbers of an element of a list of lists. */
static size_t row_at(breve_world* world, const breve_value* rows, size_t at, double* numbers, size_t most) {
  breve_value row, elements[8];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_list_get(world, rows, at, &row));
  CHECK_STATUS(BREVE_OK, breve_list_size(world, &row, &size));
  if (!CHECK(size <= most && size <= 8)) return 0;
  CHECK_STATUS(BREVE_OK, breve_list_read(world, &row, 0, elements, size));
  for (size_t i = 0; i < size; ++i) numbers[i] = number_of(elements[i]);
  return size;
}

static bool open_learning(scene* s) { return scene_open_text(s, program, NULL); }

static const double inputs[] = {0, 0, 0, 1, 1, 0, 1, 1}, targets[] = {0, 1, 1, 0};

/* The output of a network for one of the inputs. */
static double output_of(breve_world* world, breve_object net, size_t at) {
  ask_one(world, net, "run-with", "inputs", list_of(world, inputs + 2 * at, 2));
  return number_of(ask_one(world, net, "get-output", "at-position", breve_value_int(0)));
}

static void a_network_learns_and_is_archived(void) {
  scene s;
  if (!open_learning(&s)) return;
  const breve_object net = made(s.world, "NeuralNetwork");
  const breve_keyword second[] = {{"with-neuron-count", breve_value_int(4)},
                                  {"with-activation", breve_value_string("tanh")}};
  const breve_keyword third[] = {{"with-neuron-count", breve_value_int(1)},
                                 {"with-activation", breve_value_string("logistic")}};
  ask_one(s.world, net, "add-feed-forward-layer", "with-neuron-count", breve_value_int(2));
  ask(s.world, net, "add-feed-forward-layer", second, 2);
  ask(s.world, net, "add-feed-forward-layer", third, 2);
  ask(s.world, net, "randomize-weights", NULL, 0);
  const breve_keyword adam[] = {{"to", breve_value_string("adam")}, {"with-learning-rate", breve_value_double(0.05)}};
  ask(s.world, net, "set-optimizer", adam, 2);
  const breve_keyword lesson[] = {{"with-inputs", rows_of(s.world, inputs, 4, 2)},
                                  {"with-targets", rows_of(s.world, targets, 4, 1)},
                                  {"for-epochs", breve_value_int(800)}};
  CHECK(number_of(ask(s.world, net, "train", lesson, 3)) < 0.01);
  double before[4];
  for (size_t i = 0; i < 4; ++i) {
    before[i] = output_of(s.world, net, i);
    CHECK_NEAR(targets[i], before[i], 0.2);
  }

  /* An archive is a text; the host may keep it where it likes. */
  char archive[16384];
  const breve_value text = ask(s.world, net, "archive-as-xml-string", NULL, 0);
  if (!CHECK(text.type == BREVE_TYPE_STRING && strlen(text.as.string.bytes) < sizeof archive)) return;
  strcpy(archive, text.as.string.bytes);
  const breve_value copy = ask_one(s.world, breve_world_controller(s.world), "parse-xml-network-request", "from-string",
                                   breve_value_string(archive));
  CHECK(copy.type == BREVE_TYPE_OBJECT && copy.as.object.index != net.index);
  for (size_t i = 0; i < 4; ++i) CHECK(output_of(s.world, copy.as.object, i) == before[i]);
  archive[strlen(archive) / 2] = 0;
  breve_value none = breve_value_int(1);
  const breve_keyword half[] = {{"from-string", breve_value_string(archive)}};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "parse-xml-network-request", half,
                                           1, &none));
  CHECK(none.type == BREVE_TYPE_OBJECT
            ? none.as.object.index == 0
            : none.type == BREVE_TYPE_NULL || (none.type == BREVE_TYPE_INT && none.as.integer == 0));

  /* An error of a method is one of the call. */
  const breve_keyword wrong[] = {{"inputs", list_of(s.world, inputs, 3)}};
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, net, "run-with", wrong, 1, NULL));
  CHECK(strstr(breve_world_last_error(s.world)->text, "3") != NULL);
  scene_close(&s);
}

static void a_genetic_algorithm_is_set_up_and_stepped(void) {
  scene s;
  if (!open_learning(&s)) return;
  const breve_object search = made(s.world, "Search");
  ask_one(s.world, search, "set-individual-class", "to", breve_value_string("Point"));
  ask_one(s.world, search, "set-population-size", "to", breve_value_int(20));
  ask_one(s.world, search, "set-fitness-test-duration", "to", breve_value_double(0.01));
  ask_one(s.world, search, "set-elitism-percent", "to", breve_value_int(10));
  for (int i = 0; i < 2000; ++i)
    if (!CHECK_STATUS(BREVE_OK, breve_world_step(s.world))) break;
  CHECK(number_of(ask(s.world, search, "get-generation", NULL, 0)) > 20);
  CHECK(number_of(ask(s.world, search, "get-best-fitness", NULL, 0)) > 0.95);
  const breve_value best = ask(s.world, search, "get-best-individual", NULL, 0);
  CHECK(best.type == BREVE_TYPE_OBJECT);
  scene_close(&s);
}

static void searches_are_asked_and_told(void) {
  scene s;
  if (!open_learning(&s)) return;
  const breve_object search = made(s.world, "CMAEvolutionStrategy");
  const double start[] = {1, 1}, low[] = {-2, -2}, high[] = {2, 2};
  double x[8];
  const breve_keyword begin[] = {{"at", list_of(s.world, start, 2)}, {"with-step", breve_value_double(0.5)}};
  ask(s.world, search, "begin", begin, 2);
  for (int generation = 0; generation < 100; ++generation) {
    const breve_value candidates = ask(s.world, search, "ask", NULL, 0);
    double values[64];
    size_t count = 0;
    CHECK_STATUS(BREVE_OK, breve_list_size(s.world, &candidates, &count));
    for (size_t i = 0; i < count && i < 64; ++i)
      if (row_at(s.world, &candidates, i, x, 2) == 2) values[i] = x[0] * x[0] + 9 * x[1] * x[1];
    ask_one(s.world, search, "tell", "values", list_of(s.world, values, count));
  }
  CHECK(number_of(ask(s.world, search, "get-best-value", NULL, 0)) < 1e-9);

  const breve_object fronts = made(s.world, "MultiObjectiveSearch");
  const breve_keyword box[] = {{"from", list_of(s.world, low, 2)},
                               {"to", list_of(s.world, high, 2)},
                               {"with-objectives", breve_value_int(2)},
                               {"with-population", breve_value_int(20)}};
  ask(s.world, fronts, "begin", box, 4);
  for (int generation = 0; generation < 60; ++generation) {
    const breve_value candidates = ask(s.world, fronts, "ask", NULL, 0);
    double values[40];
    for (size_t i = 0; i < 20; ++i) {
      if (row_at(s.world, &candidates, i, x, 2) != 2) break;
      values[2 * i] = x[0] * x[0] + x[1] * x[1];
      values[2 * i + 1] = (x[0] - 1) * (x[0] - 1) + x[1] * x[1];
    }
    ask_one(s.world, fronts, "tell", "values", rows_of(s.world, values, 20, 2));
  }
  const breve_value front = ask(s.world, fronts, "get-front", NULL, 0);
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_list_size(s.world, &front, &size));
  CHECK(size >= 10);
  for (size_t i = 0; i < size; ++i)
    if (row_at(s.world, &front, i, x, 2) == 2) CHECK(x[0] > -0.2 && x[0] < 1.2 && x[1] > -0.2 && x[1] < 0.2);
  scene_close(&s);
}

static void push_programs_run(void) {
  scene s;
  if (!open_learning(&s)) return;
  const breve_object interpreter = made(s.world, "PushInterpreter"), code = made(s.world, "PushProgram");
  ask_one(s.world, code, "parse", "program", breve_value_string("( 6 7 INTEGER.* 1.5 FLOAT.DUP FLOAT.+ )"));
  ask_one(s.world, interpreter, "run", "program", breve_value_object(code));
  CHECK(number_of(ask(s.world, interpreter, "get-integer-stack-top", NULL, 0)) == 42);
  CHECK(number_of(ask(s.world, interpreter, "get-float-stack-top", NULL, 0)) == 3);
  scene_close(&s);
}

void learning_suite(void) {
  RUN(a_network_learns_and_is_archived);
  RUN(a_genetic_algorithm_is_set_up_and_stepped);
  RUN(searches_are_asked_and_told);
  RUN(push_programs_run);
}
