#include "compare/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace taut::compare {
namespace {

constexpr double kWidth = 460, kHeight = 260;
constexpr double kLeft = 62, kRight = 12, kTop = 28, kBottom = 42;

/// Largest number of points of a line that is drawn with dots.
constexpr std::size_t kMostDots = 60;

std::string HtmlRow(const std::vector<std::string>& cells, const char* tag) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) {
    out += std::string("<") + tag + ">" + Escaped(cell) + "</" + tag + ">";
  }
  return out + "</tr>\n";
}

// Colors of the viewer's pages (web/src/style.css); blue and orange are distinct with color vision
// deficiencies.
const char* const kPageStyle = R"(
:root{--page:#f5f7f9;--panel:#fff;--text:#1c232b;--faint:#5b6671;--line:#d3dae0;--accent:#0072b2;--good:#00734f;--warn:#b34700;--held:#d55e00;--pale:#aab4be}
@media (prefers-color-scheme:dark){:root{--page:#10151b;--panel:#161d25;--text:#e3e8ed;--faint:#98a4b0;--line:#2c3742;--accent:#56b4e9;--good:#2bd4a4;--warn:#ff8c42;--held:#ff8c42;--pale:#5f6b77}}
@media print{:root{--page:#fff}}
body{font:15px/1.45 system-ui,sans-serif;color:var(--text);background:var(--page);margin:0}
header{background:var(--panel);border-bottom:1px solid var(--line);padding:12px max(16px,calc(50vw - 550px));display:flex;gap:10px;align-items:baseline}
header b{color:var(--accent);font-size:18px}h1{font-size:18px;margin:0}.kind{font-size:12px;color:var(--faint);border:1px solid var(--line);border-radius:9px;padding:1px 9px}
main{max-width:1100px;margin:0 auto;padding:8px 16px 40px}h2{font-size:18px;margin:28px 0 8px}a{color:var(--accent)}
.cards{display:flex;flex-wrap:wrap;gap:10px;margin:12px 0}.card{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:8px 14px;min-width:130px;flex:1}
.card small{display:block;color:var(--faint);font-size:12px}.card strong{display:block;font-size:23px;line-height:1.3}.card .good{color:var(--good)}.card .bad{color:var(--warn)}
table{border-collapse:collapse;margin:8px 0;background:var(--panel);border:1px solid var(--line);font-size:14px}td,th{padding:3px 10px;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
td:first-child,th:first-child,td.word{text-align:left}th{font-weight:600;color:var(--faint)}
.verdict{padding:10px 14px;border-left:5px solid var(--line);margin:12px 0;background:var(--panel)}.verdict.good{border-color:var(--good)}.verdict.bad{border-color:var(--warn)}
.note{color:var(--faint)}svg{vertical-align:top;margin:4px 8px 4px 0;background:var(--panel);border:1px solid var(--line);border-radius:6px;max-width:100%}svg text{font:11px system-ui,sans-serif;fill:var(--faint)}svg text.title{font-size:12px;font-weight:600;fill:var(--text)}
.grid{stroke:var(--line);stroke-width:.7}.level{stroke:var(--faint);stroke-dasharray:4 3}circle.untuned{fill:var(--pale)}circle.fitted{fill:var(--accent)}circle.held{fill:var(--held)}circle.measured{fill:var(--text)}
polyline{fill:none;stroke-width:1.5}polyline.fitted{stroke:var(--accent)}polyline.held{stroke:var(--held)}polyline.untuned{stroke:var(--pale)}
.outline{fill:none;stroke:var(--faint)}.prior{fill:var(--line)}.interval{fill:var(--accent)}.start{stroke:var(--text);stroke-width:2}.axis{stroke:var(--line)}
.key span{display:inline-block;margin-right:18px}.dot{width:9px;height:9px;border-radius:50%;display:inline-block;margin-right:5px}
.dot.untuned{background:var(--pale)}.dot.fitted{background:var(--accent)}.dot.held{background:var(--held)}.dot.measured{background:var(--text)}
.wide{overflow-x:auto}
)";

}  // namespace

std::string PageHead(const std::string& title, const std::string& kind) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta "
         "name=\"viewport\" "
         "content=\"width=device-width\">\n<title>" +
         Escaped(title) + ": " + Escaped(kind) + "</title>\n<style>" + kPageStyle +
         "</style></head><body>\n<header><b>taut</b><h1>" + Escaped(title) +
         "</h1><span class=\"kind\">" + Escaped(kind) + "</span></header>\n<main>\n";
}

std::string Cards(const std::vector<Card>& cards) {
  std::string out = "<div class=\"cards\">\n";
  for (const Card& card : cards) {
    out += "<div class=\"card\"><small>" + Escaped(card.label) + "</small><strong class=\"" +
           card.style + "\">" + Escaped(card.value) + "</strong><small>" + Escaped(card.note) +
           "</small></div>\n";
  }
  return out + "</div>\n";
}

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

void Axis::Widen(double share) {
  const double size = std::fabs(high);
  const double room = high > low ? share * (high - low) : size > 1e-12 ? 0.1 * size : 1.0;
  low -= room, high += room;
}

Points Thinned(const Points& points, std::size_t most) {
  const std::size_t every = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  Points some;
  for (std::size_t i = 0; i < points.size(); i += every) some.push_back(points[i]);
  return some;
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
