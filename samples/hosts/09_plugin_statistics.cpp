// A plugin in C++: the class Statistics, which gathers numbers and knows their mean and deviation. Its state is in
// variables of the object, so that snapshots and hashes contain it.
#include <cmath>
#include <cstdint>
#include <iterator>

#include "breve/breve.h"

namespace {

/// A number that an object holds in a variable.
breve_status read(const breve_call& call, const char* name, double& number) {
  breve_value value;
  const breve_status status = breve_object_get(call.world, call.self, name, &value);
  if (status == BREVE_OK) number = value.as.number;
  return status;
}

breve_status write(const breve_call& call, const char* name, double number) {
  const breve_value value = breve_value_double(number);
  return breve_object_set(call.world, call.self, name, &value);
}

/// The sums that the mean and the deviation are made of (Welford 1962).
struct Sums {
  double count = 0, mean = 0, squares = 0;

  breve_status load(const breve_call& call) {
    breve_status status = read(call, "count", count);
    if (status == BREVE_OK) status = read(call, "mean", mean);
    return status == BREVE_OK ? read(call, "squares", squares) : status;
  }
  breve_status save(const breve_call& call) const {
    breve_status status = write(call, "count", count);
    if (status == BREVE_OK) status = write(call, "mean", mean);
    return status == BREVE_OK ? write(call, "squares", squares) : status;
  }
};

breve_status add(void*, const breve_call* call, breve_value*) {
  Sums sums;
  if (const breve_status status = sums.load(*call); status != BREVE_OK) return status;
  const double number = call->arguments[0].as.number, away = number - sums.mean;
  sums.count += 1;
  sums.mean += away / sums.count;
  sums.squares += away * (number - sums.mean);
  return sums.save(*call);
}

breve_status get_count(void*, const breve_call* call, breve_value* result) {
  return breve_object_get(call->world, call->self, "count", result);
}

breve_status get_mean(void*, const breve_call* call, breve_value* result) {
  return breve_object_get(call->world, call->self, "mean", result);
}

breve_status get_deviation(void*, const breve_call* call, breve_value* result) {
  Sums sums;
  const breve_status status = sums.load(*call);
  *result = breve_value_double(sums.count > 1 ? std::sqrt(sums.squares / (sums.count - 1)) : 0);
  return status;
}

constexpr breve_method method(const char* name, const char* doc, std::uint32_t result, breve_function_fn call) {
  return {name, doc, nullptr, 0, result, false, {}, call, nullptr};
}

}  // namespace

BREVE_PLUGIN(statistics, runtime) {
  static constexpr breve_parameter kValue{"value", BREVE_TYPE_DOUBLE, 0};
  static constexpr breve_variable kVariables[] = {
      {"count", BREVE_TYPE_DOUBLE, 0}, {"mean", BREVE_TYPE_DOUBLE, 0}, {"squares", BREVE_TYPE_DOUBLE, 0}};
  static constexpr breve_method kMethods[] = {
      {"add", "Adds a number.", &kValue, 1, BREVE_TYPE_NULL, false, {}, add, nullptr},
      method("get-count", "How many numbers were added.", BREVE_TYPE_INT, get_count),
      method("get-mean", "Their mean, or 0 if there are none.", BREVE_TYPE_DOUBLE, get_mean),
      method("get-deviation", "Their standard deviation.", BREVE_TYPE_DOUBLE, get_deviation)};
  breve_class description = breve_class_default();
  description.name = "Statistics";
  description.doc = "Gathers numbers.";
  description.variables = kVariables;
  description.variable_count = std::size(kVariables);
  description.methods = kMethods;
  description.method_count = std::size(kMethods);
  return breve_runtime_add_class(runtime, &description);
}
