#include "compare/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace taut::compare {
namespace {

constexpr double kWidth = 460, kHeight = 260;
constexpr double kLeft = 62, kRight = 12, kTop = 28, kBottom = 42;

struct Axis {
  double low = INFINITY, high = -INFINITY;
  double from = 0, to = 1;  ///< Range of the axis on the page.

  void Take(double x) { low = std::min(low, x), high = std::max(high, x); }
  void Widen(double share) {
    const double size = std::fabs(high);
    const double room = high > low ? share * (high - low) : size > 1e-12 ? 0.1 * size : 1.0;
    low -= room, high += room;
  }
  double At(double x) const { return from + (x - low) / (high - low) * (to - from); }
};

/// Lines of more points have no dots.
constexpr std::size_t kMostDots = 60;

std::string HtmlRow(const std::vector<std::string>& cells, const char* tag) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) {
    out += std::string("<") + tag + ">" + Escaped(cell) + "</" + tag + ">";
  }
  return out + "</tr>\n";
}

}  // namespace

const char* const kPageStyle = R"(
body{font:15px/1.45 system-ui,sans-serif;color:#1c2430;background:#fff;max-width:1000px;margin:24px auto;padding:0 16px}
h1{font-size:24px;margin:0 0 4px}h2{font-size:18px;margin:28px 0 8px}
table{border-collapse:collapse;margin:8px 0}td,th{padding:3px 10px;border-bottom:1px solid #dde2e8;text-align:right;white-space:nowrap}
td:first-child,th:first-child,td.word{text-align:left}th{font-weight:600;color:#46525f}
.verdict{padding:10px 14px;border-left:5px solid;margin:12px 0}.good{border-color:#2a8a4a;background:#eef7f0}.bad{border-color:#c0392b;background:#fbeeec}
.note{color:#5b6774}svg{margin:4px 8px 4px 0}svg text{font:11px system-ui,sans-serif;fill:#46525f}svg text.title{font-size:12px;font-weight:600;fill:#1c2430}
.grid{stroke:#e6eaee}.level{stroke:#8a96a3;stroke-dasharray:4 3}circle.untuned{fill:#b4bcc6}circle.fitted{fill:#1f6fb2}circle.held{fill:#d9822b}
polyline{fill:none;stroke-width:1.5}polyline.fitted{stroke:#1f6fb2}.key span{display:inline-block;margin-right:18px}.dot{width:9px;height:9px;border-radius:50%;display:inline-block;margin-right:5px}
.wide{overflow-x:auto}
)";

std::string HtmlTable(const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"wide\"><table>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) out += HtmlRow(rows[i], i == 0 ? "th" : "td");
  return out + "</table></div>\n";
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::vector<double> Ticks(double low, double high) {
  if (!(high > low)) return {low};
  const double rough = (high - low) / 5, ten = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * ten;
  for (const double nice : {1.0, 2.0, 5.0}) {
    if (nice * ten >= rough) {
      step = nice * ten;
      break;
    }
  }
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    out.push_back(k * step + 0.0);  // converts -0 to 0
  }
  return out;
}

std::string Svg(const Plot& plot) {
  Axis x, y;
  const auto good = [](const std::pair<double, double>& p) {
    return std::isfinite(p.first) && std::isfinite(p.second);
  };
  for (const Series& s : plot.series) {
    for (const auto& p : s.points) {
      if (good(p)) x.Take(p.first), y.Take(p.second);
    }
  }
  if (!(x.low <= x.high)) return {};
  for (const double level : plot.levels) y.Take(level);
  for (const double mark : plot.marks) x.Take(mark);
  x.Widen(0.03), y.Widen(0.06);
  x.from = kLeft, x.to = kWidth - kRight, y.from = kHeight - kBottom, y.to = kTop;
  std::string out = fmt::format(
      R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="{2}">)", kWidth,
      kHeight, Escaped(plot.title));
  out += fmt::format(R"(<text class="title" x="{}" y="16">{}</text>)", kLeft, Escaped(plot.title));
  const auto line = [&](const char* style, double x1, double y1, double x2, double y2) {
    out += fmt::format(R"(<line class="{}" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                       style, x1, y1, x2, y2);
  };
  for (const double t : Ticks(x.low, x.high)) {
    line("grid", x.At(t), y.from, x.At(t), y.to);
    out += fmt::format(
        R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="middle">{:.4g}</text>)", x.At(t),
        y.from + 14, t);
  }
  for (const double t : Ticks(y.low, y.high)) {
    line("grid", x.from, y.At(t), x.to, y.At(t));
    out +=
        fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{:.4g}</text>)",
                    x.from - 5, y.At(t) + 4, t);
  }
  for (const double level : plot.levels) line("level", x.from, y.At(level), x.to, y.At(level));
  for (const double mark : plot.marks) line("level", x.At(mark), y.from, x.At(mark), y.to);
  for (const Series& s : plot.series) {
    std::string path;
    for (const auto& p : s.points) {
      if (!good(p)) continue;
      if (s.line) path += fmt::format("{:.1f},{:.1f} ", x.At(p.first), y.At(p.second));
      if (s.line && s.points.size() > kMostDots) continue;
      out += fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="2.2"/>)", s.style,
                         x.At(p.first), y.At(p.second));
    }
    if (s.line) out += fmt::format(R"(<polyline class="{}" points="{}"/>)", s.style, path);
  }
  out += fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
                     0.5 * (x.from + x.to), kHeight - 8, Escaped(plot.x));
  out += fmt::format(
      R"svg(<text class="tick" transform="translate(13 {:.1f}) rotate(-90)" text-anchor="middle">{}</text>)svg",
      0.5 * (y.from + y.to), Escaped(plot.y));
  return out + "</svg>\n";
}

}  // namespace taut::compare
