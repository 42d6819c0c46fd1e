// Conversion on assignment, and truth.
#include <fmt/format.h>

#include "steve/machine/brief.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

std::string help_for(const Value& v, std::string_view to) {
  if (v.tag == Tag::Null) return "a method returns a value with 'return'; a missing key of a hash gives no value";
  if (v.tag == Tag::Vector && (to == "an int" || to == "a double"))
    return "use its length, |v|, or one of its components: v::x, v::y, v::z";
  if (to == "a vector") return "a vector is written (x, y, z)";
  if (to == "a list" && v.tag == Tag::Hash) return "for a list of the keys of a hash write keys(hash)";
  if (to == "a list") return "a list is written { a, b, c }; a counting loop: for n = 0, n < 10, n++: ...";
  if (to == "an object" && v.tag == Tag::Int) return "the only number allowed here is 0, which means no object";
  if (to == "an object")
    return "the value of a call is what its method returns: to return the object itself, end the method with 'return "
           "self.'";
  return {};
}

[[noreturn]] void fail_conversion(const Value& v, std::string_view to, std::string_view what) {
  const std::string value = typed_brief(v);
  const std::string message = what.empty() ? fmt::format("{} is needed here, not {}", to, value)
                                           : fmt::format("{} must be {}, not {}", what, to, value);
  throw RunError(RunErrorKind::Conversion, message, help_for(v, to));
}

}  // namespace

std::string a_type(Tag tag) {
  if (tag == Tag::Null) return "no value (NULL)";
  const bool vowel = tag == Tag::Int || tag == Tag::Object;
  return std::string(tag == Tag::Data ? "" : vowel ? "an " : "a ").append(type_name(tag));
}

std::int32_t to_int(const Value& v, std::string_view what) {
  switch (v.tag) {
    case Tag::Int: return v.i;
    case Tag::Double: return truncate_to_int(v.d);
    case Tag::String: return leading_int(view(v.string()));
    case Tag::List: return v.list() != nullptr ? static_cast<std::int32_t>(v.list()->size) : 0;
    default: fail_conversion(v, "an int", what);
  }
}

double to_double(const Value& v, std::string_view what) {
  switch (v.tag) {
    case Tag::Int: return v.i;
    case Tag::Double: return v.d;
    case Tag::String: return leading_double(view(v.string()));
    case Tag::List: return v.list() != nullptr ? static_cast<double>(v.list()->size) : 0.0;
    default: fail_conversion(v, "a double", what);
  }
}

Vector3 to_vector(const Value& v, std::string_view what) {
  if (v.tag != Tag::Vector) fail_conversion(v, "a vector", what);
  return v.vector();
}

Matrix3 to_matrix(const Value& v, std::string_view what) {
  if (v.tag != Tag::Matrix) fail_conversion(v, "a matrix", what);
  return v.matrix() != nullptr ? v.matrix()->m : Matrix3::Zero();
}

StringCell* to_string(Heap& heap, const Value& v, std::string_view) {
  switch (v.tag) {
    case Tag::String: return v.string();
    case Tag::Int: return number_to_string(heap, v.i);
    case Tag::Double: return number_to_string(heap, v.d);
    default: return heap.string(text(v, {}, &heap));
  }
}

Instance* to_object(const Value& v, std::string_view what) {
  if (v.tag == Tag::Object) return v.object();
  if ((v.tag == Tag::Int && v.i == 0) || (v.tag == Tag::Double && v.d == 0)) return nullptr;
  fail_conversion(v, "an object", what);
}

ListCell* to_list(const Value& v, std::string_view what) {
  if (v.tag != Tag::List) fail_conversion(v, "a list", what);
  return v.list();
}

HashCell* to_hash(const Value& v, std::string_view what) {
  if (v.tag != Tag::Hash) fail_conversion(v, "a hash", what);
  return v.hash();
}

PointerCell* to_pointer(const Value& v, std::string_view what) {
  if (v.tag == Tag::Pointer) return v.pointer();
  if (v.tag == Tag::Int && v.i == 0) return nullptr;
  fail_conversion(v, "a pointer", what);
}

DataCell* to_data(const Value& v, std::string_view what) {
  if (v.tag != Tag::Data) fail_conversion(v, "data", what);
  return v.data();
}

bool truth(const Value& v) {
  switch (v.tag) {
    case Tag::Null: return false;
    case Tag::Int: return v.i != 0;
    case Tag::Double: return v.d != 0;
    case Tag::Vector: return v.v[0] != 0 || v.v[1] != 0 || v.v[2] != 0;
    case Tag::Matrix: {
      if (v.matrix() == nullptr) return false;
      const double* m = v.matrix()->m.data();
      for (int i = 0; i < 9; ++i)
        if (m[i] != 0) return true;
      return false;
    }
    case Tag::Object: return v.object() != nullptr && v.object()->live();
    case Tag::List: return v.list() != nullptr && v.list()->size != 0;
    case Tag::Hash: return true;
    case Tag::String:
    case Tag::Pointer:
    case Tag::Data: return v.ref != nullptr;
  }
  return false;
}

}  // namespace breve::steve
