/* A plugin in C: the function smoothNoise(x, y), a random surface of heights from -1 to 1 that is the same in every
   run. Value noise: random heights at whole coordinates, and a smooth curve between them (Perlin 1985). */
#include <math.h>

#include "breve/breve.h"

/* A height from -1 to 1 for a pair of whole numbers. */
static double height_at(double x, double y) {
  uint32_t bits = (uint32_t)(int32_t)x * 0x9e3779b1u ^ (uint32_t)(int32_t)y * 0x85ebca77u;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  bits = (bits ^ bits >> 12) * 0x297a2d39u;
  return (double)(bits ^ bits >> 15) / 2147483648.0 - 1;
}

static double curve(double t) { return t * t * (3 - 2 * t); }

static breve_status smooth_noise(void* user, const breve_call* call, breve_value* result) {
  const double most = 1e9; /* beyond it neighbouring numbers are not a step apart */
  const double x = call->arguments[0].as.number, y = call->arguments[1].as.number;
  (void)user;
  if (!(fabs(x) < most && fabs(y) < most)) {
    static const char why[] = "both coordinates must be between -1e9 and 1e9";
    call->reason(call->sink, why, sizeof why - 1);
    return BREVE_ERROR_SCRIPT;
  }
  const double column = floor(x), row = floor(y), across = curve(x - column), along = curve(y - row);
  const double low = height_at(column, row) * (1 - across) + height_at(column + 1, row) * across;
  const double high = height_at(column, row + 1) * (1 - across) + height_at(column + 1, row + 1) * across;
  *result = breve_value_double(low * (1 - along) + high * along);
  return BREVE_OK;
}

BREVE_PLUGIN(noise, runtime) {
  static const uint32_t coordinates[] = {BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE};
  breve_function function = breve_function_default();
  function.name = "smoothNoise";
  function.doc = "The height of a random surface at (x, y), from -1 to 1.";
  function.parameters = coordinates;
  function.parameter_count = 2;
  function.result = BREVE_TYPE_DOUBLE;
  function.call = smooth_noise;
  return breve_runtime_add_function(runtime, &function);
}
