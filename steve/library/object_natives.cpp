// Natives of Object: identity, schedule, notifications, calls by name; and the obsolete selectors of every class.
#include <fmt/format.h>

#include <cmath>

#include "steve/code/wording.hpp"
#include "steve/library/obsolete.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

// --- identity --------------------------------------------------------------------------------------------------------

// KEEP IN STEP: Object.tz declares `controller` and `birthTime` first, so that creating an object looks nothing up.
constexpr std::uint32_t kControllerSlot = 0, kBirthTimeSlot = 1;

void object_init(Machine& machine, Instance& self) {
  machine.heap().store(self.slots[kControllerSlot], machine.controller());
  self.slots[kBirthTimeSlot].d = machine.world().time();
}

double object_get_age(Machine& machine, Instance& self) {
  return machine.world().time() - self.slots[kBirthTimeSlot].d;
}

Text object_get_type(Machine& machine, Instance& self) { return machine.heap().string(self.cls->name); }

std::int32_t object_is(Machine&, Instance& self, Text name) {
  for (const ClassInfo* cls = self.cls; cls; cls = cls->parent)
    if (cls->name == view(name) || (!cls->alias.empty() && cls->alias == view(name))) return 1;
  return 0;
}

std::int32_t object_can_respond(Machine& machine, Instance& self, Text method) {
  return machine.responds(*self.cls, view(method));
}

// --- schedule --------------------------------------------------------------------------------------------------------

// The method may come with a reload, so it is not an error yet.
void check_scheduled(Machine& machine, const Instance& self, Text method) {
  if (!machine.find_method(*self.cls, view(method), 0))
    machine.report_unknown_method(
        Severity::Warning, self, view(method),
        "a scheduled call needs one without parameters, and the run will end with an error at its time");
}

void object_schedule(Machine& machine, Instance& self, Text method, double when) {
  check_scheduled(machine, self, method);
  if (!std::isfinite(when) || !machine.world().schedule(self.id, view(method), when))
    machine.warn("schedule: time " + fmt::to_string(when) + " is not in the future; '" + std::string(view(method)) +
                 "' will not be called");
}

void object_schedule_repeating(Machine& machine, Instance& self, Text method, double interval) {
  World& world = machine.world();
  if (!(interval > 0) || !std::isfinite(interval)) {
    constexpr std::uint64_t kOfWarning = 32;  // loop iterations
    machine.charge(kOfWarning);
    machine.warn("schedule-repeating: interval " + fmt::to_string(interval) + " is not more than 0; '" +
                 std::string(view(method)) + "' will not be called");
    return;
  }
  check_scheduled(machine, self, method);
  // First at the absolute time `interval`; the world starts an interval from now instead if that is past.
  world.schedule(self.id, view(method), interval, interval);
}

void object_unschedule(Machine& machine, Instance& self, Text method, double when) {
  constexpr std::uint64_t kOfSearch = 4;  // loop iterations
  machine.charge(kOfSearch);
  // Without the name of a method each of the object's calls is looked at.
  if (view(method).empty()) machine.charge(machine.world().scheduled_count());
  machine.world().unschedule(self.id, view(method), when);
}

// --- notifications ---------------------------------------------------------------------------------------------------

std::int32_t object_observe(Machine& machine, Instance& self, Instance* announcer, Text message, Text method) {
  const Instance& source = must_live(announcer, "observe: the instance");
  const std::string name(view(method));
  for (std::size_t count : {2, 1, 0}) {
    if (!machine.find_method(*self.cls, name, count)) continue;
    machine.world().observe(self.id, source.id, view(message), name);
    return 0;
  }
  machine.report_unknown_method(Severity::Warning, self, name,
                                "an observer needs one with 0, 1 or 2 keywords; nothing is registered");
  return -1;
}

void object_unobserve(Machine& machine, Instance& self, Instance* announcer, Text message) {
  machine.world().unobserve(self.id, machine.id_of(announcer), view(message));
}

void object_announce(Machine& machine, Instance& self, Text message) {
  machine.world().announce(self.id, view(message));
}

// --- calls by name ---------------------------------------------------------------------------------------------------

Value call_named(Machine& machine, Instance& self, Text name, std::span<const Value> arguments) {
  const MethodInfo* method = machine.find_method(*self.cls, view(name), arguments.size());
  if (!method) {
    const RunError error(RunErrorKind::UnknownMethod,
                         "call-method: " + name_of(self) + " has no method '" + std::string(view(name)) + "' with " +
                             std::to_string(arguments.size()) + (arguments.size() == 1 ? " keyword" : " keywords"),
                         unknown_method_help(view(name), self.cls, machine.program()));
    if (machine.host().strict) throw RunError(error);
    machine.survive(error);
    return {};
  }
  if (machine.host().strict) return machine.call(self, *method, arguments);
  Value result;
  if (!machine.call_guarded(self, *method, arguments, result)) return {};
  return result;
}

Value object_call_method(Machine& machine, Instance& self, Text name) { return call_named(machine, self, name, {}); }

