// The rungs of accuracy: their settings, what settings must be, and what they mean in words.
#include "runtime/mechanics/accuracy.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

// KEEP IN STEP: articulated::Scheme.
constexpr std::array<std::string_view, 9> kSchemes{
    "explicit Euler",          "semi-implicit Euler",     "implicit Euler",
    "velocity Verlet",         "implicit midpoint",       "Runge-Kutta 4",
    "Fehlberg 4, fixed steps", "Fehlberg 5, fixed steps", "Fehlberg with step control"};

void need(bool holds, std::string_view setting, double value, std::string_view rule) {
  if (!holds) throw Error(ErrorCode::Argument, fmt::format("accuracy: {} is {} (must be {})", setting, value, rule));
}

}  // namespace

Accuracy accuracy_of(Rung rung) {
  using articulated::Scheme;
  Accuracy a;
  a.rung = rung;
  switch (rung) {
    case Rung::Fast:
      a.scheme = Scheme::SemiImplicitEuler;
      a.implicit_joints = true;
      a.direct = false;
      a.locate_impacts = false;
      a.iterations = 12;
      break;
    case Rung::Balanced: a.contact_step = 1.0 / 200; break;
    case Rung::Precise:
      // A light chain that carries a heavy load swings at thousands of rad/s, where the classic scheme alone would blow
      // up at this step.
      a.scheme = Scheme::RungeKutta4;
      a.tolerance = 1e-4;
      a.implicit_spin = false;
      a.step = 1.0 / 480;
      break;
    case Rung::Reference:
      a.implicit_spin = false;
      a.tolerance = 1e-10;
      a.contact_step = 1.0 / 480;
      break;
    case Rung::Conserving:
      a.scheme = Scheme::ImplicitMidpoint;
      a.step = 1.0 / 200;
      break;
  }
  return a;
}

void check(const Accuracy& a) {
  // In a shorter sub-step nothing that is metres away moves at all.
  constexpr double kShortest = 1e-11;
  const auto is_step = [](double step) { return std::isfinite(step) && (step == 0 || step >= kShortest); };
  need(is_step(a.step), "step", a.step, "finite, and 0 or at least 1e-11 s");
  need(is_step(a.contact_step), "contact step", a.contact_step, "finite, and 0 or at least 1e-11 s");
  need(std::isfinite(a.tolerance) && a.tolerance > 0, "tolerance", a.tolerance, "finite and > 0");
  need(a.iterations > 0 && a.iterations <= kMostIterations, "iterations", a.iterations, "1 to 10,000");
  need(a.impacts >= 0, "impacts", a.impacts, ">= 0");
  need(std::isfinite(a.contact_stiffness) && a.contact_stiffness > 0, "contact stiffness", a.contact_stiffness,
       "finite and > 0");
  need(a.contact_damping >= 0 && a.contact_damping <= 0.9, "contact damping", a.contact_damping, "0 to 0.9");
  need(static_cast<std::size_t>(a.scheme) < kSchemes.size(), "integrator", static_cast<double>(a.scheme),
       "an existing one");
  need(a.rung <= Rung::Conserving, "rung", static_cast<double>(a.rung), "an existing one");
}

std::string describe(const Accuracy& a) {
  std::string text = fmt::format("{}{}: smooth motion by {}", name_of(a.rung), a.custom ? ", with custom settings" : "",
                                 kSchemes[static_cast<std::size_t>(a.scheme)]);
  if (a.scheme == articulated::Scheme::RungeKutta4) text += ", hard steps by Fehlberg with step control";
  if (a.scheme == articulated::Scheme::FehlbergAdaptive || a.scheme == articulated::Scheme::RungeKutta4)
    text += fmt::format(" at tolerance {}", a.tolerance);
  if (a.step > 0) text += fmt::format(", steps of at most {} s", a.step);
  if (a.implicit_joints) text += ", springs, dampers and motors of joints implicit";
  text += a.implicit_spin ? "; the rotation of a free body by the implicit midpoint rule"
                          : "; the rotation of a free body likewise";
  text += a.locate_impacts ? fmt::format("; up to {} impacts of an island at their time of impact", a.impacts)
                           : "; impacts at the end of the sub-step";
  text += a.direct ? "; small islands of contacts solved directly, large ones" : "; contacts solved";
  text += fmt::format(" iteratively with at most {} iterations", a.iterations);
  if (a.contact_springs && a.locate_impacts) {
    text += fmt::format("; slow contacts with restitution{} as springs of {} N/m per kg, damped ",
                        a.link_springs ? "" : " of bodies without joints", a.contact_stiffness);
    text += a.contact_damping > 0 ? fmt::format("by a ratio of {}", a.contact_damping) : "to that restitution";
  }
  return text + ".";
}

}  // namespace breve
