// The instructions of the types INTEGER, FLOAT, BOOLEAN, VECTOR and NAME.
//
// Integers wrap at 32 bits, as those of scripts do. An instruction whose result would not be a finite number leaves the
// stacks as they are, like a division by zero.
#include <cmath>
#include <limits>

#include "runtime/learn/push/random_code.hpp"
#include "runtime/learn/push/stack_actions.hpp"

namespace breve::push {

namespace {

// --- two of a type give a third --------------------------------------------------------------------------------------

/// `f` of second and top, if it has a result.
template <class From, class To, auto F>
void combine(Interpreter& m) {
  auto& stack = From::of(m);
  if (stack.size() < 2) return;
  const auto result = F(stack[stack.size() - 2], stack[stack.size() - 1]);
  if (!result) return;
  stack.pop_back();
  stack.pop_back();
  m.push(To::of(m), *result);
}

/// `f` of the top, if it has a result.
template <class From, class To, auto F>
void convert(Interpreter& m) {
  auto& stack = From::of(m);
  if (stack.empty()) return;
  const auto result = F(stack.back());
  if (!result) return;
  stack.pop_back();
  m.push(To::of(m), *result);
}

using Int = std::optional<std::int32_t>;
using Real = std::optional<double>;
using Truth = std::optional<std::uint8_t>;
using Arrow = std::optional<Vector3>;

Real finite_only(double value) { return std::isfinite(value) ? Real(value) : std::nullopt; }
Arrow finite_only(const Vector3& value) { return value.allFinite() ? Arrow(value) : std::nullopt; }
Int wrapped(std::int64_t value) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(value)); }
Truth truth(bool value) { return static_cast<std::uint8_t>(value); }

// --- INTEGER ---------------------------------------------------------------------------------------------------------

Int add_integers(std::int32_t a, std::int32_t b) { return wrapped(std::int64_t{a} + b); }
Int subtract_integers(std::int32_t a, std::int32_t b) { return wrapped(std::int64_t{a} - b); }
Int multiply_integers(std::int32_t a, std::int32_t b) { return wrapped(std::int64_t{a} * b); }
Int divide_integers(std::int32_t a, std::int32_t b) { return b == 0 ? std::nullopt : wrapped(std::int64_t{a} / b); }
/// The remainder of the quotient rounded down: the sign is that of b.
Int modulo_integers(std::int32_t a, std::int32_t b) {
  if (b == 0) return {};
  const std::int64_t rest = std::int64_t{a} % b;
  return wrapped(rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest);
}
Int least_integer(std::int32_t a, std::int32_t b) { return std::min(a, b); }
Int greatest_integer(std::int32_t a, std::int32_t b) { return std::max(a, b); }
Truth integer_less(std::int32_t a, std::int32_t b) { return truth(a < b); }
Truth integer_greater(std::int32_t a, std::int32_t b) { return truth(a > b); }
Int integer_of_boolean(std::uint8_t x) { return x != 0 ? 1 : 0; }
/// Towards zero; what is beyond the integers is the nearest of them.
Int integer_of_float(double x) {
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min(), kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::clamp(x, kLeast, kMost));
}
void random_integer(Interpreter& m) { m.push(m.integers, random_integer_of(m.settings, m.random())); }

constexpr Instruction kIntegerInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("INTEGER", Integers),
    {"INTEGER.DEFINE", define<Integers>},
    {"INTEGER.%", combine<Integers, Integers, modulo_integers>},
    {"INTEGER.*", combine<Integers, Integers, multiply_integers>},
    {"INTEGER.+", combine<Integers, Integers, add_integers>},
    {"INTEGER.-", combine<Integers, Integers, subtract_integers>},
    {"INTEGER./", combine<Integers, Integers, divide_integers>},
    {"INTEGER.<", combine<Integers, Booleans, integer_less>},
    {"INTEGER.>", combine<Integers, Booleans, integer_greater>},
    {"INTEGER.MAX", combine<Integers, Integers, greatest_integer>},
    {"INTEGER.MIN", combine<Integers, Integers, least_integer>},
    {"INTEGER.FROMBOOLEAN", convert<Booleans, Integers, integer_of_boolean>},
    {"INTEGER.FROMFLOAT", convert<Floats, Integers, integer_of_float>},
    {"INTEGER.RAND", random_integer},
};

