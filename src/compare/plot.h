/// Plots and tables for self-contained HTML pages about measurements: of fits and of comparisons.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace taut::compare {

/// Returns the beginning of a page, up to its first section, in the look of the viewer's pages.
/// `kind`: word next to the title, such as "fit".
std::string PageHead(const std::string& title, const std::string& kind);

/// Headline result at the top of a page.
struct Card {
  std::string label, value, note;  ///< Texts without markup.
  std::string style;               ///< CSS class of the value: "good", "bad" or empty.
};
std::string Cards(const std::vector<Card>& cards);

/// Returns a table; the first row is the header. Escapes all texts.
std::string HtmlTable(const std::vector<std::vector<std::string>>& rows);

/// Escapes < > & " as HTML entities.
std::string Escaped(const std::string& text);

using Points = std::vector<std::pair<double, double>>;

/// Returns at most `most` of the points, evenly chosen, so that pages of long logs stay small.
Points Thinned(const Points& points, std::size_t most);

/// Maps values to positions on the page.
struct Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double from = 0, to = 1;  ///< Range of the axis on the page.

  void Take(double x) { low = std::min(low, x), high = std::max(high, x); }
  void Widen(double share);  ///< Adds this share of the range at either end.
  double At(double x) const { return from + (x - low) / (high - low) * (to - from); }
};

struct Series {
  /// CSS class of the marks: "untuned", "fitted", "held" or "measured".
  std::string style;
  Points points;
  /// Connect the points by lines; otherwise draw dots. Lines of few points have dots, too.
  bool line = false;
};

struct Plot {
  std::string title, x, y;  ///< Texts without markup.
  std::vector<Series> series;
  std::vector<double> levels;  ///< Values at which horizontal lines are drawn.
  std::vector<double> marks;   ///< Values at which vertical lines are drawn.
};

/// Returns the figure as SVG. Omits points that are not finite. Returns an empty text if no points
/// are left.
std::string Svg(const Plot& plot);

/// Returns about five round numbers between low and high.
std::vector<double> Ticks(double low, double high);

}  // namespace taut::compare
