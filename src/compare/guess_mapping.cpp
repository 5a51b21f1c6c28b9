// Guess of a mapping: layout from `RecognizeLog`, columns from `MeaningOf`, written as JSON with
// comments.
#include "taut/guess_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/foreign_units.h"
#include "compare/column_meaning.h"
#include "compare/log_form.h"
#include "trace/clock_text.h"

namespace taut {
namespace {

using Json = nlohmann::ordered_json;

/// Clocks that count from 1970 in s, ms, us and ns have values in these ranges, from 2001 to 2096.
constexpr struct {
  const char* unit;
  double from;
} kEpochs[] = {{"s", 1e9}, {"ms", 1e12}, {"us", 1e15}, {"ns", 1e18}};
constexpr double kEpochSpan = 4;  // times `from`

std::string Quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// One rule of the result, and the comment at its end.
struct Rule {
  Json json;
  std::string remark;
};

class Guess {
 public:
  Guess(const LogForm& form, const RobotNames& robot) : form_(form), robot_(robot) {}

  GuessedMapping Make(const std::string& path) {
    if (!form_.is_trace) Clock();
    for (std::size_t i = 0; i < form_.names.size(); ++i) {
      meanings_.push_back(MeaningOf(form_.names[i], form_.units[i], form_.length_unit, robot_));
    }
    Groups();
    SingleColumns();
    CablesInOrder();
    Report();
    result_.text = Text(path);
    return std::move(result_);
  }

 private:
  std::vector<double> Values(std::size_t column, std::optional<ClockFormat> format) const {
    std::vector<double> values;
    for (const auto& row : form_.rows) {
      values.push_back(format ? trace::ParseClock(row[column], *format).value_or(NAN)
                              : CellValue(row[column], form_.layout.decimal));
    }
    return values;
  }

