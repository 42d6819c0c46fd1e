// Reads the C headers of breve, which are written in one manner, into lists of what they declare.
#pragma once

#include <string>
#include <vector>

namespace breve::api {

struct Parameter {
  std::string name, type, doc;     // of a field: the comment behind it
  std::vector<Parameter> members;  // of a field whose type is "struct" or "union"
};

struct Value {
  std::string name, value, doc;
};

/// A function, or a type of functions that a host gives.
struct Callable {
  std::string name, result, doc, header;
  std::vector<Parameter> parameters;
  bool in_header = false;  // compiled into the host
};

struct Struct {
  std::string name, doc, header;
  bool grows = false;  // begins with struct_size
  std::vector<Parameter> fields;
};

struct Enumeration {
  std::string name, doc, header;
  std::vector<Value> values;
};

struct Interface {
  std::vector<Value> constants;
  std::vector<std::string> handles;  // types that only the library knows
  std::vector<Enumeration> enumerations;
  std::vector<Struct> structs;
  std::vector<Callable> callbacks, functions;
};

/// Adds what a header declares.
/// @throws  std::runtime_error naming the declaration that is written in another manner
void scan_header(const std::string& name, const std::string& text, Interface& to);

}  // namespace breve::api
