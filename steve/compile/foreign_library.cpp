// A class of another implementation's library in a file that the program loads: it calls functions of that
// implementation. That is one mistake, however many they are.
#include <algorithm>
#include <map>
#include <set>

#include "steve/code/wording.hpp"
#include "steve/compile/builder.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kMostFunctions = 3;  // that are named

struct ForeignFile {
  const ClassInfo* cls = nullptr;  // the class of the library that the file is named after
  std::vector<std::string> functions;
  Span span;
};

/// 'name' in "unknown function 'name'"
std::string quoted_in(const std::string& message) {
  const std::size_t begin = message.find('\'') + 1;
  return message.substr(begin, message.rfind('\'') - begin);
}

/// "Sound" of "parts/Sound.tz"
std::string_view file_stem(std::string_view file) {
  file.remove_prefix(file.find_last_of('/') + 1);
  return file.substr(0, file.find_last_of('.'));
}

}  // namespace

void ProgramBuilder::gather_foreign_library() {
  std::map<std::uint32_t, ForeignFile> files;
  for (const auto& [tree, info] : declared_) {
    const std::uint32_t file = info->span.file;
    if (file == 0 || embedded(info->span) || info->name != file_stem(program_->sources_.file(file).name)) continue;
    if (library_.find_file(info->name)) files[file].cls = info;
  }
  for (const Diagnostic& d : diagnostics_.all()) {
    const auto file = d.code == "unknown-function" ? files.find(d.span.file) : files.end();
    if (file == files.end()) continue;
    ForeignFile& foreign = file->second;
    const std::string name = "'" + quoted_in(d.message) + "'";
    if (foreign.functions.empty()) foreign.span = d.span;
    if (std::find(foreign.functions.begin(), foreign.functions.end(), name) == foreign.functions.end())
      foreign.functions.push_back(name);
  }
  std::erase_if(files, [](const auto& file) { return file.second.functions.empty(); });
  if (files.empty()) return;
  Diagnostics kept;
  for (const Diagnostic& d : diagnostics_.all())
    if (!files.contains(d.span.file)) kept.add(d);
  for (auto& [number, foreign] : files) {
    std::vector<std::string> named = foreign.functions;
    if (named.size() > kMostFunctions) {
      named.resize(kMostFunctions);
      named.push_back(std::to_string(foreign.functions.size() - kMostFunctions) + " more");
    }
    const std::string& name = foreign.cls->name;
    kept.error(foreign.span, "foreign-library",
               "this file has the class " + name + " of another version of the class library: it calls " +
                   joined(named) + ", which breve does not have",
               "remove the file: breve has a class " + name + " of its own");
  }
  diagnostics_ = std::move(kept);
}

}  // namespace breve::steve
