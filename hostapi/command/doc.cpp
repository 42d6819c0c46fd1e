// Programs are looked at, not run; one page a class, and an index.
#include "doc.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "doc_pages.hpp"
#include "session.hpp"

namespace breve::command {

namespace fs = std::filesystem;

namespace {

struct AnalysisDeleter {
  void operator()(breve_analysis* analysis) const { breve_analysis_destroy(analysis); }
};
using AnalysisHandle = std::unique_ptr<breve_analysis, AnalysisDeleter>;

/// A program that uses all of the class library.
std::string library_program() {
  std::string text;
  for (std::size_t i = 0; i < breve_library_module_count(); ++i) {
    breve_source module;
    if (breve_library_module(i, &module) != BREVE_OK) continue;
    const std::string name(module.name);
    text += "@use " + name.substr(0, name.size() - 3) + ".\n";
  }
  return text;
}

class Documenter {
 public:
  Documenter(const DocOptions& options, Output& output) : options_(options), output_(output) {}

  int run() {
    if (options_.library) look_at("class library", library_program());
    for (const std::string& file : options_.files) {
      std::error_code ignored;
      if (!fs::is_regular_file(file, ignored)) {
        complain(fmt::format("there is no file '{}'", file), kWrongUsage);
        continue;
      }
      look_at(file, {});
    }
    if (status_ == kWrongUsage) return status_;
    if (options_.format != "html") write(MarkdownPages());
    if (options_.format != "markdown") write(HtmlPages());
    if (status_ != kFailed || written_ > 0)
      output_.print(fmt::format("{} {} written to {}\n", written_, written_ == 1 ? "page" : "pages", options_.out));
    return status_;
  }

 private:
  void complain(const std::string& what, int status) {
    output_.complain("breve: " + what + "\n");
    status_ = std::max(status_, status);
  }

  /// @param text  empty: the file's own
  void look_at(const std::string& name, const std::string& text) {
    // Each with a search path of its own, so that programs do not see one another's files.
    Session session(output_, options_.paths, true, false);
    breve_analysis* made = nullptr;
    const char* given = text.empty() ? nullptr : text.c_str();
    if (breve_analysis_create(session.runtime(), name.c_str(), given, text.size(), &made) != BREVE_OK)
      return complain(breve_runtime_last_error(session.runtime())->message, kWrongUsage);
    const AnalysisHandle analysis(made);
    for (std::size_t i = 0; i < breve_analysis_diagnostic_count(made); ++i) {
      breve_diagnostic d;
      const bool known = breve_analysis_diagnostic(made, i, &d) == BREVE_OK;
      // A part of a program is documented as well as a whole one.
      if (!known || d.severity != BREVE_SEVERITY_ERROR || std::string_view(d.code) == "missing-controller") continue;
      output_.complain(d.text);
      status_ = std::max<int>(status_, kFailed);
    }
    for (const std::string& cls : model_.add(made, text.size() > 0))
      complain(fmt::format("class {} is defined in several files: the page describes the first", cls), kFailed);
  }

  void write(const PageFormat& format) {
    std::error_code error;
    fs::create_directories(options_.out, error);
    write_file(format.index_name(), format.index(model_));
    for (const auto& [name, cls] : model_.classes())
      if (model_.chosen(name)) write_file(name + format.extension(), format.page(model_, cls));
  }

  void write_file(const std::string& name, const std::string& text) {
    const fs::path path = fs::path(options_.out) / name;
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out) return complain(fmt::format("cannot write {}", path.string()), kFailed);
    ++written_;
  }

  const DocOptions& options_;
  Output& output_;
  DocModel model_;
  int status_ = kEndedWell;
  std::size_t written_ = 0;
};

}  // namespace

int doc(const DocOptions& options, Output& output) { return Documenter(options, output).run(); }

}  // namespace breve::command
