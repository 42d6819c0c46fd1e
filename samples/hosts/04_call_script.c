/* Calling scripts: a method by its name, the same prepared for many calls, one call for many objects, lists in and out,
 * and what an error looks like. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

static const char* const program_text =
    "@use Control.\n"
    "Controller Market.\n"
    "Control : Market {\n"
    "  + variables: stalls (list).\n"
    "  + to init: stalls = 3 new Stalls.\n"
    "  + to sum of prices (list) with-tax rate = 0.0 (float):\n"
    "    price, total (float).\n"
    "    foreach price in prices: total += price.\n"
    "    return total * (1.0 + rate).\n"
    "  + to get-stalls: return stalls.\n"
    "}\n"
    "Object : Stall (aka Stalls) {\n"
    "  + variables: stock (int).\n"
    "  + to init: stock = 10.\n"
    "  + to sell count n (int):\n"
    "    if n > stock: die \"sold out\".\n"
    "    stock -= n.\n"
    "    return stock.\n"
    "}\n";

/* By name: keywords in any order, and those with defaults may be left out. */
static breve_status call_by_name(breve_world* world) {
  const breve_object market = breve_world_controller(world);
  breve_value prices, total, price;
  breve_status status = breve_list_create(world, &prices);
  for (int i = 1; i <= 3 && status == BREVE_OK; ++i) {
    price = breve_value_double(1.5 * i);
    status = breve_list_push(world, &prices, &price);
  }
  const breve_keyword keywords[] = {{"with-tax", breve_value_double(0.1)}, {"of", prices}};
  if (status == BREVE_OK) status = breve_object_call(world, market, "sum", keywords, 2, &total);
  if (status == BREVE_OK) printf("1.5 + 3 + 4.5 with tax: %.2f\n", total.as.number);
  return status;
}

/* Prepared: the names are resolved once. One call then serves one object, or many. */
static breve_status call_prepared(breve_world* world) {
  static const char* const names[] = {"count"};
  breve_object stalls[8];
  breve_value left[8];
  breve_selector sell;
  size_t count = 0;
  const breve_value two = breve_value_int(2);
  breve_status status = breve_world_prepare(world, "sell", names, 1, &sell);
  if (status == BREVE_OK) status = breve_world_objects(world, "Stall", stalls, 8, &count);
  if (status == BREVE_OK) status = breve_object_call_prepared(world, stalls[0], sell, &two, 1, NULL);
  if (status == BREVE_OK) status = breve_objects_call_prepared(world, stalls, count, sell, &two, 1, left);
  for (size_t i = 0; status == BREVE_OK && i < count; ++i) printf("stall %zu: %d left\n", i, left[i].as.integer);
  return status;
}

/* A list that a script returns is good until script runs again. */
static breve_status read_a_list(breve_world* world) {
  breve_value stalls, stall;
  size_t size = 0;
  breve_status status = breve_object_call(world, breve_world_controller(world), "get-stalls", NULL, 0, &stalls);
  if (status == BREVE_OK) status = breve_list_size(world, &stalls, &size);
  if (status == BREVE_OK) status = breve_list_get(world, &stalls, size - 1, &stall);
  if (status == BREVE_OK) printf("the last of %zu is a %s\n", size, breve_object_class(world, stall.as.object));
  return status;
}

/* An error is a status and a text with the chain of calls; the world goes on. */
static breve_status fail_and_go_on(breve_world* world) {
  breve_object stall;
  size_t count = 0;
  const breve_keyword many = {"count", breve_value_int(100)};
  breve_status status = breve_world_objects(world, "Stall", &stall, 1, &count);
  if (status != BREVE_OK) return status;
  status = breve_object_call(world, stall, "sell", &many, 1, NULL);
  printf("%s: %s\n", breve_status_name(status), breve_world_last_error(world)->message);
  return status == BREVE_ERROR_SCRIPT ? breve_world_step(world) : BREVE_ERROR_INTERNAL;
}

int main(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  breve_status status = breve_runtime_create(NULL, &runtime);
  if (status == BREVE_OK)
    status = breve_program_compile(runtime, "market.tz", program_text, strlen(program_text), &program);
  if (status == BREVE_OK) status = breve_world_create(runtime, program, NULL, &world);
  if (status == BREVE_OK) status = call_by_name(world);
  if (status == BREVE_OK) status = call_prepared(world);
  if (status == BREVE_OK) status = read_a_list(world);
  if (status == BREVE_OK) status = fail_and_go_on(world);
  const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime);
  if (status != BREVE_OK && error) printf("%s", error->text);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return status != BREVE_OK;
}
