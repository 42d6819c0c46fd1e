// `breve lsp`: a language server for editors, over standard input and output.
#pragma once

#include <string>
#include <vector>

namespace breve::command {

struct LspOptions {
  std::vector<std::string> paths;
};

/// Serve until the editor says `exit` or closes the input.
/// @return  0 if it asked for `shutdown` first, else 1
int lsp(const LspOptions& options);

}  // namespace breve::command