// --- FLOAT -----------------------------------------------------------------------------------------------------------

Real add_floats(double a, double b) { return finite_only(a + b); }
Real subtract_floats(double a, double b) { return finite_only(a - b); }
Real multiply_floats(double a, double b) { return finite_only(a * b); }
Real divide_floats(double a, double b) { return finite_only(a / b); }
Real modulo_floats(double a, double b) {
  const double rest = std::fmod(a, b);
  return finite_only(rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest);
}
Real least_float(double a, double b) { return std::min(a, b); }
Real greatest_float(double a, double b) { return std::max(a, b); }
Truth float_less(double a, double b) { return truth(a < b); }
Truth float_greater(double a, double b) { return truth(a > b); }
Real sine(double x) { return std::sin(x); }
Real cosine(double x) { return std::cos(x); }
Real tangent(double x) { return finite_only(std::tan(x)); }
Real float_of_boolean(std::uint8_t x) { return x != 0 ? 1.0 : 0.0; }
Real float_of_integer(std::int32_t x) { return x; }
void random_float(Interpreter& m) { m.push_float(random_float_of(m.settings, m.random())); }

constexpr Instruction kFloatInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("FLOAT", Floats),
    {"FLOAT.DEFINE", define<Floats>},
    {"FLOAT.%", combine<Floats, Floats, modulo_floats>},
    {"FLOAT.*", combine<Floats, Floats, multiply_floats>},
    {"FLOAT.+", combine<Floats, Floats, add_floats>},
    {"FLOAT.-", combine<Floats, Floats, subtract_floats>},
    {"FLOAT./", combine<Floats, Floats, divide_floats>},
    {"FLOAT.<", combine<Floats, Booleans, float_less>},
    {"FLOAT.>", combine<Floats, Booleans, float_greater>},
    {"FLOAT.MAX", combine<Floats, Floats, greatest_float>},
    {"FLOAT.MIN", combine<Floats, Floats, least_float>},
    {"FLOAT.SIN", convert<Floats, Floats, sine>},
    {"FLOAT.COS", convert<Floats, Floats, cosine>},
    {"FLOAT.TAN", convert<Floats, Floats, tangent>},
    {"FLOAT.FROMBOOLEAN", convert<Booleans, Floats, float_of_boolean>},
    {"FLOAT.FROMINTEGER", convert<Integers, Floats, float_of_integer>},
    {"FLOAT.RAND", random_float},
};

// --- BOOLEAN ---------------------------------------------------------------------------------------------------------

Truth both(std::uint8_t a, std::uint8_t b) { return truth(a != 0 && b != 0); }
Truth either(std::uint8_t a, std::uint8_t b) { return truth(a != 0 || b != 0); }
Truth opposite(std::uint8_t x) { return truth(x == 0); }
Truth boolean_of_float(double x) { return truth(x != 0); }
Truth boolean_of_integer(std::int32_t x) { return truth(x != 0); }
void random_boolean(Interpreter& m) { m.push(m.booleans, static_cast<std::uint8_t>(m.random().below(2))); }

constexpr Instruction kBooleanInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("BOOLEAN", Booleans),
    {"BOOLEAN.DEFINE", define<Booleans>},
    {"BOOLEAN.AND", combine<Booleans, Booleans, both>},
    {"BOOLEAN.OR", combine<Booleans, Booleans, either>},
    {"BOOLEAN.NOT", convert<Booleans, Booleans, opposite>},
    {"BOOLEAN.FROMFLOAT", convert<Floats, Booleans, boolean_of_float>},
    {"BOOLEAN.FROMINTEGER", convert<Integers, Booleans, boolean_of_integer>},
    {"BOOLEAN.RAND", random_boolean},
};

