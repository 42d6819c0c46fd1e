// Reads the reference files of tests/data/reference: tables of numbers, by the names of their columns.
#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace breve::reference {

/// One line of a CSV file, by the names of its columns.
class Row {
 public:
  Row(const std::vector<std::string>& names, std::vector<std::string> cells) : cells_(std::move(cells)) {
    for (std::size_t i = 0; i < names.size(); ++i) at_[names[i]] = i;
  }
  const std::string& text(const std::string& column) const {
    const auto found = at_.find(column);
    if (found == at_.end()) throw std::runtime_error("no column " + column);
    return cells_.at(found->second);
  }
  bool empty(const std::string& column) const { return text(column).empty(); }
  double number(const std::string& column) const { return std::strtod(text(column).c_str(), nullptr); }
  int integer(const std::string& column) const { return static_cast<int>(number(column)); }

 private:
  std::map<std::string, std::size_t> at_;
  std::vector<std::string> cells_;
};

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

/// All rows of a file; throws if it is not there or a row has another number of cells than the head.
template <class OneRow = Row>
std::vector<OneRow> read(const std::string& name) {
  std::ifstream in(std::string(BREVE_TEST_DATA) + "/reference/" + name + ".csv");
  std::string line;
  if (!std::getline(in, line)) throw std::runtime_error("no reference file " + name);
  const std::vector<std::string> names = split(line);
  std::vector<OneRow> rows;
  while (std::getline(in, line)) {
    std::vector<std::string> cells = split(line);
    // A last column of words may hold commas.
    while (cells.size() > names.size()) {
      cells[cells.size() - 2] += "," + cells.back();
      cells.pop_back();
    }
    if (cells.size() != names.size()) throw std::runtime_error(name + ": a row of another length: " + line);
    rows.emplace_back(names, std::move(cells));
  }
  if (rows.empty()) throw std::runtime_error(name + ": no rows");
  return rows;
}

/// Rows of a table in runs of equal text in a column, in the order of the file.
inline std::vector<std::vector<Row>> groups(const std::string& name, const std::string& column) {
  std::vector<std::vector<Row>> out;
  for (const Row& row : read(name)) {
    if (out.empty() || out.back().front().text(column) != row.text(column)) out.emplace_back();
    out.back().push_back(row);
  }
  return out;
}

}  // namespace breve::reference
