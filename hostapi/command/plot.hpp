// What methods or variables of the controller say over time: as a table of numbers and as a picture of lines.
#pragma once

#include <breve/breve.h>

#include <string>
#include <vector>

#include "record.hpp"

namespace breve::command {

struct PlotOptions {
  std::vector<std::string> names;  // methods without keywords, or variables
  std::string plot, log;           // files; "" for none
};

/// Numbers by time: a column for each.
struct Series {
  std::vector<std::string> names;
  std::vector<double> times;                 // simulated s
  std::vector<std::vector<double>> columns;  // as many rows as times; NaN where there was no number
};

class Plotter {
 public:
  explicit Plotter(PlotOptions options) : options_(std::move(options)) {}
  /// Ask the controller. @throws std::runtime_error if it has no such method or variable, or it gives no number
  void look(breve_world* world);
  /// @throws std::runtime_error if a file cannot be written
  void finish() const;
  const Series& series() const { return series_; }

 private:
  void add(const std::string& name, const breve_value& value, std::size_t& column);
  void put(const std::string& name, double number, std::size_t column);
  std::vector<std::uint8_t> file(breve_plot_format format, const char* x_axis) const;
  PlotOptions options_;
  Series series_;
};

}  // namespace breve::command
