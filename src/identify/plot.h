/// Plots for HTML pages, as self-contained SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace taut::identify {

/// Returns the text with < > & " as entities.
std::string Escaped(const std::string& text);

struct Series {
  std::string style;  ///< CSS class of its marks: "untuned", "fitted", "held".
  std::vector<std::pair<double, double>> points;
  bool line = false;  ///< Connected by lines; else dots.
};

struct Plot {
  std::string title, x, y;  ///< Plain text.
  std::vector<Series> series;
  std::vector<double> levels;  ///< Horizontal lines.
  std::vector<double> marks;   ///< Vertical lines.
};

/// Returns a figure without non-finite points; an empty string if no points are left.
std::string Svg(const Plot& plot);

/// Returns about five round numbers within low..high.
std::vector<double> Ticks(double low, double high);

}  // namespace taut::identify
