#include "compare/log_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/foreign_units.h"
#include "compare/column_meaning.h"
#include "trace/clock_text.h"
#include "trace/table_cells.h"

namespace taut {
namespace {

/// Clocks that count from 1970 in s, ms, us and ns have values in these ranges, from 2015 to 2096.
constexpr struct {
  const char* unit;
  double from;
} kEpochs[] = {{"s", 1.42e9}, {"ms", 1.42e12}, {"us", 1.42e15}, {"ns", 1.42e18}};
constexpr double kEpochSpan = 2.8;  // end of a range, as a multiple of `from`
/// Rows per second of usual loggers.
constexpr double kLeastRate_hz = 0.5, kMostRate_hz = 1e6;

class ClockGuess {
 public:
  explicit ClockGuess(const LogForm& form) : form_(form) {}

  std::vector<double> Values(std::size_t column, std::optional<ClockFormat> format) const {
    std::vector<double> values;
    for (const auto& row : form_.rows) {
      values.push_back(format ? trace::ParseClock(row[column], *format).value_or(NAN)
                              : trace::CellNumber(row[column], form_.layout.decimal).value_or(NAN));
    }
    return values;
  }

  static bool Increases(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]) || (i > 0 && values[i] <= values[i - 1])) return false;
    }
    return values.size() > 1;
  }

  /// Returns the format in which all cells of a column are increasing times. If both orders of day
  /// and month fit, returns the format with the day first.
  std::optional<ClockFormat> FormatOf(std::size_t column) const {
    for (const ClockFormat format : {ClockFormat::kIso8601, ClockFormat::kTimeOfDay,
                                     ClockFormat::kDayMonthYear, ClockFormat::kMonthDayYear}) {
      if (Increases(Values(column, format))) return format;
    }
    return std::nullopt;
  }

  bool NamesTime(std::size_t i) const {
    const std::string& name = form_.names[i];
    const std::string unit = UnitInName(name);
    if (const auto known = base::FindUnit(unit); known && known->si != "s") return false;
    if (name.find_first_of("[(") != name.npos && unit.empty()) {
      const auto tokens = Tokens(name.substr(0, name.find_first_of("[(")));
      // "T [degC]" is a temperature.
      if (tokens == std::vector<std::string>{"t"}) return false;
    }
    return name == "X_Value" ||
           HasWord(Tokens(name), {"time", "zeit", "t", "temps", "tiempo", "stamp", "date", "datum",
                                  "clock", "timestamp", "seconds", "elapsed"});
  }

  /// Returns whether a name is that of a row counter, which increases like a clock.
  bool NamesCounter(std::size_t i) const {
    return HasWord(Tokens(form_.names[i]), {"frame", "frames", "sample", "samples", "index",
                                            "count", "nr", "no", "scan", "record", "row", "seq"});
  }

  /// Finds the clock: the first increasing column with a name of a time, else a column of times,
  /// else the first column, if it increases.
  LogClock Run() {
    const std::size_t count = form_.names.size();
    std::optional<std::size_t> found;
    for (const bool named : {true, false}) {
      if (!named && (form_.rate_hz || !form_.program.empty())) break;
      for (std::size_t i = 0; i < count && !found; ++i) {
        if (form_.names[i].empty() || (named && !NamesTime(i))) continue;
        if (NamesCounter(i) && !FormatOf(i)) continue;
        if (!named && i > 0 && !FormatOf(i)) continue;
        if (FormatOf(i) || Increases(Values(i, {}))) found = i;
      }
    }
    if (!found) {
      WithoutClock();
      return std::move(clock_);
    }
    clock_.column = *found;
    clock_.time["column"] = form_.names[*found];
    const auto format = FormatOf(*found);
    const std::vector<double> values = Values(*found, format);
    const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
    double unit_s = 1;
    bool epoch = format.has_value();
    if (format) {
      clock_.time["format"] = ClockFormatName(*format);
      if (*format == ClockFormat::kDayMonthYear &&
          Increases(Values(*found, ClockFormat::kMonthDayYear))) {
        clock_.doubts.push_back("the dates may also have the month first (mm/dd/yyyy)");
      }
    } else {
      const std::string unit = ClockUnit(*found, values.front(), step, epoch);
      unit_s = base::FindUnit(unit)->factor;
      if (unit != "s") clock_.time["unit"] = unit;
    }
    clock_.rate_hz = 1 / (step * unit_s);
    if (clock_.rate_hz < kLeastRate_hz || clock_.rate_hz > kMostRate_hz) {
      clock_.doubts.push_back(fmt::format(
          "a rate of {:.4g} rows per second is unusual: is the unit of the clock right?",
          clock_.rate_hz));
    }
    const bool has_date = format && *format != ClockFormat::kTimeOfDay;
    // A log may begin with its first step, or before a trigger at 0.
    if (has_date || (!epoch && values.front() <= 2 * step)) return std::move(clock_);
    clock_.time["zero"] = "first";
    if (epoch) return std::move(clock_);
    clock_.doubts.push_back(fmt::format(
        "the first time, {:.6g} s, becomes 0 s: remove \"zero\" to keep the times of the log",
        values.front() * unit_s));
    return std::move(clock_);
  }

  void WithoutClock() {
    clock_.time["row_s"] = form_.rate_hz ? 1 / *form_.rate_hz : 1.0;
    clock_.rate_hz = 1 / clock_.time["row_s"].get<double>();
    if (!form_.rate_hz) {
      clock_.doubts.push_back(
          "no column of increasing times was found: set row_s to the time between two rows");
    }
    for (std::size_t i = 0; i < form_.names.size(); ++i) {
      if (Tokens(form_.names[i]) != std::vector<std::string>{"frame"}) continue;
      const std::vector<double> frames = Values(i, {});
      if (frames.empty() ||
          frames.back() - frames.front() == static_cast<double>(frames.size() - 1))
        continue;
      clock_.doubts.push_back("frames are missing, so times after them are too early");
    }
  }

  /// Returns the unit of a clock. `epoch`: whether it counts from 1970.
  std::string ClockUnit(std::size_t column, double first, double step, bool& epoch) {
    std::string unit = KnownUnit(form_.units[column]);
    if (unit.empty()) unit = UnitInName(form_.names[column]);
    const auto known = base::FindUnit(unit);
    const bool stated = known && known->si == "s";
    for (const auto& range : kEpochs) {
      if (first < range.from || first >= kEpochSpan * range.from) continue;
      epoch = true;
      if (!stated || unit == range.unit) return range.unit;
      clock_.doubts.push_back(
          fmt::format("the clock is stated in {}, but its values are {} since "
                      "1970",
                      unit, range.unit));
    }
    if (stated) return unit;
    unit = step >= 1e5 ? "ns" : step >= 500 ? "us" : step >= 1 ? "ms" : "s";
    if (form_.program.empty()) {
      clock_.doubts.push_back(
          fmt::format("the clock \"{}\" has no unit: its step of {:.4g} suggests {}",
                      form_.names[column], step, unit));
    }
    return unit;
  }

 private:
  const LogForm& form_;
  LogClock clock_;
};

}  // namespace

LogClock GuessClock(const LogForm& form) { return ClockGuess(form).Run(); }

}  // namespace taut
