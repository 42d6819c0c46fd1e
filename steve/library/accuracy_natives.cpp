// Natives of Control and PhysicalControl that set how bodies with physics are computed, and read what came of it.
#include <fmt/format.h>

#include <array>

#include "steve/library/ledger_values.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

// --- accuracy -------------------------------------------------------------------------------------------------------

void set_accuracy(Machine& machine, Instance&, Text rung) { dynamics_of(machine).set_accuracy(rung_named(view(rung))); }

Text get_accuracy(Machine& machine, Instance&) {
  return machine.heap().string(name_of(dynamics_of(machine).accuracy().rung));
}

Text describe_accuracy(Machine& machine, Instance&) {
  return machine.heap().string(dynamics_of(machine).describe_accuracy());
}

/// A setting of a rung that is a number or a switch, by its name.
struct Setting {
  std::string_view name;
  double (*get)(const Accuracy&);
  void (*set)(Accuracy&, double);
};

template <auto Member>
constexpr Setting setting(std::string_view name) {
  return {name, [](const Accuracy& a) { return static_cast<double>(a.*Member); },
          [](Accuracy& a, double value) {
            using Type = std::remove_reference_t<decltype(a.*Member)>;
            if constexpr (std::is_same_v<Type, bool>)
              a.*Member = value != 0;
            else
              a.*Member = static_cast<Type>(value);
          }};
}

constexpr std::array kSettings = {setting<&Accuracy::step>("step"),
                                  setting<&Accuracy::contact_step>("contact-step"),
                                  setting<&Accuracy::tolerance>("tolerance"),
                                  setting<&Accuracy::iterations>("iterations"),
                                  setting<&Accuracy::impacts>("impacts"),
                                  setting<&Accuracy::direct>("direct"),
                                  setting<&Accuracy::locate_impacts>("locate-impacts"),
                                  setting<&Accuracy::implicit_joints>("implicit-joints"),
                                  setting<&Accuracy::implicit_spin>("implicit-spin"),
                                  setting<&Accuracy::contact_springs>("contact-springs"),
                                  setting<&Accuracy::link_springs>("link-springs"),
                                  setting<&Accuracy::contact_stiffness>("contact-stiffness"),
                                  setting<&Accuracy::contact_damping>("contact-damping")};

/// What a flat world goes by; the others are of integrators and solvers that it has not.
constexpr std::array<std::string_view, 5> kFlatSettings = {"step", "contact-step", "iterations", "impacts",
                                                           "locate-impacts"};

const Setting& setting_named(std::string_view name, std::string_view selector) {
  std::string names;
  for (const Setting& one : kSettings) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  throw Error(ErrorCode::Argument,
              std::string(selector) + ": no setting '" + std::string(name) + "'; the settings are " + names);
}

void set_setting(Machine& machine, Instance&, Text name, double value) {
  const Setting& one = setting_named(view(name), "set-accuracy-setting");
  finite(value, "set-accuracy-setting: the value");
  if (std::abs(value) > 1e9)
    throw Error(ErrorCode::Argument, "set-accuracy-setting: " + fmt::to_string(value) + " is too large");
  if (std::find(kFlatSettings.begin(), kFlatSettings.end(), one.name) == kFlatSettings.end())
    warn_if_flat(machine, one.name,
                 "the accuracy setting '" + std::string(one.name) +
                     "' has no effect in a flat world: set-accuracy chooses its sub-steps, and the settings step, "
                     "contact-step, iterations, impacts and locate-impacts can be set alone");
  Accuracy accuracy = dynamics_of(machine).accuracy();
  one.set(accuracy, value);
  accuracy.custom = true;
  dynamics_of(machine).set_accuracy(accuracy);
}

double get_setting(Machine& machine, Instance&, Text name) {
  return setting_named(view(name), "get-accuracy-setting").get(dynamics_of(machine).accuracy());
}

// KEEP IN STEP: order of articulated::Scheme.
constexpr std::array<std::string_view, 9> kIntegrators = {
    "explicit-euler", "semi-implicit-euler", "implicit-euler", "velocity-verlet",  "implicit-midpoint",
    "runge-kutta-4",  "fehlberg-4",          "fehlberg-5",     "fehlberg-adaptive"};

void set_integrator(Machine& machine, Instance&, Text name) {
  std::string names;
  for (std::size_t i = 0; i < kIntegrators.size(); ++i) {
    names += (names.empty() ? "" : ", ") + std::string(kIntegrators[i]);
    if (kIntegrators[i] != view(name)) continue;
    warn_if_flat(machine, "integrator",
                 "set-integrator has no effect in a flat world: set-accuracy chooses how many sub-steps it takes, and "
                 "set-accuracy-setting named \"step\" the longest one");
    Accuracy accuracy = dynamics_of(machine).accuracy();
    accuracy.scheme = static_cast<articulated::Scheme>(i);
    accuracy.custom = true;
    return dynamics_of(machine).set_accuracy(accuracy);
  }
  throw Error(ErrorCode::Argument,
              "set-integrator: no integrator '" + std::string(view(name)) + "'; the integrators are " + names);
}

Text get_integrator(Machine& machine, Instance&) {
  return machine.heap().string(kIntegrators.at(static_cast<std::size_t>(dynamics_of(machine).accuracy().scheme)));
}

// --- guard, workers, what came of it --------------------------------------------------------------------------------

void set_guard(Machine& machine, Instance&, Text mode) { dynamics_of(machine).set_guard(guard_named(view(mode))); }

Text get_guard(Machine& machine, Instance&) { return machine.heap().string(name_of(dynamics_of(machine).guard())); }

ListCell* get_interventions(Machine& machine, Instance&) {
  return interventions_value(machine, dynamics_of(machine).interventions());
}

