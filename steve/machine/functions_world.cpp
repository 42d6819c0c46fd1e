// Functions on the clock, the schedule, the run, the host and its user.
#include <array>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

void refuse_right(std::string_view function, std::string_view what, std::string_view right) {
  throw RunError(RunErrorKind::World, fmt::format("{}: the host does not let scripts {}", function, what),
                 fmt::format("the host allows it with {} in the rights of its runtime", right));
}

namespace {

double get_time(Machine& machine, Instance&) { return machine.world().time(); }

void need_clock(Machine& machine, const char* function) {
  if (!machine.host().may_read_clock) refuse_right(function, "read the real-time clock", "BREVE_RIGHT_REAL_TIME");
}

double from_outside(Machine& machine, double seconds) {
  if (machine.host().from_outside) machine.host().from_outside(&seconds, sizeof seconds);
  return seconds;
}

double get_real_time(Machine& machine, Instance&) {
  need_clock(machine, "getRealTime");
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return from_outside(machine, std::chrono::duration<double>(now).count());
}

/// Wall-clock seconds since the embedder made the machine's host.
double get_running_time(Machine& machine, Instance&) {
  need_clock(machine, "getRunningTime");
  const auto passed = std::chrono::steady_clock::now() - machine.host().started;
  return from_outside(machine, std::chrono::duration<double>(passed).count());
}

/// Once at `time`, or again and again from then on. A repeated call whose first time has passed starts one interval
/// from now.
void add_event(Machine& machine, Instance& self, StringCell* method, double time, double interval) {
  World& world = machine.world();
  const ObjectId id = machine.id_of(&self);
  if (!id) return;
  if (!machine.find_method(*self.cls, view(method), 0))
    machine.report_unknown_method(
        Severity::Warning, self, view(method),
        "a scheduled call needs one without parameters, and the run will end with an error at its time");
  if (interval > 0 && time <= world.time()) time = world.time() + interval;
  if (world.schedule(id, view(method), time, interval)) return;
  machine.warn(fmt::format("'{}' is not scheduled: the time {:f} is not in the future, the clock reads {:f}",
                           view(method), time, world.time()));
}

void remove_event(Machine& machine, Instance& self, StringCell* method, double time) {
  if (view(method).empty()) machine.charge(machine.world().scheduled_count());
  if (self.live()) machine.world().unschedule(self.id, view(method), time);
}

void end_simulation(Machine& machine, Instance&) { machine.world().request_end(); }
void pause_simulation(Machine& machine, Instance&) { machine.world().set_paused(true); }
void unpause_simulation(Machine& machine, Instance&) { machine.world().set_paused(false); }

void sleep_for(Machine& machine, Instance&, double seconds) {
  if (!machine.host().may_sleep) refuse_right("sleep", "sleep", "BREVE_RIGHT_SLEEP");
  constexpr double kLongest = 86400;            // a day: keeps the conversion to integers sound
  constexpr double kIterationsPerSecond = 1e7;  // what is slept counts as much as work that takes as long
  constexpr double kPiece = 0.01;               // s: how soon an interrupt is seen
  if (!(seconds > 0)) return;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(std::fmin(seconds, kLongest));
  machine.charge(static_cast<std::uint64_t>(std::fmin(seconds, kLongest) * kIterationsPerSecond));
  if (machine.host().replays && machine.host().replays()) return;
  for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(end - now, std::chrono::duration<double>(kPiece)));
    machine.poll();
  }
}

StringCell* run_command(Machine& machine, Instance&, StringCell* command) {
  if (!machine.host().system)
    throw RunError(RunErrorKind::World,
                   "system: the host does not allow scripts to run commands of the operating system",
                   "the host allows it with a callback `system`, and `breve run` with --allow-system");
  return machine.heap().string(machine.host().system(view(command)));
}

std::int32_t argument_count(Machine& machine, Instance&) {
  return static_cast<std::int32_t>(machine.host().arguments.size());
}

StringCell* argument_at(Machine& machine, Instance&, std::int32_t i) {
  const auto& arguments = machine.host().arguments;
  if (i < 0 || static_cast<std::size_t>(i) >= arguments.size())
    Machine::fail(RunErrorKind::Bounds,
                  fmt::format("getArgv({}): there are {} arguments, 0 is the program", i, arguments.size()));
  return machine.heap().string(arguments[static_cast<std::size_t>(i)]);
}

StringCell* path_of_file(Machine& machine, Instance&, StringCell* name) {
  if (!machine.host().open_for_reading) return nullptr;
  return machine.heap().string(find_file(machine, view(name)));
}

void show_stack_trace(Machine& machine, Instance&) {
  constexpr std::uint64_t kOfCall = 8;  // iterations, for each active method
  machine.charge(kOfCall * machine.depth());
  machine.warn("stacktrace\n" + machine.stack_trace());
}

// Without a view there is no mouse, no keyboard, no bell and nobody to ask.
std::int32_t no_mouse(Machine&, Instance&) { return 0; }
StringCell* no_keys(Machine&, Instance&) { return nullptr; }
void no_sound(Machine&, Instance&) {}
std::int32_t no_dialog(Machine&, Instance&, StringCell*, StringCell*, StringCell*, StringCell*) { return 0; }

constexpr std::array kWorldFunctions = {
    native<get_time>("getTime"),
    native<get_real_time>("getRealTime", Reach::RealTime),
    native<get_running_time>("getRunningTime", Reach::RealTime),
    native<add_event>("addEvent"),
    native<remove_event>("removeEvent"),
    native<end_simulation>("endSimulation"),
    native<pause_simulation>("pauseSimulation"),
    native<unpause_simulation>("unpauseSimulation"),
    native<sleep_for>("sleep", Reach::Sleeps),
    native<run_command>("system", Reach::Commands),
    native<argument_count>("getArgc"),
    native<argument_at>("getArgv"),
    native<path_of_file>("findFile", Reach::Reads),
    native<show_stack_trace>("stacktrace"),
    native<no_mouse>("getMouseX"),
    native<no_mouse>("getMouseY"),
    native<no_keys>("getAllPressedKeys"),
    native<no_sound>("playSound"),
    native<no_dialog>("dialogBox"),
};

}  // namespace

std::span<const Native> world_functions() { return kWorldFunctions; }

}  // namespace breve::steve
