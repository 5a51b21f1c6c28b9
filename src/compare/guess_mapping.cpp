// Guess of a mapping: layout from `RecognizeLog`, columns from `MeaningOf`, written as JSON with
// comments.
#include "taut/guess_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/foreign_units.h"
#include "compare/column_meaning.h"
#include "compare/log_clock.h"
#include "compare/log_form.h"
#include "trace/channel_names.h"

namespace taut {
namespace {

using Json = nlohmann::ordered_json;

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
    result_.doubts = form_.doubts;
    if (!form_.is_trace) {
      clock_ = GuessClock(form_);
      result_.doubts.insert(result_.doubts.end(), clock_.doubts.begin(), clock_.doubts.end());
    }
    // Names that taut has given to columns without a header are no names of members.
    const bool nameless = form_.layout.header_lines == 0 && form_.program.empty();
    for (std::size_t i = 0; i < form_.names.size(); ++i) {
      meanings_.push_back(MeaningOf(form_.names[i], form_.units[i], form_.length_unit,
                                    nameless ? RobotNames() : robot_));
      if (trace::IsTautChannel(form_.names[i])) used_.insert(i);
    }
    Groups();
    SingleColumns();
    CablesInOrder();
    Report();
    result_.text = Text(path);
    return std::move(result_);
  }

 private:
  /// Columns that no rule uses yet; a `*` in a name would make its rule a pattern.
  bool Free(std::size_t i) const {
    const std::string& name = form_.names[i];
    return i != clock_.column && !used_.contains(i) && !name.empty() && name.find('*') == name.npos;
  }

  /// Adds rules for vectors and quaternions: columns of one member whose names differ only in their
  /// axis.
  void Groups() {
    std::map<std::string, std::map<char, std::size_t>> groups;  // column of each axis, by channel
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const ColumnMeaning& meaning = meanings_[i];
      if (Free(i) && meaning.axis != 0 && !meaning.several &&
          meaning.channel.find("{axis}") != meaning.channel.npos) {
        groups[meaning.channel].emplace(meaning.axis, i);
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
      DoubtLeftOver(columns.at('x'));
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
      if (!Free(i)) continue;
      if (!meaning.kind.empty() && meaning.channel.empty()) NotAssigned(i);
      if (meaning.channel.empty()) continue;
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
      DoubtLeftOver(i);
      AddChannel(i, meaning.channel, "");
    }
  }

  /// Reports why a column with the name of a member has no channel.
  void NotAssigned(std::size_t i) {
    const ColumnMeaning& meaning = meanings_[i];
    const std::string what = Quoted(form_.names[i]) + " of " + meaning.kind + " " + meaning.member;
    if (!meaning.unknown_unit.empty()) {
      result_.doubts.push_back(what + " has the unknown unit " + Quoted(meaning.unknown_unit));
    } else if (!meaning.refused.empty()) {
      result_.doubts.push_back(what + " is not assigned because of " + Quoted(meaning.refused));
    }
  }

  /// Warns of names that contain more than the member's name and known words.
  void DoubtLeftOver(std::size_t i) {
    const ColumnMeaning& meaning = meanings_[i];
    if (meaning.left_over.empty() || form_.program == "OptiTrack" || form_.program == "Vicon")
      return;
    result_.doubts.push_back(fmt::format("{} is assigned to {} {}, in spite of {}",
                                         Quoted(form_.names[i]), meaning.kind, meaning.member,
                                         Quoted(meaning.left_over)));
  }

  void AddChannel(std::size_t i, const std::string& channel, const std::string& remark) {
    Json rule{{"from", form_.names[i]}, {"to", channel}};
    AddUnit(i, UnitOfName(channel), rule);
    channels_.push_back({rule, remark});
    used_.insert(i);
    if (channel.starts_with("cable/") && channel.ends_with("/tension_n")) ++tensions_;
  }

  /// Assigns columns of forces to the cables in the robot's order, if there are as many columns as
  /// cables and none has the name of a cable.
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
    if (form_.program == "MATLAB") {
      result_.results.push_back("layout: MATLAB 7.3");
      return ReportClock();
    }
    result_.results.push_back(fmt::format(
        "layout: {}separator {}, decimal {}{}", form_.program.empty() ? "" : form_.program + ", ",
        separator, layout.decimal == ',' ? "comma" : "point",
        layout.encoding == TextEncoding::kWindows1252 ? ", encoding windows-1252" : ""));
    ReportClock();
  }

  void ReportClock() {
    const Json& time = clock_.time;
    result_.results.push_back(
        clock_.column
            ? fmt::format("clock: {}{}, {:.4g} rows per second",
                          Quoted(form_.names[*clock_.column]),
                          time.contains("unit")     ? " in " + time["unit"].get<std::string>()
                          : time.contains("format") ? ", " + time["format"].get<std::string>()
                                                    : " in s",
                          clock_.rate_hz)
            : fmt::format("clock: none, {:.4g} rows per second", clock_.rate_hz));
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
    if (!ignored.empty()) {
      std::string names;
      const std::size_t shown = std::min<std::size_t>(ignored.size(), 6);
      for (std::size_t i = 0; i < shown; ++i) names += (i ? ", " : "") + Quoted(ignored[i]);
      if (shown < ignored.size()) names += fmt::format(" and {} more", ignored.size() - shown);
      result_.doubts.push_back(std::string(form_.is_trace
                                               ? "not recognized, so the names are kept: "
                                               : "not recognized, therefore ignored: ") +
                               names);
    }
    if (form_.y_up && !vectors_.empty()) {
      result_.doubts.push_back("the vertical axis is y by default in " + form_.program +
                               "; in taut it is z");
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
    return text + "    \"time\": " + clock_.time.dump() + "\n  }";
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
  LogClock clock_;
  std::size_t tensions_ = 0;
};

}  // namespace

std::optional<GuessedMapping> GuessMapping(const std::string& path, const RobotNames& robot,
                                           Diagnostics& out) {
  std::error_code ignored;
  const auto type = std::filesystem::status(path, ignored).type();
  if (std::filesystem::exists(std::filesystem::file_status(type)) &&
      type != std::filesystem::file_type::regular &&
      type != std::filesystem::file_type::directory) {
    out.Error("file.not_regular", {path},
              "the log is a pipe, socket or device, but it is read twice",
              "save it to a file first");
    return std::nullopt;
  }
  const auto form = RecognizeLog(path, out);
  if (!form) return std::nullopt;
  return Guess(*form, robot).Make(path);
}

}  // namespace taut
