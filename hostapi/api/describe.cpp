// breve.json from the headers, for those who write bindings to other languages:
//   breve_describe HEADER... breve.json
//   breve_describe --check HEADER... check.c
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "check.hpp"
#include "scanner.hpp"

namespace {

using Json = nlohmann::ordered_json;
using namespace breve::api;

Json json_of(const std::vector<Parameter>& all, bool docs) {
  Json list = Json::array();
  for (const Parameter& one : all) {
    Json item{{"name", one.name}, {"type", one.type}};
    if (!one.members.empty()) item["members"] = json_of(one.members, docs);
    if (docs) item["doc"] = one.doc;
    list.push_back(item);
  }
  return list;
}

Json json_of(const std::vector<Value>& all) {
  Json list = Json::array();
  for (const Value& one : all) list.push_back({{"name", one.name}, {"value", one.value}, {"doc", one.doc}});
  return list;
}

Json json_of(const std::vector<Callable>& all) {
  Json list = Json::array();
  for (const Callable& one : all) {
    Json item{{"name", one.name}, {"header", one.header}, {"result", one.result}};
    item["parameters"] = json_of(one.parameters, false);
    if (one.in_header) item["inline"] = true;
    item["doc"] = one.doc;
    list.push_back(item);
  }
  return list;
}

Json json_of(const Interface& interface) {
  Json all;
  all["constants"] = json_of(interface.constants);
  all["handles"] = interface.handles;
  for (const Enumeration& one : interface.enumerations)
    all["enums"].push_back(
        {{"name", one.name}, {"header", one.header}, {"values", json_of(one.values)}, {"doc", one.doc}});
  for (const Struct& one : interface.structs)
    all["structs"].push_back({{"name", one.name},
                              {"header", one.header},
                              {"grows", one.grows},
                              {"fields", json_of(one.fields, true)},
                              {"doc", one.doc}});
  all["callbacks"] = json_of(interface.callbacks);
  all["functions"] = json_of(interface.functions);
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bool check = argc > 1 && std::string(argv[1]) == "--check";
    Interface interface;
    for (int i = check ? 2 : 1; i < argc - 1; ++i) {
      std::ifstream in(argv[i]);
      if (!in) throw std::runtime_error(std::string("cannot read ") + argv[i]);
      const std::string path(argv[i]);
      scan_header(path.substr(path.rfind('/') + 1), {std::istreambuf_iterator<char>(in), {}}, interface);
    }
    std::ofstream out(argc > 2 ? argv[argc - 1] : "");
    if (check)
      write_check(interface, out);
    else
      out << json_of(interface).dump(1) << "\n";
    if (!out.flush()) throw std::runtime_error("usage: breve_describe [--check] HEADER... OUTPUT");
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "breve_describe: " << e.what() << "\n";
    return 1;
  }
}