void set_workers(Machine& machine, Instance&, std::int32_t workers) {
  constexpr std::int32_t kMost = 256;
  if (workers < 1 || workers > kMost)
    throw Error(ErrorCode::Argument, "set-workers: " + std::to_string(workers) + " is not between 1 and 256");
  if (workers > 1)
    warn_if_flat(machine, "workers",
                 "set-workers has no effect in a flat world: it is computed by one thread; run several worlds side by "
                 "side instead");
  dynamics_of(machine).set_workers(workers);
}

std::int32_t get_workers(Machine& machine, Instance&) { return dynamics_of(machine).workers(); }

HashCell* get_counters(Machine& machine, Instance&) { return counters_value(machine, dynamics_of(machine).counters()); }

/// The energy of all bodies, counted.
Energy energy_of(Machine& machine) {
  machine.charge(machine.world().object_count());
  return dynamics_of(machine).energy();
}

double get_energy(Machine& machine, Instance&) { return energy_of(machine).total(); }
double get_residual(Machine& machine, Instance&) { return energy_of(machine).residual; }
double get_motor_work(Machine& machine, Instance&) { return energy_of(machine).motor_work; }
double get_contact_loss(Machine& machine, Instance&) { return contact_loss_of(energy_of(machine)); }
HashCell* get_ledger(Machine& machine, Instance&) { return ledger_value(machine, energy_of(machine)); }

// --- PhysicalControl ------------------------------------------------------------------------------------------------

void set_gravity(Machine& machine, Instance&, Vector3 gravity) {
  finite(gravity, "set-gravity: the gravity");
  machine.world().set_gravity(gravity);
}

Vector3 get_gravity(Machine& machine, Instance&) { return machine.world().gravity(); }

void set_fast_contacts(Machine& machine, Instance&, std::int32_t iterations) {
  dynamics_of(machine).set_fast_contacts(iterations);
}

template <bool On>
void set_sleeping(Machine& machine, Instance&) {
  dynamics_of(machine).set_sleeping(On);
}

/// Where contacts are solved exactly nothing reads the softness.
void say_if_ignored(Machine& machine) {
  warn_if_flat(
      machine, "softness",
      "set-erp and set-cfm have no effect in a flat world: contacts are rigid and rest with an overlap of 0.005 "
      "length units (set-length-unit); a Spring is soft");
  if (dynamics_of(machine).dimension() == 2) return;
  if (dynamics_of(machine).accuracy().direct)
    machine.warn_once("control.softness",
                      "set-erp and set-cfm are ignored where contacts are solved exactly; they are for the iterative "
                      "solver (enable-fast-physics, or set-accuracy to \"fast\")");
}

double number_at_least_zero(double value, const char* what) {
  if (!(std::isfinite(value) && value >= 0))
    throw Error(ErrorCode::Argument, std::string(what) + " is " + fmt::to_string(value) + " (must be 0 or more)");
  return value;
}

void set_erp(Machine& machine, Instance&, double erp) {
  Mechanics& dynamics = dynamics_of(machine);
  dynamics.set_softness(number_at_least_zero(erp, "set-erp: the error reduction"), dynamics.cfm());
  say_if_ignored(machine);
}

void set_cfm(Machine& machine, Instance&, double cfm) {
  Mechanics& dynamics = dynamics_of(machine);
  dynamics.set_softness(dynamics.erp(), number_at_least_zero(cfm, "set-cfm: the softness"));
  say_if_ignored(machine);
}

// --- PlanarControl --------------------------------------------------------------------------------------------------

void flatten(Machine& machine, Instance&) { machine.world().flatten(); }

void set_length_unit(Machine& machine, Instance&, double unit) {
  finite(unit, "set-length-unit: the length unit");
  dynamics_of(machine).set_length_unit(unit);
}

double get_length_unit(Machine& machine, Instance&) { return dynamics_of(machine).length_unit(); }

constexpr Native kAccuracyNatives[] = {
    native<set_accuracy>("control.set-accuracy"),
    native<get_accuracy>("control.get-accuracy"),
    native<describe_accuracy>("control.describe-accuracy"),
    native<set_setting>("control.set-accuracy-setting"),
    native<get_setting>("control.get-accuracy-setting"),
    native<set_integrator>("control.set-integrator"),
    native<get_integrator>("control.get-integrator"),
    native<set_guard>("control.set-guard"),
    native<get_guard>("control.get-guard"),
    native<get_interventions>("control.get-interventions"),
    native<set_workers>("control.set-workers"),
    native<get_workers>("control.get-workers"),
    native<get_counters>("control.get-dynamics-counters"),
    native<get_energy>("physical-control.get-energy"),
    native<get_residual>("physical-control.get-energy-residual"),
    native<get_motor_work>("physical-control.get-motor-work"),
    native<get_contact_loss>("physical-control.get-contact-loss"),
    native<get_ledger>("physical-control.get-energy-ledger"),
    native<set_gravity>("physical-control.set-gravity"),
    native<get_gravity>("physical-control.get-gravity"),
    native<set_fast_contacts>("physical-control.set-fast-contacts"),
    native<set_sleeping<true>>("physical-control.enable-auto-disable"),
    native<set_sleeping<false>>("physical-control.disable-auto-disable"),
    native<set_erp>("physical-control.set-erp"),
    native<set_cfm>("physical-control.set-cfm"),
    native<flatten>("planar-control.flatten"),
    native<set_length_unit>("physical-control.set-length-unit"),
    native<get_length_unit>("physical-control.get-length-unit"),
};

}  // namespace

std::span<const Native> accuracy_natives() { return kAccuracyNatives; }

}  // namespace breve::steve
