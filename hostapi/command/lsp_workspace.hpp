// The files that an editor has open, and what is known of the programs they belong to. A file that an editor holds is
// taken from there wherever a program loads it, the rest from disk.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "breve/analysis.h"
#include "breve/breve.h"

namespace breve::command {

struct AnalysisDeleter {
  void operator()(breve_analysis* analysis) const { breve_analysis_destroy(analysis); }
};
using AnalysisHandle = std::unique_ptr<breve_analysis, AnalysisDeleter>;

/// One look at a program.
struct ProgramView {
  AnalysisHandle analysis;
  std::map<std::string, std::string> uris;                // of its files, by the name that the analysis has for each
  std::map<std::string, std::string, std::less<>> names;  // and back
  bool whole = false;  // it names a controller: it is a program, rather than a part of one
};

/// One file of a program, as asked for by its URI.
struct FileView {
  ProgramView* program = nullptr;  // null: nothing is known
  std::string name;                // of the file there
};

class LspWorkspace {
 public:
  explicit LspWorkspace(std::vector<std::string> paths) : paths_(std::move(paths)) {}

  void open(const std::string& uri, std::string text);
  void close(const std::string& uri);
  bool is_open(const std::string& uri) const { return documents_.find(uri) != documents_.end(); }
  /// The text of an open file, to be changed by `change`; null if it is not open.
  const std::string* text(const std::string& uri) const;
  void change(const std::string& uri, std::string text);
  /// Files on disk may have changed.
  void forget_programs();
  std::vector<std::string> open_uris() const;

  /// The file in the program that it belongs to: itself if it names a controller or nobody loads it, else that of
  /// another open file which loads it.
  FileView view(const std::string& uri);

  /// Where an editor finds a file of a program; a module of the class library is written to the user's cache for it. ""
  /// if there is nothing to find.
  std::string uri_of(const ProgramView& program, const std::string& name);

 private:
  struct Document {
    std::string path;  // canonical; "" if the URI does not name a file
    std::string text;
    std::unique_ptr<ProgramView> program;
  };
  class Modules;

  ProgramView& program_of(const std::string& uri, Document& document);
  std::unique_ptr<ProgramView> look(const std::string& uri, const Document& document);
  std::string library_uri(const std::string& module);
  std::string library_module(const std::string& path) const;

  std::vector<std::string> paths_;
  std::map<std::string, Document> documents_;  // by URI
};

/// Where modules of the class library are written for editors to show; "" if there is no place.
std::filesystem::path library_cache();

}  // namespace breve::command
