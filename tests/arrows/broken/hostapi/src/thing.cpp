// What the functions of thing.h do.
#include "breve/thing.h"

namespace {

void need_type(int type) {
  if (type != 1) fail(BREVE_ERROR_TYPE, "another type");
}

}  // namespace

breve_status breve_thing_size(const breve_thing* thing, size_t* size) {
  need_type(thing->type);
  *size = 1;
  return BREVE_OK;
}

breve_status breve_thing_lock(breve_thing* thing) {
  need_type(thing->type);
  return thing->locked ? BREVE_ERROR_BUSY : BREVE_OK;
}

breve_status breve_other_lock(breve_other* other) {
  need_type(other->type);
  return other->locked ? BREVE_ERROR_BUSY : BREVE_OK;
}
