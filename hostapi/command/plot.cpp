// Asking the controller, and the files of what it says.
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "write_file.hpp"

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

/// Colours that people of all kinds of vision tell apart (Okabe and Ito 2008).
constexpr float kInks[][3] = {{0.00F, 0.45F, 0.70F}, {0.84F, 0.37F, 0.00F}, {0.00F, 0.62F, 0.45F},
                              {0.80F, 0.47F, 0.65F}, {0.90F, 0.62F, 0.00F}, {0.34F, 0.71F, 0.91F},
                              {0.20F, 0.20F, 0.20F}};

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

std::vector<std::uint8_t> Plotter::file(breve_plot_format format, const char* x_axis) const {
  std::string title;
  for (const std::string& name : options_.names) title += (title.empty() ? "" : ", ") + name;
  std::vector<breve_plot_line> lines(series_.columns.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].name = series_.names[i].c_str();
    lines[i].values = series_.columns[i].data();
    lines[i].count = series_.columns[i].size();
    std::copy_n(kInks[i % std::size(kInks)], 3, lines[i].color);
  }
  breve_plot_config config = breve_plot_config_default();
  config.title = title.c_str();
  config.x_axis = x_axis;
  config.xs = series_.times.data();
  config.x_count = series_.times.size();
  config.lines = lines.data();
  config.line_count = lines.size();
  std::size_t size = 0;
  std::vector<std::uint8_t> bytes;
  breve_status status = breve_plot_file(&config, format, nullptr, 0, &size);
  if (status == BREVE_OK) {
    bytes.resize(size);
    status = breve_plot_file(&config, format, bytes.data(), size, &size);
  }
  if (status != BREVE_OK)
    throw std::runtime_error(fmt::format("the plot cannot be drawn: {}", breve_status_name(status)));
  return bytes;
}

void Plotter::finish() const {
  constexpr const char* kAxis = "simulated time, s";
  const bool png = options_.plot.ends_with(".png"), named = png || options_.plot.ends_with(".svg");
  if (!options_.plot.empty())
    write_file(options_.plot, file(png ? BREVE_PLOT_FORMAT_PNG : BREVE_PLOT_FORMAT_SVG, kAxis));
  std::string log = options_.log;
  if (log.empty() && !options_.plot.empty())
    log = options_.plot.substr(0, named ? options_.plot.size() - 4 : options_.plot.size()) + ".csv";
  if (!log.empty()) write_file(log, file(BREVE_PLOT_FORMAT_CSV, "time"));
}

}  // namespace breve::command
