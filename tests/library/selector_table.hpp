// The table of classes and selectors that old programs use, one row for each selector.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace breve {

struct SelectorRow {
  std::string cls, alias, parent, selector;
  std::vector<std::string> keywords;  // "keyword:type=default"
};

/// The rows of a file whose cells tabs separate, below a line of headings.
inline std::vector<SelectorRow> selector_rows(const char* file) {
  std::ifstream in(file);
  std::vector<SelectorRow> all;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::stringstream cells_in(line);
    for (std::string cell; std::getline(cells_in, cell, '\t');) cells.push_back(cell);
    cells.resize(5);
    SelectorRow row{cells[0], cells[1], cells[2], cells[3], {}};
    std::stringstream words(cells[4]);
    for (std::string word; words >> word;) row.keywords.push_back(word);
    all.push_back(row);
  }
  return all;
}

}  // namespace breve
