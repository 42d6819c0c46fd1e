// Arguments, and what is held. Choices are drawn one after the other, never two in one call's arguments: compilers
// disagree about the order of these.
#include "caller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace caller {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNumbers[] = {0,    1,    -1,   0.5,   2,      0.01,   3,      10,  -0.5,      4,
                               1e10, 1e20, 1e38, 1e300, -1e300, 1e-300, 5e-324, NAN, kInfinity, -kInfinity};
constexpr std::uint32_t kWords[] = {0, 1, 2, 3, 4, 7, 100, 4097, 65536, 0x7fffffffU, 0x80000000U, 0xffffffffU};
constexpr const char* kClasses[] = {nullptr,     "Mobile",        "Link",     "Joint", "Shape", "Real",      "Spring",
                                    "PatchGrid", "PatchChemical", "MenuItem", "Image", "Clerk", "Stationary"};
/// More than these are not remembered: a later one takes the place of another.
constexpr std::size_t kMostObjects = 200, kMostValues = 100;

template <class T>
void keep_some(std::vector<T>& kept, const T& one, std::size_t most, Choices& choices) {
  if (kept.size() < most)
    kept.push_back(one);
  else
    kept[choices.below(most)] = one;
}

}  // namespace caller

breve_runtime* Caller::runtime() {
  breve_runtime* drawn = chance(3) ? nullptr : choices_.one_of(runtimes_);
  if (!drawn) expect_argument_error();
  return demand_->runtime = drawn, drawn;
}

breve_program* Caller::program() {
  breve_program* drawn = programs_.empty() || chance(3) ? nullptr : choices_.one_of(programs_);
  if (!drawn) expect_argument_error();
  return drawn;
}

breve_analysis* Caller::analysis() {
  breve_analysis* drawn = analyses_.empty() || chance(3) ? nullptr : choices_.one_of(analyses_);
  if (!drawn) expect_argument_error();
  return drawn;
}

breve_world* Caller::world() {
  breve_world* drawn = nullptr;
  if (!chance(2)) {
    if (!speakers_.empty() && chance(60))
      drawn = choices_.one_of(speakers_);
    else if (!worlds_.empty())
      drawn = choices_.one_of(worlds_);
  }
  if (!drawn) expect_argument_error();
  return demand_->world = drawn, drawn;
}

// --- objects ---------------------------------------------------------------------------------------------------------

breve_object Caller::draw_object(const breve_world* world, const char* class_name) {
  const std::size_t kind = choices_.below(100);
  if (kind < 75 && world) {
    const char* of = class_name && chance(85) ? class_name : choices_.one_of(caller::kClasses);
    breve_object found[16];
    std::size_t count = 0;
    if (breve_world_objects(world, of, found, std::size(found), &count) == BREVE_OK && count != 0) {
      const breve_object drawn = found[choices_.below(std::min(count, std::size(found)))];
      keep(drawn);
      return drawn;
    }
  }
  if (kind < 78) return {0, 0};
  if (kind < 82) {
    const std::uint32_t index = word();
    return {index, word()};
  }
  return objects_.empty() ? breve_object{1, 1} : choices_.one_of(objects_);
}

breve_object Caller::any_object(const breve_world* world, const char* class_name) {
  return draw_object(world, class_name);
}

breve_object Caller::object_or_null(const breve_world* world, const char* class_name) {
  const breve_object drawn = draw_object(world, class_name);
  if (drawn.generation != 0 && !breve_object_alive(world, drawn)) expect_refusal();
  return drawn;
}

breve_object Caller::object(const breve_world* world, const char* class_name) {
  const breve_object drawn = draw_object(world, class_name);
  if (!breve_object_alive(world, drawn)) expect_refusal();
  return drawn;
}

void Caller::keep(breve_object object) { caller::keep_some(objects_, object, caller::kMostObjects, choices_); }

