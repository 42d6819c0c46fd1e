// A plot as pixels.
#pragma once

#include "runtime/scene/picture.hpp"
#include "runtime/scene/plot.hpp"

namespace breve {

/// The same plot as in SVG; without depth. Where the font DejaVu Sans is not installed, it has no text.
Picture plot_picture(const ScenePlot& plot, const CostMeter& meter = {});

}  // namespace breve
