// Asking the controller, and tables.
#include "plot.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace breve::command {

namespace {

/// A method of that name if there is one, else a variable.
breve_value value_of(breve_world* world, const std::string& name) {
  const breve_object controller = breve_world_controller(world);
  breve_value value{};
  breve_status status = breve_object_call(world, controller, name.c_str(), nullptr, 0, &value);
  if (status == BREVE_ERROR_NOT_FOUND) status = breve_object_get(world, controller, name.c_str(), &value);
  if (status == BREVE_OK) return value;
  if (status == BREVE_ERROR_NOT_FOUND)
    throw std::runtime_error(fmt::format("--plot: the controller has no method or variable '{}'", name));
  const breve_error* error = breve_world_last_error(world);
  throw std::runtime_error(fmt::format("--plot {}: {}", name, error ? error->message : breve_status_name(status)));
}

void write_text(const std::string& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) throw std::runtime_error(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (std::fclose(file) != 0 || !written)
    throw std::runtime_error(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
}

std::string quoted(const std::string& name) {
  return name.find_first_of(",\"\n") == std::string::npos ? name : '"' + name + '"';
}

}  // namespace

void Plotter::put(const std::string& name, double number, std::size_t column) {
  if (column == series_.columns.size()) {
    series_.names.push_back(name);
    series_.columns.emplace_back(series_.times.size() - 1, std::numeric_limits<double>::quiet_NaN());
  }
  series_.columns[column].push_back(number);
}

void Plotter::add(const std::string& name, const breve_value& value, std::size_t& column) {
  if (value.type == BREVE_TYPE_INT) return put(name, value.as.integer, column++);
  if (value.type == BREVE_TYPE_DOUBLE) return put(name, value.as.number, column++);
  if (value.type != BREVE_TYPE_VECTOR)
    throw std::runtime_error(fmt::format("--plot: '{}' gives no number and no vector", name));
  for (int i = 0; i < 3; ++i) put(fmt::format("{}.{}", name, "xyz"[i]), value.as.vector[i], column++);
}

void Plotter::look(breve_world* world) {
  series_.times.push_back(breve_world_time(world));
  std::size_t column = 0;
  for (const std::string& name : options_.names) add(name, value_of(world, name), column);
}

void Plotter::finish() const {
  if (!options_.log.empty()) write_text(options_.log, series_csv(series_));
  if (options_.plot.empty()) return;
  std::string title;
  for (const std::string& name : options_.names) title += (title.empty() ? "" : ", ") + name;
  constexpr const char* kAxis = "simulated time, s";
  const bool png = options_.plot.ends_with(".png");
  if (png)
    write_png(series_picture(series_, kAxis), options_.plot);
  else
    write_text(options_.plot, series_svg(series_, kAxis, title));
  if (!options_.log.empty()) return;
  const bool named = png || options_.plot.ends_with(".svg");
  const std::size_t dot = named ? options_.plot.size() - 4 : options_.plot.size();
  write_text(options_.plot.substr(0, dot) + ".csv", series_csv(series_));
}

std::string series_csv(const Series& series) {
  std::string text = "time";
  for (const std::string& name : series.names) text += ',' + quoted(name);
  text += '\n';
  for (std::size_t row = 0; row < series.times.size(); ++row) {
    text += fmt::format("{}", series.times[row]);
    for (const auto& column : series.columns) text += std::isnan(column[row]) ? "," : fmt::format(",{}", column[row]);
    text += '\n';
  }
  return text;
}

}  // namespace breve::command