void Caller::keep(const breve_value& value) {
  if (value.type == BREVE_TYPE_STRING || value.type == BREVE_TYPE_DATA) {
    // The library's own bytes: they are read now, and not passed in again.
    require(value.as.string.size == 0 || value.as.string.bytes, "a value has no bytes");
    const std::string copy(value.as.string.bytes ? value.as.string.bytes : "", value.as.string.size);
    if (value.type == BREVE_TYPE_STRING) require(value.as.string.bytes[copy.size()] == 0, "a string has no end");
    return;
  }
  caller::keep_some(values_, value, caller::kMostValues, choices_);
}

// --- numbers, texts, values ------------------------------------------------------------------------------------------

double Caller::number() {
  return chance(70) ? caller::kNumbers[choices_.below(10)] : choices_.one_of(caller::kNumbers);
}

double Caller::finite() { return static_cast<double>(choices_.below(200)) / 50.0 - 2.0; }

std::uint32_t Caller::word() { return choices_.one_of(caller::kWords); }

breve_pose Caller::pose() {
  breve_pose drawn;
  for (double& x : drawn.location) x = chance(92) ? finite() : number();
  for (double& x : drawn.rotation) x = chance(96) ? finite() : number();
  if (chance(4)) std::fill(std::begin(drawn.rotation), std::end(drawn.rotation), 0.0);
  return drawn;
}

const char* Caller::class_name() {
  if (chance(3)) return nullptr;
  if (chance(10)) return "Nobody";
  if (chance(40)) {
    const char* drawn = choices_.one_of(caller::kClasses);
    return drawn ? drawn : "Object";
  }
  return choices_.one_of(library_.classes()).name.c_str();
}

const char* Caller::text_or_null(const char* text) {
  if (text && !chance(3)) return text;
  expect_refusal();
  return nullptr;
}

breve_value Caller::value(const breve_world* world) {
  switch (choices_.below(13)) {
    case 0: return breve_value_null();
    case 1: return breve_value_int(static_cast<std::int32_t>(word()));
    case 2: return breve_value_double(number());
    case 3: {
      const double x = number(), y = number();
      return breve_value_vector(x, y, number());
    }
    case 4: {
      double rows[9];
      for (double& x : rows) x = number();
      return breve_value_matrix(chance(10) ? nullptr : rows);
    }
    case 5: return breve_value_string(chance(10) ? nullptr : "text");
    case 6:
    case 7: return breve_value_object(draw_object(world, nullptr));
    case 8: {  // of any type, or of none
      breve_value made;
      std::memset(&made, 0, sizeof made);
      made.type = static_cast<std::uint32_t>(choices_.below(14));
      made.reserved = chance(10) ? 1 : 0;
      if (made.type == BREVE_TYPE_STRING || made.type == BREVE_TYPE_DATA) {
        made.as.string.bytes = chance(70) ? "abc\0def" : nullptr;
        made.as.string.size = choices_.below(made.as.string.bytes ? 8 : 2);
      } else {
        made.as.ref.index = chance(40) ? 0 : word();
        made.as.ref.epoch = made.as.ref.index == 0 ? 0 : word();
      }
      return made;
    }
    default: return values_.empty() ? breve_value_int(1) : choices_.one_of(values_);
  }
}

breve_value Caller::value_of_type(const std::string& type, const breve_world* world) {
  if (chance(10)) return value(world);
  if (type == "int") return breve_value_int(static_cast<std::int32_t>(choices_.below(6)));
  if (type == "float" || type == "double") return breve_value_double(chance(80) ? finite() : number());
  if (type == "vector") {
    const double x = finite(), y = finite();
    return breve_value_vector(x, y, chance(80) ? finite() : number());
  }
  if (type == "string") return breve_value_string(chance(50) ? "note" : "Mobile");
  if (type.find("object") != std::string::npos) return breve_value_object(draw_object(world, nullptr));
  return value(world);
}

std::size_t Caller::struct_size(std::size_t right) {
  if (!chance(8)) return right;
  return chance(50) ? choices_.below(right + 64) : word();
}

std::size_t Caller::capacity() {
  static constexpr std::size_t kCapacities[] = {0, 0, 1, 3, 32};
  return choices_.one_of(kCapacities);
}

}  // namespace breve::fuzz
