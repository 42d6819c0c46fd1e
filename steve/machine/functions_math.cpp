// Functions on numbers, vectors, matrices, colours, and the random ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

/// As `print` has it; {:f} takes a hundred times as long to write 1e308.
std::string shown(double number) {
  std::string text;
  append_double(text, number);
  return text;
}

/// A result that is not a number gives a warning, once per function.
double checked(Machine& machine, std::string_view name, double argument, double result) {
  if (!std::isfinite(result)) [[unlikely]]
    machine.warn_once(name, [&] { return fmt::format("{}({}) is {}", name, shown(argument), shown(result)); });
  return result;
}

double sine(Machine& m, Instance&, double x) { return checked(m, "sin", x, std::sin(x)); }
double cosine(Machine& m, Instance&, double x) { return checked(m, "cos", x, std::cos(x)); }
double tangent(Machine& m, Instance&, double x) { return checked(m, "tan", x, std::tan(x)); }
double arc_sine(Machine& m, Instance&, double x) { return checked(m, "asin", x, std::asin(x)); }
double arc_cosine(Machine& m, Instance&, double x) { return checked(m, "acos", x, std::acos(x)); }
double arc_tangent(Machine& m, Instance&, double x) { return checked(m, "atan", x, std::atan(x)); }
double square_root(Machine& m, Instance&, double x) { return checked(m, "sqrt", x, std::sqrt(x)); }
double exponential(Machine& m, Instance&, double x) { return checked(m, "exp", x, std::exp(x)); }
double logarithm(Machine& m, Instance&, double x) { return checked(m, "log", x, std::log(x)); }
double absolute(Machine& m, Instance&, double x) { return checked(m, "abs", x, std::abs(x)); }
double least(Machine&, Instance&, double a, double b) { return b < a ? b : a; }
double most(Machine&, Instance&, double a, double b) { return b > a ? b : a; }
double rounded_down(Machine& m, Instance&, double x) { return checked(m, "floor", x, std::floor(x)); }
double rounded_up(Machine& m, Instance&, double x) { return checked(m, "ceil", x, std::ceil(x)); }
/// To the nearest whole number; halves away from zero.
double rounded(Machine& m, Instance&, double x) { return checked(m, "round", x, std::round(x)); }
double raised(Machine& m, Instance&, double x, double y) {
  const double result = std::pow(x, y);
  if (!std::isfinite(result)) [[unlikely]]
    m.warn_once("pow", [&] { return fmt::format("pow({}, {}) is {}", shown(x), shown(y), shown(result)); });
  return result;
}
double arc_tangent_of_two(Machine&, Instance&, double y, double x) { return std::atan2(y, x); }
double arc_tangent_of_one(Machine& machine, Instance&, double x) {
  machine.warn_once("atan2", "atan2 with one argument is atan; for an angle in all four quadrants write atan2(y, x)");
  return std::atan(x);
}
std::int32_t is_nan(Machine&, Instance&, double x) { return std::isnan(x) ? 1 : 0; }
std::int32_t is_infinite(Machine&, Instance&, double x) { return std::isinf(x) ? 1 : 0; }

