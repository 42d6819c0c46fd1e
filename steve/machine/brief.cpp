// Values in a few words, for messages.
#include "steve/machine/brief.hpp"

#include <fmt/format.h>

#include "steve/code/program.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kLongestText = 40;  // bytes of a string that are shown

std::string brief_number(double d) { return fmt::format("{:.6g}", d); }

std::string brief_pointer(const Value& v) { return v.ref == nullptr ? "null" : "a pointer"; }

std::string list_of(const ListCell* list) {
  const std::uint32_t size = list != nullptr ? list->size : 0;
  return size == 0 ? "an empty list" : fmt::format("a list of {}", size);
}

std::string hash_of(const HashCell* hash) {
  const std::uint32_t size = hash != nullptr ? hash->count_live : 0;
  return size == 0 ? "an empty hash" : fmt::format("a hash of {} key{}", size, size == 1 ? "" : "s");
}

}  // namespace

std::string brief_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : cut(text, kLongestText)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\x{:02X}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string brief(const Instance* object) {
  if (object == nullptr) return "null";
  return fmt::format("{}{} {:#x}", object->live() ? "" : "freed ", object->cls->name, object->serial);
}

std::string brief(const Vector3& v) {
  return fmt::format("({}, {}, {})", brief_number(v[0]), brief_number(v[1]), brief_number(v[2]));
}

std::string brief(const Value& v) {
  switch (v.tag) {
    case Tag::Null: return "NULL";
    case Tag::Int: return fmt::format("{}", v.i);
    case Tag::Double: return brief_number(v.d);
    case Tag::Vector: return brief(v.vector());
    case Tag::Matrix: return "a matrix";
    case Tag::String: return brief_text(view(v.string()));
    case Tag::Object: return brief(v.object());
    case Tag::List: return list_of(v.list());
    case Tag::Hash: return hash_of(v.hash());
    case Tag::Pointer: return brief_pointer(v);
    case Tag::Data: return fmt::format("data of {} bytes", v.data() != nullptr ? v.data()->bytes.size() : 0);
  }
  return {};
}

std::string typed_brief(const Value& v) {
  switch (v.tag) {
    case Tag::Null: return "no value (NULL)";
    case Tag::Int:
    case Tag::Double:
    case Tag::Vector:
    case Tag::String: return fmt::format("the {} {}", type_name(v.tag), brief(v));
    case Tag::Object:
      if (v.object() == nullptr) return "a null object";
      return fmt::format("the {}object {} {:#x}", v.object()->live() ? "" : "freed ", v.object()->cls->name,
                         v.object()->serial);
    case Tag::Pointer: return v.ref == nullptr ? "a null pointer" : "a pointer";
    default: return brief(v);
  }
}

}  // namespace breve::steve
