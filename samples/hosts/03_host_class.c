/* Classes of the host: a game has chests of its own. Scripts make them, derive from them and call `super`; the host
   calls a method without knowing whose it is. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "breve/breve.h"

static const char* const program_text =
    "@use Control.\n"
    "Controller Cave.\n"
    "Control : Cave {\n"
    "  + to init: new Chest. new Mimic.\n"
    "}\n"
    "Chest : Mimic {\n"
    "  + to take amount n (int):\n"
    "    print \"the mimic bites\".\n"
    "    return (super take amount n / 2).\n"
    "}\n";

/* What the game keeps for each world. */
typedef struct ledger {
  int taken;
} ledger;

/* ---- the class ---------------------------------------------------------------------------------------------------- */

/* Runs for each new chest, before the `init` of a class that is derived from it. */
static breve_status init(void* user, const breve_call* call, breve_value* result) {
  const int* gold = user;
  const breve_value full = breve_value_int(*gold);
  (void)result;
  return breve_object_set(call->world, call->self, "gold", &full);
}

/* The argument is an int, as declared below. `gold` is the chest's variable, which is in snapshots with it. */
static breve_status take(void* user, const breve_call* call, breve_value* result) {
  static const char reason[] = "there is not so much gold in the chest";
  ledger* book = call->binding;
  breve_value gold;
  (void)user;
  const breve_status status = breve_object_get(call->world, call->self, "gold", &gold);
  if (status != BREVE_OK) return status;
  const int amount = call->arguments[0].as.integer;
  if (amount > gold.as.integer) {
    call->reason(call->sink, reason, sizeof reason - 1); /* an error of the script, at its call */
    return BREVE_ERROR_ARGUMENT;
  }
  book->taken += amount;
  *result = breve_value_int(gold.as.integer - amount);
  return breve_object_set(call->world, call->self, "gold", result);
}

/* Each world has a ledger of its own, which methods find in call->binding. */
static breve_status bind(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink) {
  (void)user, (void)world, (void)reason, (void)sink;
  *binding = calloc(1, sizeof(ledger));
  return *binding ? BREVE_OK : BREVE_ERROR_MEMORY;
}

static void unbind(void* binding) {
  const ledger* book = binding;
  printf("taken in this world: %d\n", book->taken);
  free(binding);
}

/* The description is copied; what `user` points to is not. */
static breve_status add_chest(breve_runtime* runtime, int* gold) {
  static const breve_parameter amount[] = {{"amount", BREVE_TYPE_INT, 0}};
  static const breve_variable variables[] = {{"gold", BREVE_TYPE_INT, 0}};
  const breve_method methods[] = {
      {"init", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, init, gold},
      {"take", "Takes gold, and gives what is left.", amount, 1, BREVE_TYPE_INT, false, {false}, take, NULL}};
  breve_class chest = breve_class_default();
  chest.name = "Chest";
  chest.parent = "Mobile"; /* of the class library */
  chest.doc = "A chest with gold.";
  chest.variables = variables;
  chest.variable_count = 1;
  chest.methods = methods;
  chest.method_count = 2;
  chest.bind = bind;
  chest.unbind = unbind;
  return breve_runtime_add_class(runtime, &chest);
}

/* ---- the host ----------------------------------------------------------------------------------------------------- */

static void say(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)user, (void)world, (void)channel;
  fwrite(text, 1, size, stdout);
}

static breve_status take_from(breve_world* world, breve_object chest, int amount) {
  const breve_keyword much = {"amount", breve_value_int(amount)};
  breve_value left;
  const breve_status status = breve_object_call(world, chest, "take", &much, 1, &left);
  if (status == BREVE_OK) printf("%s: %d left\n", breve_object_class(world, chest), left.as.integer);
  return status;
}

/* Objects of a class include those of the classes that are derived from it. The mimic asks `super` for more than is
   left in the end: that is an error of the script, and the call fails. */
static int plunder(breve_world* world) {
  breve_object chests[2];
  size_t count;
  if (breve_world_objects(world, "Chest", chests, 2, &count) != BREVE_OK || count != 2) return 1;
  if (take_from(world, chests[0], 6) != BREVE_OK || take_from(world, chests[1], 6) != BREVE_OK) return 1;
  return take_from(world, chests[1], 20) == BREVE_OK;
}

int main(void) {
  int gold = 10, failed = 1;
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.print = say;
  if (breve_runtime_create(&config, &runtime) == BREVE_OK &&
      add_chest(runtime, &gold) == BREVE_OK && /* before the program is compiled */
      breve_program_compile(runtime, "cave.tz", program_text, strlen(program_text), &program) == BREVE_OK &&
      breve_world_create(runtime, program, NULL, &world) == BREVE_OK)
    failed = plunder(world);
  const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime);
  if (error) printf("%s", error->text);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failed;
}
