// Answers to an editor's questions about a place: the protocol's JSON on one side, breve.h on the other.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lsp_workspace.hpp"

namespace breve::command {

/// A place as the library counts it.
struct LspPosition {
  FileView file;
  std::uint32_t line = 0, column = 0;  // from 1, in bytes
};

class LspFeatures {
 public:
  explicit LspFeatures(LspWorkspace& workspace) : workspace_(workspace) {}

  /// @param snippets  the editor can put placeholders into what it inserts
  void set_snippets(bool snippets) { snippets_ = snippets; }

  // Each takes the `params` of the request of that name and gives its `result`.
  nlohmann::json hover(const nlohmann::json& params);
  nlohmann::json definition(const nlohmann::json& params);
  nlohmann::json references(const nlohmann::json& params);
  nlohmann::json completion(const nlohmann::json& params);
  nlohmann::json signature_help(const nlohmann::json& params);
  nlohmann::json document_symbols(const nlohmann::json& params);

  /// The diagnostics of an open file and of the files that its program loads, by URI.
  std::map<std::string, nlohmann::json> diagnostics();

 private:
  LspPosition position_of(const nlohmann::json& params);
  nlohmann::json range(const ProgramView& program, const breve_span& span) const;
  nlohmann::json location(const ProgramView& program, const breve_span& span);
  nlohmann::json completion_item(const ProgramView& program, const breve_completion& item) const;
  nlohmann::json diagnostic(const ProgramView& program, const breve_diagnostic& diagnostic) const;

  LspWorkspace& workspace_;
  bool snippets_ = false;
};

/// The text of a file of a program; empty if it has none of that name.
std::string_view text_of(const ProgramView& program, std::string_view name);

}  // namespace breve::command