double dot_product(Machine&, Instance&, Vector3 a, Vector3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector3 cross_product(Machine&, Instance&, Vector3 a, Vector3 b) { return a.cross(b); }

/// 0 to pi; nan, with a warning, if a vector has no length. The cosine of nearly parallel vectors may exceed 1.
double angle_between(Machine& machine, Instance& self, Vector3 a, Vector3 b) {
  const double lengths = length(a) * length(b);
  if (lengths == 0) machine.warn_once("angle", "the angle to a vector of length zero is nan");
  if (lengths == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::acos(std::clamp(dot_product(machine, self, a, b) / lengths, -1.0, 1.0));
}

MatrixCell* transposed(Machine& machine, Instance&, Matrix3 m) { return machine.heap().matrix(m.transpose()); }

/// Counter-clockwise seen from the tip of the axis, which has unit length.
MatrixCell* rotation_matrix(Machine& machine, Instance&, Vector3 axis, double angle) {
  const Matrix3 m = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return machine.heap().matrix(m);
}

double number_in_list(const Value& v) {
  if (v.tag == Tag::Int) return v.i;
  if (v.tag == Tag::Double) return v.d;
  Machine::fail(RunErrorKind::Type, fmt::format("stddev needs a list of numbers, but an element is {}", a_type(v.tag)));
}

/// Sample deviation (n - 1); nan for fewer than two elements.
double standard_deviation(Machine& machine, Instance&, ListCell* list) {
  const std::uint32_t n = list != nullptr ? list->size : 0;
  machine.charge_for(2 * std::uint64_t{n});
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) sum += number_in_list((*list)[i]);
  if (n < 2) {
    machine.warn_once("stddev", "the standard deviation of fewer than two numbers is nan");
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double mean = sum / n;
  double squares = 0;
  for (const Value& v : *list) squares += (number_in_list(v) - mean) * (number_in_list(v) - mean);
  return std::sqrt(squares / (n - 1));
}

constexpr std::int32_t kMostDigits = 100;

/// A number with so many decimals, rounded.
StringCell* formatted(Machine& machine, Instance&, double x, std::int32_t digits) {
  if (digits < 0 || digits > kMostDigits)
    Machine::fail(RunErrorKind::Math, fmt::format("format takes 0 to {} decimals, not {}", kMostDigits, digits));
  return machine.heap().string(fmt::format("{:.{}f}", x, digits));
}

double random_gauss(Machine& machine, Instance&) { return machine.world().random().gauss(); }
double random_exponential(Machine& machine, Instance&) { return machine.world().random().exponential(); }
double random_gamma(Machine& machine, Instance&, std::int32_t order) {
  if (order < 1)
    Machine::fail(RunErrorKind::Math, fmt::format("randomGamma needs an order of at least 1, not {}", order));
  return machine.world().random().gamma(order);
}
void random_seed(Machine& machine, Instance&, std::int32_t seed) {
  machine.world().random().seed_with(static_cast<std::uint64_t>(static_cast<std::uint32_t>(seed)));
}
/// The one place where the outside enters a run; the seed that it drew is returned, so that the run can be repeated.
std::int32_t random_seed_from_device(Machine& machine, Instance& self) {
  if (!machine.host().may_draw_entropy)
    refuse_right("randomSeedFromDevRandom", "draw a seed from the operating system", "BREVE_RIGHT_ENTROPY");
  constexpr std::uint64_t kOfDevice = 4000;  // loop iterations: it is opened, read and closed
  machine.charge(kOfDevice);
  try {
    auto seed = static_cast<std::int32_t>(std::random_device{}() & 0x7fffffffU);
    if (machine.host().from_outside) machine.host().from_outside(&seed, sizeof seed);
    random_seed(machine, self, seed);
    return seed;
  } catch (const std::exception&) {
    return -1;
  }
}

Vector3 color_to_hsv(Machine&, Instance&, Vector3 rgb) { return rgb_to_hsv(rgb); }
Vector3 color_to_rgb(Machine& machine, Instance&, Vector3 hsv) {
  constexpr std::uint64_t kOfRemainder = 4;  // loop iterations: that of a hue of 1e308, bit by bit
  machine.charge(kOfRemainder);
  return hsv_to_rgb(hsv);
}
Vector3 color_number(Machine&, Instance&, std::int32_t n) { return unique_color(n); }

constexpr std::array kMathFunctions = {
    native<sine>("sin"),
    native<cosine>("cos"),
    native<tangent>("tan"),
    native<arc_sine>("asin"),
    native<arc_cosine>("acos"),
    native<arc_tangent>("atan"),
    native<square_root>("sqrt"),
    native<exponential>("exp"),
    native<logarithm>("log"),
    native<absolute>("abs"),
    native<least>("min"),
    native<most>("max"),
    native<rounded_down>("floor"),
    native<rounded_up>("ceil"),
    native<rounded>("round"),
    native<raised>("pow"),
    native<arc_tangent_of_two>("atan2"),
    native<arc_tangent_of_one>("atan2"),
    native<is_nan>("isnan"),
    native<is_infinite>("isinf"),
    native<dot_product>("dot"),
    native<cross_product>("cross"),
    native<angle_between>("angle"),
    native<transposed>("transpose"),
    native<rotation_matrix>("rotationMatrix"),
    native<standard_deviation>("stddev"),
    native<formatted>("format"),
    native<random_gauss>("randomGauss"),
    native<random_exponential>("randomExponential"),
    native<random_gamma>("randomGamma"),
    native<random_seed>("randomSeed"),
    native<random_seed_from_device>("randomSeedFromDevRandom", Reach::Entropy),
    native<color_to_hsv>("RGBtoHSV"),
    native<color_to_rgb>("HSVtoRGB"),
    native<color_number>("uniqueColor"),
};

}  // namespace

std::span<const Native> math_functions() { return kMathFunctions; }

}  // namespace breve::steve
