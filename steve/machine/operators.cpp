// Operators on values whose types are known only when they run.
#include "steve/machine/operators.hpp"

#include "steve/machine/brief.hpp"

#include <array>
#include <memory_resource>
#include <unordered_set>

#include <fmt/format.h>
#include <Eigen/LU>

#include "runtime/base/hasher.hpp"

namespace breve::steve {

namespace {

using ast::BinaryOp;

bool is_equality(BinaryOp op) { return op == BinaryOp::Eq || op == BinaryOp::Ne; }
Value boolean(bool b) { return Value::of(std::int32_t{b ? 1 : 0}); }
Value boolean(BinaryOp op, bool same) { return boolean(same == (op == BinaryOp::Eq)); }

[[noreturn]] void fail_math(const std::string& message) { throw RunError(RunErrorKind::Math, message); }

/// "cannot multiply a vector by a vector; use dot(a, b) or cross(a, b)"
[[noreturn]] void fail_operands(BinaryOp op, const Value& a, const Value& b, std::string_view hint = {}) {
  const std::string x = typed_brief(a), y = typed_brief(b);
  std::string message;
  switch (op) {
    case BinaryOp::Add: message = fmt::format("cannot add {} and {}", x, y); break;
    case BinaryOp::Sub: message = fmt::format("cannot subtract {} from {}", y, x); break;
    case BinaryOp::Mul: message = fmt::format("cannot multiply {} by {}", x, y); break;
    case BinaryOp::Div: message = fmt::format("cannot divide {} by {}", x, y); break;
    case BinaryOp::Mod: message = fmt::format("cannot take the remainder of {} by {}", x, y); break;
    case BinaryOp::Pow: message = fmt::format("cannot raise {} to the power of {}", x, y); break;
    default: message = fmt::format("cannot compare {} with {}", x, y); break;
  }
  const bool number_missing = a.tag == Tag::Null || b.tag == Tag::Null;
  const bool object = a.tag == Tag::Object || b.tag == Tag::Object;
  const bool lone_vector =
      (a.tag == Tag::Vector) != (b.tag == Tag::Vector) && (op == BinaryOp::Add || op == BinaryOp::Sub);
  if (hint.empty() && object)
    hint = "use a variable of the object, object::name, or the result of a method, (object method)";
  if (hint.empty() && lone_vector && !number_missing)
    hint = "the other operand must also be a vector, (x, y, z); the length of a vector is |v|";
  const std::string help = number_missing && hint.empty()
                               ? "a method returns a value with 'return'; a missing key of a hash gives no value"
                               : std::string(hint);
  throw RunError(number_missing ? RunErrorKind::Conversion : RunErrorKind::Type, message, help);
}

// --- numbers ---------------------------------------------------------------------------------------------------------

Value int_binary(BinaryOp op, std::int32_t a, std::int32_t b) {
  switch (op) {
    case BinaryOp::Add: return Value::of(wrap_add(a, b));
    case BinaryOp::Sub: return Value::of(wrap_sub(a, b));
    case BinaryOp::Mul: return Value::of(wrap_mul(a, b));
    case BinaryOp::Div: return Value::of(divide(a, b));
    case BinaryOp::Mod: return Value::of(remainder(a, b));
    case BinaryOp::Pow: return Value::of(power(a, b));
    case BinaryOp::Lt: return boolean(a < b);
    case BinaryOp::Le: return boolean(a <= b);
    case BinaryOp::Gt: return boolean(a > b);
    case BinaryOp::Ge: return boolean(a >= b);
    case BinaryOp::Eq: return boolean(a == b);
    default: return boolean(a != b);
  }
}

Value double_binary(BinaryOp op, double a, double b) {
  switch (op) {
    case BinaryOp::Add: return Value::of(a + b);
    case BinaryOp::Sub: return Value::of(a - b);
    case BinaryOp::Mul: return Value::of(a * b);
    case BinaryOp::Div: return Value::of(divide(a, b));
    case BinaryOp::Mod: return Value::of(remainder(a, b));
    case BinaryOp::Pow: return Value::of(std::pow(a, b));
    case BinaryOp::Lt: return boolean(a < b);
    case BinaryOp::Le: return boolean(a <= b);
    case BinaryOp::Gt: return boolean(a > b);
    case BinaryOp::Ge: return boolean(a >= b);
    case BinaryOp::Eq: return boolean(a == b);
    default: return boolean(a != b);
  }
}

bool is_scalar(Tag tag) { return tag == Tag::Int || tag == Tag::Double || tag == Tag::String || tag == Tag::List; }

/// Rule 6: what strings and lists count as in arithmetic.
Value as_number(const Value& v) {
  if (v.tag == Tag::String) return Value::of(to_double(v));
  if (v.tag == Tag::List) return Value::of(to_int(v));
  return v;
}

// --- vectors and matrices --------------------------------------------------------------------------------------------

Value vector_binary(BinaryOp op, const Value& a, const Value& b) {
  if (a.tag == Tag::Vector && b.tag == Tag::Vector) {
    switch (op) {
      case BinaryOp::Add: return Value::of(Vector3(a.vector() + b.vector()));
      case BinaryOp::Sub: return Value::of(Vector3(a.vector() - b.vector()));
      case BinaryOp::Eq:
      case BinaryOp::Ne: return boolean(op, a.vector() == b.vector());
      case BinaryOp::Mul: fail_operands(op, a, b, "use dot(a, b) or cross(a, b)");
      case BinaryOp::Lt:
      case BinaryOp::Le:
      case BinaryOp::Gt:
      case BinaryOp::Ge: fail_operands(op, a, b, "compare their lengths, |a| and |b|");
      default: fail_operands(op, a, b);
    }
  }
  const Value& v = a.tag == Tag::Vector ? a : b;
  const Value& other = a.tag == Tag::Vector ? b : a;
  if (!is_scalar(other.tag)) fail_operands(op, a, b);
  if (op == BinaryOp::Mul) return Value::of(Vector3(v.vector() * to_double(other)));
  if (op != BinaryOp::Div) fail_operands(op, a, b);
  const double s = to_double(other);  // s / v means v / s
  if (s == 0) fail_division_by_zero();
  return Value::of(Vector3(v.vector() / s));
}

Value make_matrix(Heap& heap, const Matrix3& m) { return Value::of(Tag::Matrix, heap.matrix(m)); }

Value matrix_matrix(Heap& heap, BinaryOp op, const Value& a, const Value& b) {
  const Matrix3 m = to_matrix(a), n = to_matrix(b);
  switch (op) {
    case BinaryOp::Add: return make_matrix(heap, m + n);
    case BinaryOp::Sub: return make_matrix(heap, m - n);
    case BinaryOp::Mul: return make_matrix(heap, m * n);
    case BinaryOp::Div: return make_matrix(heap, m * inverse(n));
    case BinaryOp::Eq:
    case BinaryOp::Ne: return boolean(op, m == n);
    default: fail_operands(op, a, b);
  }
}

Value matrix_binary(Heap& heap, BinaryOp op, const Value& a, const Value& b) {
  if (a.tag == Tag::Matrix && b.tag == Tag::Matrix) return matrix_matrix(heap, op, a, b);
  const bool left = a.tag == Tag::Matrix;
  const Matrix3 m = to_matrix(left ? a : b);
  const Value& other = left ? b : a;
  if (other.tag == Tag::Vector) {
    if (op != BinaryOp::Mul) fail_operands(op, a, b);
    return Value::of(Vector3(left ? Vector3(m * other.vector()) : Vector3(m.transpose() * other.vector())));
  }
  if (!is_scalar(other.tag)) fail_operands(op, a, b);
  const double s = to_double(other);
  if (op == BinaryOp::Mul) return make_matrix(heap, m * s);
  if (op != BinaryOp::Div) fail_operands(op, a, b);
  if (!left) return make_matrix(heap, s * inverse(m));
  if (s == 0) fail_division_by_zero();
  return make_matrix(heap, m / s);
}

// --- everything else -------------------------------------------------------------------------------------------------

/// Equality of objects and NULL: identity of references, comparison with zero or NULL, and NULL as the int 0.
Value reference_binary(BinaryOp op, const Value& a, const Value& b) {
  const auto is_zero = [](const Value& v) {
    return v.tag == Tag::Null || (v.tag == Tag::Int && v.i == 0) || (v.tag == Tag::Double && v.d == 0);
  };
  if (!is_equality(op)) fail_operands(op, a, b);
  if (a.is_reference() && b.is_reference()) return boolean(op, a.ref == b.ref);
  const Value& reference = a.is_reference() ? a : b;
  const Value& other = a.is_reference() ? b : a;
  if (!is_zero(other)) fail_operands(op, a, b);
  return boolean(op, reference.ref == nullptr);
}

Value number_binary(BinaryOp op, const Value& x, const Value& y) {
  const bool a_string = x.tag == Tag::String, b_string = y.tag == Tag::String;
  const bool reference = (x.tag >= Tag::Object && x.tag != Tag::List) || (y.tag >= Tag::Object && y.tag != Tag::List);
  if (reference) {
    // An object is never equal to a string.
    if ((a_string || b_string) && is_equality(op)) return boolean(op, false);
    if (a_string || b_string) fail_operands(op, x, y);
    const Value a = as_number(x), b = as_number(y);
    return reference_binary(op, a, b);
  }
  Value a = as_number(x), b = as_number(y);
  if (a.tag == Tag::Double || b.tag == Tag::Double) {
    if (a.tag == Tag::Null || b.tag == Tag::Null) fail_operands(op, x, y);
    return double_binary(op, to_double(a), to_double(b));
  }
  return int_binary(op, a.tag == Tag::Null ? 0 : a.i, b.tag == Tag::Null ? 0 : b.i);
}

// --- equality of lists -----------------------------------------------------------------------------------------------

struct ListPair {
  const ListCell* a;
  const ListCell* b;
  friend bool operator==(const ListPair&, const ListPair&) = default;
};
struct ListPairHash {
  std::size_t operator()(const ListPair& p) const {
    Hasher hasher;
    hasher.add(p.a->serial);
    hasher.add(p.b->serial);
    return static_cast<std::size_t>(hasher.value());
  }
};

/// Equality of two values that are not both lists; false where `==` would be an error.
bool equal_flat(const Value& a, const Value& b) {
  if (a.tag == Tag::Int && b.tag == Tag::Int) return a.i == b.i;
  if (a.tag == Tag::Matrix || b.tag == Tag::Matrix) return a.tag == b.tag && to_matrix(a) == to_matrix(b);
  if (a.tag == Tag::Vector || b.tag == Tag::Vector) return a.tag == b.tag && a.vector() == b.vector();
  if (a.tag == Tag::String && b.tag == Tag::String) return view(a.string()) == view(b.string());
  try {
    return number_binary(BinaryOp::Eq, a, b).i != 0;
  } catch (const RunError&) {
    return false;
  }
}

}  // namespace

void fail_type(const std::string& message) { throw RunError(RunErrorKind::Type, message); }

// One difference anywhere makes the whole unequal, so a pair of lists that is being or has been compared can count as
// equal: cycles end, and shared lists are compared once.
bool equal(const Value& a, const Value& b) {
  if (a.tag != Tag::List || b.tag != Tag::List) return equal_flat(a, b);
  static constexpr auto kSize = [](const ListCell* list) { return list != nullptr ? list->size : 0U; };
  std::unordered_set<ListPair, ListPairHash> seen;
  std::vector<ListPair> pending;
  const auto meet = [&](const ListCell* x, const ListCell* y, bool nested) {
    if (kSize(x) != kSize(y)) return false;
    if (kSize(x) == 0) return true;
    if (!nested || seen.insert({x, y}).second) pending.push_back({x, y});
    return true;
  };
  if (!meet(a.list(), b.list(), false)) return false;
  while (!pending.empty()) {
    const ListPair pair = pending.back();
    pending.pop_back();
    for (std::uint32_t i = 0; i < pair.a->size; ++i) {
      const Value& x = (*pair.a)[i];
      const Value& y = (*pair.b)[i];
      const bool lists = x.tag == Tag::List && y.tag == Tag::List;
      if (!(lists ? meet(x.list(), y.list(), true) : equal_flat(x, y))) return false;
    }
  }
  return true;
}

Value binary(Heap& heap, BinaryOp op, const Value& a, const Value& b) {
  if (a.tag == Tag::Int && b.tag == Tag::Int) return int_binary(op, a.i, b.i);
  if (a.tag == Tag::Double && b.tag == Tag::Double) return double_binary(op, a.d, b.d);
  if (a.tag == Tag::Matrix || b.tag == Tag::Matrix) return matrix_binary(heap, op, a, b);
  if (a.tag == Tag::Vector || b.tag == Tag::Vector) return vector_binary(op, a, b);
  if (a.tag == Tag::String && b.tag == Tag::String) {
    if (op == BinaryOp::Add) return Value::of(Tag::String, heap.append(a.string(), view(b.string())));
    if (is_equality(op)) return boolean(op, view(a.string()) == view(b.string()));
  }
  if (a.tag == Tag::List && b.tag == Tag::List && is_equality(op)) return boolean(op, equal(a, b));
  return number_binary(op, a, b);
}

void fail_division_by_zero() {
  throw RunError(RunErrorKind::Math, "division by zero", "test the divisor with 'if' first");
}

std::int32_t divide(std::int32_t a, std::int32_t b) {
  if (b == 0) fail_division_by_zero();
  if (b == -1 && a == std::numeric_limits<std::int32_t>::min()) fail_math("-2147483648 / -1 is too large for an int");
  return a / b;
}

std::int32_t remainder(std::int32_t a, std::int32_t b) {
  if (b == 0) fail_division_by_zero();
  return b == -1 ? 0 : a % b;
}

double divide(double a, double b) {
  if (b == 0) fail_division_by_zero();
  return a / b;
}

double remainder(double a, double b) {
  if (b == 0) fail_division_by_zero();
  return std::fmod(a, b);
}

Matrix3 inverse(const Matrix3& m) {
  constexpr double kSingular = 1e-21;
  const double determinant = m.determinant();
  if (std::abs(determinant) < kSingular)
    fail_math(fmt::format("cannot invert a singular matrix (its determinant is {})", determinant));
  return m.inverse();
}

Value negate(const Value& v) {
  switch (v.tag) {
    case Tag::Int: return Value::of(wrap_negate(v.i));
    case Tag::Double: return Value::of(-v.d);
    case Tag::Vector: return Value::of(Vector3(-v.vector()));
    case Tag::String: return Value::of(-to_double(v));
    default: fail_type(fmt::format("cannot negate {}", a_type(v.tag)));
  }
}

Value magnitude(const Value& v) {
  switch (v.tag) {
    case Tag::Int: return Value::of(v.i < 0 ? wrap_negate(v.i) : v.i);
    case Tag::Double: return Value::of(std::abs(v.d));
    case Tag::Vector: return Value::of(length(v.vector()));
    case Tag::List: return Value::of(to_int(v));
    case Tag::String: return Value::of(static_cast<std::int32_t>(view(v.string()).size()));
    case Tag::Hash: fail_type("a hash has no magnitude; for the number of its keys write |keys(h)|");
    default: fail_type(fmt::format("{} has no magnitude", a_type(v.tag)));
  }
}

// --- keys ------------------------------------------------------------------------------------------------------------

bool same_key(const Value& a, const Value& b) {
  if (a.tag != b.tag) return false;
  switch (a.tag) {
    case Tag::Null: return true;
    case Tag::Int: return a.i == b.i;
    case Tag::Double: return a.d == b.d || std::bit_cast<std::uint64_t>(a.d) == std::bit_cast<std::uint64_t>(b.d);
    case Tag::Vector:
      for (int i = 0; i < 3; ++i)
        if (!same_key(Value::of(a.v[i]), Value::of(b.v[i]))) return false;
      return true;
    case Tag::Matrix: {
      const Matrix3 m = to_matrix(a), n = to_matrix(b);
      for (int i = 0; i < 9; ++i)
        if (!same_key(Value::of(m.data()[i]), Value::of(n.data()[i]))) return false;
      return true;
    }
    case Tag::String: return a.ref == b.ref || view(a.string()) == view(b.string());
    default: return a.ref == b.ref;
  }
}

std::uint32_t key_hash(const Value& v) {
  if (v.tag == Tag::Int) {  // Fibonacci hashing (Knuth, volume 3, 6.4): the middle bits of the product are well spread
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
    const auto folded = static_cast<std::uint32_t>(static_cast<std::uint32_t>(v.i) * kGolden >> 32);
    return folded == HashCell::kRemoved ? 1 : folded;
  }
  if (v.tag == Tag::String) {
    const StringCell* string = v.string();
    if (string == nullptr) return 2;
    if (string->hash_cache == 0) string->hash_cache = string_hash(string->view());
    return string->hash_cache;
  }
  Hasher hasher;
  const auto add = [&hasher](double d) { hasher.add(d == 0 ? 0.0 : d); };  // -0.0 == 0.0
  hasher.add(static_cast<std::uint64_t>(v.tag));
  switch (v.tag) {
    case Tag::Double: add(v.d); break;
    case Tag::Vector:
      for (const double d : v.v) add(d);
      break;
    case Tag::Matrix: {
      const Matrix3 m = to_matrix(v);
      for (int i = 0; i < 9; ++i) add(m.data()[i]);
      break;
    }
    case Tag::Object: hasher.add(v.ref != nullptr ? v.object()->serial : 0); break;
    case Tag::List: hasher.add(v.ref != nullptr ? v.list()->serial : 0); break;
    case Tag::Hash: hasher.add(v.ref != nullptr ? v.hash()->serial : 0); break;
    case Tag::Pointer: hasher.add(v.ref != nullptr ? v.pointer()->serial : 0); break;
    case Tag::Data: hasher.add(v.ref != nullptr ? v.data()->serial : 0); break;
    default: break;
  }
  const auto folded = static_cast<std::uint32_t>(hasher.value() >> 32);
  return folded == HashCell::kRemoved ? 1 : folded;
}

}  // namespace breve::steve
