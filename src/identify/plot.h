/// Plots for pages, as SVG that needs nothing else.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace taut::identify {

/// With < > & " as entities.
std::string Escaped(const std::string& text);

struct Series {
  std::string style;  ///< Class of its marks: "untuned", "fitted", "held".
  std::vector<std::pair<double, double>> points;
  bool line = false;  ///< Joined; else dots.
};

struct Plot {
  std::string title, x, y;  ///< Plain text.
  std::vector<Series> series;
  std::vector<double> levels;  ///< Horizontal lines,
  std::vector<double> marks;   ///< and vertical ones.
};

/// A figure; points that are not finite are left out. Empty if there are none.
std::string Svg(const Plot& plot);

/// Round numbers within low..high, some five of them.
std::vector<double> Ticks(double low, double high);

}  // namespace taut::identify