Value object_call_method_with(Machine& machine, Instance& self, Text name, ListCell* arguments) {
  if (!arguments) return call_named(machine, self, name, {});
  // A copy: the method may change the list. The list itself, in the caller's frame, keeps the elements alive only
  // until then; the callee's frame holds them from the moment it starts.
  const std::vector<Value> values(arguments->begin(), arguments->end());
  return call_named(machine, self, name, values);
}

// --- obsolete --------------------------------------------------------------------------------------------------------

/// The answer to a program that asks for a dialog without a user: 1.
template <Selector S>
std::int32_t obsolete_dialog(Machine& machine, Instance& self) {
  obsolete<S>(machine, self);
  return 1;
}

/// The numbers that QSystem returns look like a result. The warning says that they are not one.
void quantum_warn(Machine& machine, Instance&) {
  machine.warn_once("quantum", "QSystem test: quantum circuits are not simulated; every test counts as failed");
}

constexpr Native kObjectNatives[] = {
    native<object_init>("object.init"),
    native<object_get_age>("object.get-age"),
    native<object_get_type>("object.get-type"),
    native<object_is>("object.is"),
    native<object_is>("object.is-a"),
    native<object_is>("object.is-a-subclass"),
    native<object_can_respond>("object.can-respond"),
    native<object_schedule>("object.schedule"),
    native<object_schedule_repeating>("object.schedule-repeating"),
    native<object_unschedule>("object.unschedule"),
    native<object_observe>("object.observe"),
    native<object_unobserve>("object.unobserve"),
    native<object_announce>("object.announce"),
    native<object_call_method>("object.call-method"),
    native<object_call_method_with>("object.call-method-with"),
};

constexpr Native kObsoleteNatives[] = {
    native<obsolete<"beep">>("obsolete.beep"),
    native<obsolete<"disable-smooth-drawing">>("obsolete.disable-smooth-drawing"),
    native<obsolete<"get-grid-pointer", PointerCell*>>("obsolete.get-grid-pointer"),
    native<obsolete<"set-patch-pointer", void, PointerCell*>>("obsolete.set-patch-pointer"),
    native<obsolete<"enable-smooth-drawing">>("obsolete.enable-smooth-drawing"),
    native<obsolete<"get-data-for-shape", DataCell*>>("obsolete.get-data-for-shape"),
    native<obsolete<"get-interface-version", Text>>("obsolete.get-interface-version"),
    native<obsolete<"get-program-pointer", PointerCell*>>("obsolete.get-program-pointer"),
    native<quantum_warn>("quantum.warn"),
    native<obsolete<"get-link-pointer", PointerCell*>>("obsolete.get-link-pointer"),
    native<obsolete<"get-joint-pointer", PointerCell*>>("obsolete.get-joint-pointer"),
    native<obsolete<"get-multibody-pointer", PointerCell*>>("obsolete.get-multibody-pointer"),
    native<obsolete<"get-matrix-pointer", PointerCell*>>("obsolete.get-matrix-pointer"),
    native<obsolete<"get-interpreter-pointer", PointerCell*>>("obsolete.get-interpreter-pointer"),
    native<obsolete<"get-code-pointer", PointerCell*>>("obsolete.get-code-pointer"),
    native<obsolete<"set-code-pointer", void, PointerCell*>>("obsolete.set-code-pointer"),
    native<obsolete<"get-pixel-pointer", PointerCell*>>("obsolete.get-pixel-pointer"),
    native<obsolete<"get-pointer", PointerCell*>>("obsolete.get-pointer"),
    native<obsolete<"get-vector-pointer", PointerCell*>>("obsolete.get-vector-pointer"),
    native<obsolete<"get-world-object-pointer", PointerCell*>>("obsolete.get-world-object-pointer"),
    native<obsolete<"report-object-allocation">>("obsolete.report-object-allocation"),
    native<obsolete<"set-camera-pointer", void, PointerCell*>>("obsolete.set-camera-pointer"),
    native<obsolete<"set-interface-item", std::int32_t, std::int32_t, Text>>("obsolete.set-interface-item"),
    native<obsolete<"set-matrix-pointer", void, PointerCell*, std::int32_t, std::int32_t>>(
        "obsolete.set-matrix-pointer"),
    native<obsolete<"set-output-filter", void, std::int32_t>>("obsolete.set-output-filter"),
    native<obsolete<"set-vector-pointer", void, PointerCell*, std::int32_t>>("obsolete.set-vector-pointer"),
    native<obsolete<"show-dialog", std::int32_t, Text, Text, Text, Text>>("obsolete.show-dialog"),
    native<obsolete<"toggle-smooth">>("obsolete.toggle-smooth"),
    native<obsolete_dialog<"save-with-dialog">>("obsolete.save-with-dialog"),
    native<obsolete_dialog<"load-with-dialog">>("obsolete.load-with-dialog"),
};

}  // namespace

std::span<const Native> object_natives() { return kObjectNatives; }
std::span<const Native> obsolete_natives() { return kObsoleteNatives; }

}  // namespace breve::steve
