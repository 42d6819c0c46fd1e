// Statements from outside: running them, asking whether they are complete, stopping what runs.
#include "steve/compile/evaluate.hpp"
#include "internal.hpp"

using namespace breve::host;
using breve::steve::Tag;
using breve::steve::Value;

breve_status breve_world_evaluate(breve_world* world, breve_object self, const char* text, size_t size,
                                  breve_value* result) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (size != 0) need(text, "text");
    auto* controller = world->machine->controller();
    if (is_null(self) && !controller) fail(BREVE_ERROR_STALE, "the controller has been freed: name an object");
    auto& instance = is_null(self) ? *controller : live_instance(*world, self);
    Value value;
    {
      const ScriptScope script(*world);
      value = world->machine->evaluate(instance, {size != 0 ? text : "", size});
    }
    if (result) *result = to_host(*world, value);
  });
}

breve_status breve_world_session(breve_world* world, breve_value* hash) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(hash, "hash");
    *hash = to_host(*world, Value::of(Tag::Hash, world->machine->session()));
  });
}

bool breve_statements_complete(const char* text, size_t size) {
  bool complete = true;
  const breve_status status = guard([&] {
    if (size != 0) need(text, "text");
    complete = breve::steve::statements_complete({size != 0 ? text : "", size});
  });
  return status == BREVE_OK && complete;
}

void breve_world_interrupt(breve_world* world) {
  if (world) world->machine->interrupt();
}
