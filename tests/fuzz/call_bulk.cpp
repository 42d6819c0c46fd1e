// Calls for many objects at once: rows of any width, stride and kind, at unaligned addresses.
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_bulk {

constexpr std::size_t kPattern = 0x5a;

/// Rows in memory of just their size: ASan tells if a function touches what is beside them.
class Rows {
 public:
  Rows(Caller& c, std::size_t count, std::size_t width) {
    array_.number = c.chance(95) ? c.word() % 2 : c.word();
    array_.width = static_cast<std::uint32_t>(c.chance(90) ? width : c.word() % 9);
    const std::size_t row = array_.width * (array_.number == BREVE_NUMBER_FLOAT ? sizeof(float) : sizeof(double));
    array_.stride = c.chance(50) ? 0 : row + c.word() % 20;
    const std::size_t gap = array_.stride != 0 ? array_.stride : row;
    if (count != 0) bytes_.resize(1 + (count - 1) * gap + row, kPattern);
    if (c.chance(5)) array_.stride = c.word() % sizeof(float);  // too small, or none
    for (std::size_t i = 0; i < count && array_.number <= BREVE_NUMBER_DOUBLE; ++i) fill(c, 1 + i * gap);
    array_.numbers = bytes_.empty() || c.chance(3) ? nullptr : bytes_.data() + 1;
    before_ = bytes_;
  }
  const breve_array* to() const { return &array_; }
  /// Whether something was written.
  bool changed() const { return bytes_ != before_; }

 private:
  void fill(Caller& c, std::size_t at) {
    for (std::size_t k = 0; k < array_.width; ++k) {
      const double wide = c.chance(95) ? c.finite() : c.number();
      const float narrow = static_cast<float>(wide);
      if (array_.number == BREVE_NUMBER_FLOAT)
        std::memcpy(bytes_.data() + at + k * sizeof narrow, &narrow, sizeof narrow);
      else
        std::memcpy(bytes_.data() + at + k * sizeof wide, &wide, sizeof wide);
    }
  }

  breve_array array_{};
  std::vector<std::uint8_t> bytes_, before_;
};

std::vector<breve_object> some_objects(Caller& c, const breve_world* world, const char* class_name) {
  std::vector<breve_object> all(c.word() % 5);
  for (breve_object& one : all) one = c.chance(90) ? c.object(world, class_name) : c.any_object(world, class_name);
  return all;
}

std::size_t width_of(std::uint32_t property) {
  constexpr std::size_t kWidths[] = {3, 4, 7, 3, 3, 4};
  return property < std::size(kWidths) ? kWidths[property] : 3;
}

breve_status objects_property(Caller& c) {
  const breve_world* world = c.world();
  const std::vector<breve_object> all = some_objects(c, world, "Real");
  const std::uint32_t property = c.word() % 7;
  const Rows rows(c, all.size(), width_of(property));
  const breve_status status = breve_objects_property(world, all.data(), all.size(), property, rows.to());
  require(status == BREVE_OK || !rows.changed(), "rows were written in spite of an error");
  return status;
}
breve_status objects_set_property(Caller& c) {
  breve_world* world = c.world();
  const std::vector<breve_object> all = some_objects(c, world, "Real");
  const std::uint32_t property = c.word() % 7;
  const Rows rows(c, all.size(), width_of(property));
  const breve_status status = breve_objects_set_property(world, all.data(), all.size(), property, rows.to());
  require(!rows.changed(), "rows that are read were written");
  return status;
}

const char* variable_name(Caller& c) {
  static constexpr const char* kNames[] = {"number", "real", "place", "name", "marks", "friend", ""};
  return c.text_or_null(kNames[c.word() % std::size(kNames)]);
}

breve_status objects_get(Caller& c) {
  const breve_world* world = c.world();
  const std::vector<breve_object> all = some_objects(c, world, "Parrot");
  const Rows rows(c, all.size(), c.chance(70) ? 1 : 3);
  const breve_status status = breve_objects_get(world, all.data(), all.size(), variable_name(c), rows.to());
  require(status == BREVE_OK || !rows.changed(), "rows were written in spite of an error");
  return status;
}
breve_status objects_set(Caller& c) {
  breve_world* world = c.world();
  const std::vector<breve_object> all = some_objects(c, world, "Parrot");
  const Rows rows(c, all.size(), c.chance(70) ? 1 : 3);
  const breve_status status = breve_objects_set(world, all.data(), all.size(), variable_name(c), rows.to());
  require(!rows.changed(), "rows that are read were written");
  return status;
}

breve_status objects_call_prepared(Caller& c) {
  breve_world* world = c.world();
  const std::vector<breve_object> all = some_objects(c, world, nullptr);
  PreparedSelector prepared;
  if (!c.selectors().empty() && c.chance(95)) prepared = c.choose().one_of(c.selectors());
  std::vector<breve_value> arguments;
  for (std::size_t i = 0; i < prepared.keywords; ++i) arguments.push_back(c.value(world));
  std::vector<breve_value> results(all.size());
  const breve_status status =
      breve_objects_call_prepared(world, all.data(), all.size(), prepared.selector, arguments.data(), arguments.size(),
                                  c.chance(50) ? results.data() : nullptr);
  for (const breve_value& result : results)
    if (result.type == BREVE_TYPE_OBJECT) c.keep(result.as.object);
  return status;
}

constexpr Function kFunctions[] = {
    {"breve_objects_property", objects_property, kBody, 2},
    {"breve_objects_set_property", objects_set_property, kBody | kScriptError, 2},
    {"breve_objects_get", objects_get, kVariable | kType, 2},
    {"breve_objects_set", objects_set, kVariable | kType, 2},
    {"breve_objects_call_prepared", objects_call_prepared, kScript | kValue | kType | kNotFound, 2},
};

}  // namespace call_bulk

std::span<const Function> bulk_functions() { return call_bulk::kFunctions; }

}  // namespace breve::fuzz
