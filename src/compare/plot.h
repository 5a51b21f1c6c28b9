/// Plots and tables for self-contained HTML pages about measurements: of fits and of comparisons.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace taut::compare {

/// Style sheet of the pages.
extern const char* const kPageStyle;

/// Returns a table; the first row is the header. Escapes all texts.
std::string HtmlTable(const std::vector<std::vector<std::string>>& rows);

/// Escapes < > & " as HTML entities.
std::string Escaped(const std::string& text);

struct Series {
  std::string style;  ///< CSS class of the marks: "untuned", "fitted" or "held".
  std::vector<std::pair<double, double>> points;
  /// Connect the points by lines; otherwise draw dots. Lines of few points have dots, too.
  bool line = false;
};

struct Plot {
  std::string title, x, y;  ///< Texts without markup.
  std::vector<Series> series;
  std::vector<double> levels;  ///< Values of horizontal lines.
  std::vector<double> marks;   ///< Values of vertical lines.
};

/// Returns the figure as SVG. Omits points that are not finite. Returns an empty text if no points
/// are left.
std::string Svg(const Plot& plot);

/// Returns about five round numbers between low and high.
std::vector<double> Ticks(double low, double high);

}  // namespace taut::compare