// --- VECTOR ----------------------------------------------------------------------------------------------------------

Arrow add_vectors(const Vector3& a, const Vector3& b) { return finite_only(Vector3(a + b)); }
Arrow subtract_vectors(const Vector3& a, const Vector3& b) { return finite_only(Vector3(a - b)); }
Arrow cross_product(const Vector3& a, const Vector3& b) { return finite_only(Vector3(a.cross(b))); }
Real dot_product(const Vector3& a, const Vector3& b) { return finite_only(a.dot(b)); }
Real vector_length(const Vector3& v) { return finite_only(v.norm()); }
Arrow unit_vector(const Vector3& v) {
  const double length = v.norm();
  return length > 0 ? finite_only(Vector3(v / length)) : std::nullopt;
}
template <int kAxis>
Real component(const Vector3& v) {
  return v[kAxis];
}

/// The top vector times, or over, the top float.
template <bool kDivides>
void scale_vector(Interpreter& m) {
  if (m.vectors.empty() || m.floats.empty()) return;
  const double factor = m.floats.back();
  const Arrow result = finite_only(kDivides ? Vector3(m.vectors.back() / factor) : Vector3(m.vectors.back() * factor));
  if (!result) return;
  m.floats.pop_back();
  m.vectors.back() = *result;
}

void vector_of_floats(Interpreter& m) {
  if (m.floats.size() < 3) return;
  const double z = take(m.floats), y = take(m.floats), x = take(m.floats);
  m.push(m.vectors, Vector3(x, y, z));
}

void random_vector(Interpreter& m) { m.push(m.vectors, random_vector_of(m.settings, m.random())); }

constexpr Instruction kVectorInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("VECTOR", Vectors),
    {"VECTOR.DEFINE", define<Vectors>},
    {"VECTOR.*", scale_vector<false>},
    {"VECTOR./", scale_vector<true>},
    {"VECTOR.+", combine<Vectors, Vectors, add_vectors>},
    {"VECTOR.-", combine<Vectors, Vectors, subtract_vectors>},
    {"VECTOR.CROSS", combine<Vectors, Vectors, cross_product>},
    {"VECTOR.DOT", combine<Vectors, Floats, dot_product>},
    {"VECTOR.LENGTH", convert<Vectors, Floats, vector_length>},
    {"VECTOR.NORMALIZE", convert<Vectors, Vectors, unit_vector>},
    {"VECTOR.X", convert<Vectors, Floats, component<0>>},
    {"VECTOR.Y", convert<Vectors, Floats, component<1>>},
    {"VECTOR.Z", convert<Vectors, Floats, component<2>>},
    {"VECTOR.FROMFLOATS", vector_of_floats},
    {"VECTOR.RAND", random_vector},
};

// --- NAME ------------------------------------------------------------------------------------------------------------

void quote_name(Interpreter& m) { m.quote_next_name(); }
void random_name(Interpreter& m) { m.push(m.names, new_name(m.random(), m.memory())); }
void random_bound_name(Interpreter& m) {
  if (std::optional<Code> bound = m.random_bound_name(m.random())) m.push(m.names, std::move(*bound));
}

constexpr Instruction kNameInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("NAME", Names),
    {"NAME.QUOTE", quote_name},
    {"NAME.RAND", random_name},
    {"NAME.RANDBOUNDNAME", random_bound_name},
};

}  // namespace

std::span<const Instruction> integer_instructions() { return kIntegerInstructions; }
std::span<const Instruction> float_instructions() { return kFloatInstructions; }
std::span<const Instruction> boolean_instructions() { return kBooleanInstructions; }
std::span<const Instruction> vector_instructions() { return kVectorInstructions; }
std::span<const Instruction> name_instructions() { return kNameInstructions; }

}  // namespace breve::push