  static bool Increases(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]) || (i > 0 && values[i] <= values[i - 1])) return false;
    }
    return values.size() > 1;
  }

  /// Returns the format in which all cells of a column are increasing times; the one in which a
  /// day of a month comes first wins over the other if both do.
  std::optional<ClockFormat> FormatOf(std::size_t column) const {
    for (const ClockFormat format : {ClockFormat::kIso8601, ClockFormat::kTimeOfDay,
                                     ClockFormat::kDayMonthYear, ClockFormat::kMonthDayYear}) {
      if (Increases(Values(column, format))) return format;
    }
    return std::nullopt;
  }

  static bool NamesTime(const std::string& name) {
    static const std::set<std::string> words{"time",    "zeit",    "t",      "temps", "tiempo",
                                             "stamp",   "date",    "datum",  "clock", "timestamp",
                                             "x_value", "seconds", "elapsed"};
    const auto tokens = Tokens(name);
    return name == "X_Value" || std::any_of(tokens.begin(), tokens.end(), [&](const auto& token) {
             return words.contains(token);
           });
  }

  /// Finds the clock: the first increasing column with a name of a time, else a column of times,
  /// else the first column, if it increases.
  void Clock() {
    const std::size_t count = form_.names.size();
    std::optional<std::size_t> found;
    for (const bool named : {true, false}) {
      if (!named && form_.rate_hz) break;
      for (std::size_t i = 0; i < count && !found; ++i) {
        if (form_.names[i].empty() || (named && !NamesTime(form_.names[i]))) continue;
        if (!named && i > 0 && !FormatOf(i)) continue;
        if (FormatOf(i) || Increases(Values(i, {}))) found = i;
      }
    }
    if (found && form_.rate_hz && Tokens(form_.names[*found]).front() == "frame") found.reset();
    if (!found) {
      time_["row_s"] = form_.rate_hz ? 1 / *form_.rate_hz : 1.0;
      rate_hz_ = 1 / time_["row_s"].get<double>();
      if (form_.rate_hz) return;
      result_.doubts.push_back(
          "no column of times was found: set row_s to the time between two rows");
      return;
    }
    clock_ = *found;
    time_["column"] = form_.names[*found];
    const auto format = FormatOf(*found);
    const std::vector<double> values = Values(*found, format);
    const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
    double unit_s = 1;
    if (format) {
      time_["format"] = ClockFormatName(*format);
    } else {
      const std::string unit = ClockUnit(*found, values.front(), step);
      unit_s = base::FindUnit(unit)->factor;
      if (unit != "s") time_["unit"] = unit;
    }
    const bool has_date = format && *format != ClockFormat::kTimeOfDay;
    if (values.front() != 0 && !has_date) time_["zero"] = "first";
    rate_hz_ = 1 / (step * unit_s);
  }

  std::string ClockUnit(std::size_t column, double first, double step) {
    std::string unit = KnownUnit(form_.units[column]);
    if (unit.empty()) unit = UnitInName(form_.names[column]);
    if (const auto known = base::FindUnit(unit); known && known->si == "s") return unit;
    for (const auto& epoch : kEpochs) {
      if (first >= epoch.from && first < kEpochSpan * epoch.from) return epoch.unit;
    }
    unit = step >= 1 ? "ms" : "s";
    if (form_.program.empty()) {
      result_.doubts.push_back(
          fmt::format("the clock {} has no unit: its step of {:.4g} suggests {}",
                      Quoted(form_.names[column]), step, unit));
    }
    return unit;
  }

  /// Columns that no rule uses yet; a `*` in a name would make its rule a pattern.
  bool Free(std::size_t i) const {
    const std::string& name = form_.names[i];
    return i != clock_ && !used_.contains(i) && !name.empty() && name.find('*') == name.npos;
  }

  /// Vectors and quaternions: columns of one member whose names differ only in their axis.
  void Groups() {
    std::map<std::string, std::map<char, std::size_t>> groups;  // by channel
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const auto& [unit, kind, member, channel, axis, several] = meanings_[i];
      if (Free(i) && axis != 0 && channel.find("{axis}") != channel.npos && !several) {
        groups[channel].emplace(axis, i);
      }
    }
    for (const auto& [channel, columns] : groups) {
      const bool turns = channel.find("orientation") != channel.npos;
      const std::string axes = turns ? "wxyz" : "xyz";
      if (columns.size() != axes.size()) continue;
      const auto pattern = PatternOf(columns);
      if (!pattern) continue;
      Json rule{{"from", *pattern}, {"to", channel}};
      if (!turns) AddUnit(columns.begin()->second, "m", rule);
      (turns ? quaternions_ : vectors_).push_back({rule, ""});
      for (const auto& [axis, i] : columns) used_.insert(i);
    }
  }

  /// Returns the common name of columns with `{axis}` or `{AXIS}` in place of their axis.
  std::optional<std::string> PatternOf(const std::map<char, std::size_t>& columns) const {
    const std::string& x = form_.names[columns.at('x')];
    for (std::size_t at = x.size(); at-- > 0;) {
      if (x[at] != 'x' && x[at] != 'X') continue;
      const bool capital = x[at] == 'X';
      const bool fits = std::all_of(columns.begin(), columns.end(), [&](const auto& column) {
        std::string wanted = x;
        wanted[at] = static_cast<char>(capital ? column.first - 'a' + 'A' : column.first);
        return form_.names[column.second] == wanted;
      });
      if (!fits) continue;
      std::string pattern = x;
      return pattern.replace(at, 1, capital ? "{AXIS}" : "{axis}");
    }
    return std::nullopt;
  }

  /// Adds the file's unit to a rule whose result is in `si`.
  void AddUnit(std::size_t column, const std::string& si, Json& rule) {
    const std::string& unit = meanings_[column].unit;
    if (const auto known = base::FindUnit(unit); known && known->si == si) {
      if (unit != si) rule["from_unit"] = unit;
    } else if (rule["to"].get<std::string>().find("orientation") == std::string::npos) {
      result_.doubts.push_back(
          fmt::format("{} has no unit: read in {}", Quoted(form_.names[column]), si));
    }
  }

  void SingleColumns() {
    std::set<std::string> targets;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const ColumnMeaning& meaning = meanings_[i];
      if (!Free(i) || meaning.channel.empty()) continue;
      if (meaning.channel.find("{axis}") != meaning.channel.npos) continue;
      if (meaning.several) {
        result_.doubts.push_back(
            fmt::format("{} fits several {}s of the robot", Quoted(form_.names[i]), meaning.kind));
        continue;
      }
      if (!targets.insert(meaning.channel).second) {
        result_.doubts.push_back(fmt::format("{} is the second column that fits {}",
                                             Quoted(form_.names[i]), meaning.channel));
        continue;
      }
      AddChannel(i, meaning.channel, "");
    }
  }

  void AddChannel(std::size_t i, const std::string& channel, const std::string& remark) {
    Json rule{{"from", form_.names[i]}, {"to", channel}};
    AddUnit(i, UnitOfName(channel), rule);
    channels_.push_back({rule, remark});
    used_.insert(i);
    if (channel.starts_with("cable/") && channel.ends_with("/tension_n")) ++tensions_;
  }

  /// As many columns of forces as cables, none with a name of a cable: in the robot's order.
  void CablesInOrder() {
    if (tensions_ > 0 || robot_.cables.empty()) return;
    std::vector<std::size_t> forces;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const auto known = base::FindUnit(meanings_[i].unit);
      if (Free(i) && known && known->si == "N") forces.push_back(i);
    }
    if (forces.size() != robot_.cables.size()) return;
    for (std::size_t k = 0; k < forces.size(); ++k) {
      AddChannel(forces[k], "cable/" + robot_.cables[k] + "/tension_n", "CHECK the order");
    }
    result_.doubts.push_back(fmt::format(
        "no column has a cable's name; the {} columns of forces are assigned to the cables in the "
        "order of the model",
        forces.size()));
  }

  /// A pattern of columns to ignore must not contain a `*` of a name, so such names are kept.
  std::vector<std::string> Ignored() const {
    std::vector<std::string> ignored;
    for (std::size_t i = 0; i < form_.names.size(); ++i) {
      if (Free(i) && !form_.names[i].empty()) ignored.push_back(form_.names[i]);
    }
    return ignored;
  }

  void ReportLayout() {
    const TableLayout& layout = form_.layout;
    const char* separator = layout.separator == '\t'  ? "tab"
                            : layout.separator == ' ' ? "blank"
                            : layout.separator == ';' ? "semicolon"
                            : layout.separator == '|' ? "bar"
                                                      : "comma";
    result_.results.push_back(fmt::format(
        "layout: {}separator {}, decimal {}{}", form_.program.empty() ? "" : form_.program + ", ",
        separator, layout.decimal == ',' ? "comma" : "point",
        layout.encoding == TextEncoding::kWindows1252 ? ", encoding windows-1252" : ""));
    result_.results.push_back(
        clock_ < form_.names.size()
            ? fmt::format("clock: {}{}, {:.4g} rows per second", Quoted(form_.names[clock_]),
                          time_.contains("unit")     ? " in " + time_["unit"].get<std::string>()
                          : time_.contains("format") ? ", " + time_["format"].get<std::string>()
                                                     : " in s",
                          rate_hz_)
            : fmt::format("clock: none, {:.4g} rows per second", rate_hz_));
  }

  void Report() {
    if (form_.is_trace) {
      result_.results.push_back("layout: " + form_.program);
    } else {
      ReportLayout();
    }
    std::string members =
        fmt::format("tensions of {} of {} cables", tensions_, robot_.cables.size());
    if (!vectors_.empty()) members += fmt::format(", positions of {} members", vectors_.size());
    if (!quaternions_.empty()) {
      members += fmt::format(", orientations of {} bodies", quaternions_.size());
    }
    result_.results.push_back("channels: " + members);
    const auto ignored = Ignored();
    if (!ignored.empty() && !form_.is_trace) {
      std::string names;
      const std::size_t shown = std::min<std::size_t>(ignored.size(), 6);
      for (std::size_t i = 0; i < shown; ++i) names += (i ? ", " : "") + Quoted(ignored[i]);
      if (shown < ignored.size()) names += fmt::format(" and {} more", ignored.size() - shown);
      result_.doubts.push_back("not recognized, therefore ignored: " + names);
    }
    if (form_.y_up && !vectors_.empty()) {
      result_.doubts.push_back("the vertical axis is y by default in " + form_.program +
                               "; in taut it is z");
    }
    if (time_.contains("format") && time_["format"] == "dd.mm.yyyy hh:mm:ss" &&
        Increases(Values(clock_, ClockFormat::kMonthDayYear))) {
      result_.doubts.push_back("the dates may also have the month first (mm/dd/yyyy)");
    }
  }

  static std::string List(const std::string& key, const std::vector<Rule>& rules) {
    std::string text = ",\n  \"" + key + "\": [\n";
    for (std::size_t i = 0; i < rules.size(); ++i) {
      text += fmt::format("    {}{}{}\n", rules[i].json.dump(-1, ' ', false),
                          i + 1 < rules.size() ? "," : "",
                          rules[i].remark.empty() ? "" : "  // " + rules[i].remark);
    }
    return text + "  ]";
  }

  std::string Table() const {
    const TableLayout& layout = form_.layout;
    std::string text = "  \"table\": {\n";
    const auto line = [&](const std::string& key, const Json& value, const std::string& remark) {
      text += fmt::format("    \"{}\": {},{}\n", key, value.dump(),
                          remark.empty() ? "" : "  // " + remark);
    };
    if (layout.skip_lines > 0) line("skip_lines", layout.skip_lines, "before the header");
    if (layout.header_lines == 0) line("header", false, "");
    if (layout.header_lines > 1) {
      line("header", layout.header_lines, "lines, joined to names of the columns");
    }
    if (layout.merged_header)
      line("merged_header", true, "an empty cell repeats the one before it");
    if (layout.separator != ',') line("separator", std::string(1, layout.separator), "");
    if (layout.decimal != '.') line("decimal", std::string(1, layout.decimal), "");
    if (layout.encoding == TextEncoding::kWindows1252) line("encoding", "windows-1252", "");
    if (!layout.columns.empty()) line("columns", layout.columns, "");
    if (const auto ignored = Ignored(); !ignored.empty()) {
      line("ignore", ignored, "not recognized");
    }
    return text + "    \"time\": " + time_.dump() + "\n  }";
  }

  std::string Text(const std::string& path) const {
    std::string text = fmt::format(
        "// Mapping of {} to taut's channels, guessed by `taut new mapping`.\n", Quoted(path));
    for (const std::string& doubt : result_.doubts) text += "// CHECK: " + doubt + "\n";
    text += "{\n  \"version\": 1";
    if (!form_.is_trace) text += ",\n" + Table();
    if (form_.y_up && !(vectors_.empty() && quaternions_.empty())) {
      text += ",\n  \"axes\": {\"x\": \"z\", \"y\": \"x\", \"z\": \"y\"}";
    }
    if (!channels_.empty()) text += List("channels", channels_);
    if (!vectors_.empty()) text += List("vectors", vectors_);
    if (!quaternions_.empty()) text += List("quaternions", quaternions_);
    return text + "\n}\n";
  }

  const LogForm& form_;
  const RobotNames& robot_;
  GuessedMapping result_;
  std::vector<ColumnMeaning> meanings_;
  std::set<std::size_t> used_;
  std::vector<Rule> channels_, vectors_, quaternions_;
  std::size_t clock_ = static_cast<std::size_t>(-1);
  std::size_t tensions_ = 0;
  double rate_hz_ = 0;
  Json time_;
};

}  // namespace

std::optional<GuessedMapping> GuessMapping(const std::string& path, const RobotNames& robot,
                                           Diagnostics& out) {
  const auto form = RecognizeLog(path, out);
  if (!form) return std::nullopt;
  return Guess(*form, robot).Make(path);
}

}  // namespace taut
