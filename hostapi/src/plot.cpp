// Plots of hosts, as files.
#include <algorithm>

#include "scene.hpp"
#include "steve/library/show.hpp"

using namespace breve::host;

namespace {

std::string text_of(const char* text) { return text ? text : ""; }

breve::ScenePlot plot_of(const breve_plot_config& config) {
  breve::ScenePlot plot;
  plot.title = text_of(config.title);
  plot.x_axis = text_of(config.x_axis);
  plot.y_axis = text_of(config.y_axis);
  if (config.x_count != 0) need(config.xs, "breve_plot_config.xs");
  if (config.xs) plot.xs.assign(config.xs, config.xs + config.x_count);
  if (config.line_count != 0) need(config.lines, "breve_plot_config.lines");
  for (std::size_t i = 0; i < config.line_count; ++i) {
    const breve_plot_line& given = config.lines[i];
    if (given.count != 0) need(given.values, "breve_plot_line.values");
    breve::ScenePlot::Line line;
    line.name = text_of(given.name);
    line.color = breve::color_of(breve::Vector3(given.color[0], given.color[1], given.color[2]), 1).head<3>();
    if (given.count != 0) line.values.assign(given.values, given.values + given.count);
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace

breve_status breve_plot_file(const breve_plot_config* config, uint32_t format, uint8_t* bytes, size_t capacity,
                             size_t* size) {
  return guard([&] {
    need(config, "config");
    need(size, "size");
    if (capacity != 0) need(bytes, "bytes");
    if (format > BREVE_PLOT_FORMAT_CSV)
      fail(BREVE_ERROR_ARGUMENT, "format is " + std::to_string(format) + ", which is not a breve_plot_format");
    const breve::ScenePlot plot = plot_of(read_config(config, breve_plot_config_default(), "breve_plot_config"));
    const std::string file = format == BREVE_PLOT_FORMAT_SVG   ? breve::plot_svg(plot)
                             : format == BREVE_PLOT_FORMAT_PNG ? breve::steve::png_of(plot)
                                                               : breve::plot_csv(plot);
    if (file.size() <= capacity) std::copy(file.begin(), file.end(), bytes);
    *size = file.size();
  });
}
