// The function that defines types of infrared sensors for the class IRSensor of the library.
#include <array>

#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

/// { count, values, factors }, as IRSensorKind takes it.
Value table_of(Machine& machine, std::int32_t count, ListCell* values, ListCell* factors) {
  Heap& heap = machine.heap();
  ListCell* list = heap.list(3);
  const Value table = Value::of(Tag::List, list);
  const Pin pin(machine, table);
  heap.push(*list, Value::of(count));
  for (ListCell* numbers : {values, factors})
    heap.push(*list, Value::of(Tag::List, numbers != nullptr ? numbers : heap.list(0)));
  return table;
}

/// Makes an IRSensorKind, which replaces one of the same name: of several the last one counts.
void create_user_sensor(Machine& machine, Instance&, Text name, std::int32_t rows, std::int32_t columns, double range,
                        double angle, std::int32_t distances, ListCell* at_distance, ListCell* by_distance,
                        std::int32_t azimuths, ListCell* at_azimuth, ListCell* by_azimuth, std::int32_t incidences,
                        ListCell* at_incidence, ListCell* by_incidence) {
  const ClassInfo* cls = machine.program().find_class("IRSensorKind");
  if (!cls)
    throw RunError(RunErrorKind::UnknownClass, "createUserSensor: the program does not use IRSensor",
                   "add '@use IRSensor.' at its beginning");
  Instance* kind = machine.create(*cls);
  const Value distance_table = table_of(machine, distances, at_distance, by_distance);
  const Pin first(machine, distance_table);
  const Value azimuth_table = table_of(machine, azimuths, at_azimuth, by_azimuth);
  const Pin second(machine, azimuth_table);
  const Value incidence_table = table_of(machine, incidences, at_incidence, by_incidence);
  const Pin third(machine, incidence_table);
  const std::pair<std::string_view, Value> keywords[] = {{"with-name", Value::of(Tag::String, name)},
                                                         {"with-rows", Value::of(rows)},
                                                         {"with-columns", Value::of(columns)},
                                                         {"with-range", Value::of(range)},
                                                         {"with-angle", Value::of(angle)},
                                                         {"with-distances", distance_table},
                                                         {"with-azimuths", azimuth_table},
                                                         {"with-incidences", incidence_table}};
  machine.call_with_keywords(*kind, "set-up", keywords);
}

constexpr std::array kSensorFunctions = {native<create_user_sensor>("createUserSensor")};

}  // namespace

std::span<const Native> sensor_functions() { return kSensorFunctions; }

}  // namespace breve::steve
