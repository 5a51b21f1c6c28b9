#include "trace/clock_text.h"

#include <charconv>
#include <chrono>
#include <string>

#include "base/number_text.h"

namespace taut::trace {
namespace {

constexpr double kMinute_s = 60, kHour_s = 3600;

/// Reads a text from left to right; after the first mismatch, all further reads fail.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  /// Reads a whole number of `least` to `most` digits.
  int Whole(std::size_t least, std::size_t most) {
    std::size_t digits = 0;
    int value = 0;
    while (digits < most && digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9') {
      value = 10 * value + (rest_[digits++] - '0');
    }
    good_ = good_ && digits >= least;
    rest_.remove_prefix(digits);
    return value;
  }

  bool Take(char mark) {
    if (rest_.empty() || rest_.front() != mark) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void Expect(char mark) { good_ = Take(mark) && good_; }
  bool TakeAny(std::string_view marks) {
    for (const char mark : marks) {
      if (Take(mark)) return true;
    }
    return false;
  }
  void Fail() { good_ = false; }

  /// Reads a fraction of a second after the whole seconds: ".25" or ",25"; 0 if there is none.
  double Fraction() {
    if (rest_.empty() || (rest_.front() != '.' && rest_.front() != ',')) return 0.0;
    std::string text = "0.";
    std::size_t at = 1;
    while (at < rest_.size() && rest_[at] >= '0' && rest_[at] <= '9') text += rest_[at++];
    double value = 0;
    base::FromChars(text.data(), text.data() + text.size(), value);
    good_ = good_ && at > 1;
    rest_.remove_prefix(at);
    return value;
  }

  bool empty() const { return rest_.empty(); }
  bool good() const { return good_; }

 private:
  std::string_view rest_;
  bool good_ = true;
};

/// Reads hh:mm:ss with a fraction; after a date also hh:mm, which alone could be mm:ss.
double TimeOfDay(Reader& in, bool after_date) {
  const int hours = in.Whole(1, 2);
  in.Expect(':');
  const int minutes = in.Whole(2, 2);
  double seconds = 0;
  if (in.Take(':')) {
    seconds = in.Whole(2, 2) + in.Fraction();
  } else if (!after_date) {
    in.Fail();
  }
  if (hours > 24 || minutes > 59 || seconds >= 61) in.Fail();
  return kHour_s * hours + kMinute_s * minutes + seconds;
}

double Date(Reader& in, int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) {
    in.Fail();
    return 0;
  }
  return kDay_s * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Reads "Z", "+01:00", "-0500" or nothing. Returns the seconds east of Greenwich.
double Zone(Reader& in) {
  if (in.empty() || in.Take('Z')) return 0;
  const bool east = in.Take('+');
  if (!east) in.Expect('-');
  const double hours = in.Whole(2, 2);
  in.Take(':');
  const double minutes = in.empty() ? 0 : in.Whole(2, 2);
  return (east ? 1 : -1) * (kHour_s * hours + kMinute_s * minutes);
}

}  // namespace

std::optional<double> ParseClock(std::string_view text, ClockFormat format) {
  Reader in(text);
  double time_s = 0;
  switch (format) {
    case ClockFormat::kNumber:
      return std::nullopt;
    case ClockFormat::kTimeOfDay:
      time_s = TimeOfDay(in, false);
      break;
    case ClockFormat::kIso8601: {
      const int year = in.Whole(4, 4);
      const bool dashes = in.Take('-');
      const int month = in.Whole(2, 2);
      if (dashes) in.Expect('-');
      const int day = in.Whole(2, 2);
      time_s = Date(in, year, month, day);
      if (!in.TakeAny("T ")) in.Fail();
      time_s += TimeOfDay(in, true);
      time_s -= Zone(in);
      break;
    }
    case ClockFormat::kDayMonthYear:
    case ClockFormat::kMonthDayYear: {
      const int first = in.Whole(1, 2);
      if (!in.TakeAny("./-")) in.Fail();
      const int second = in.Whole(1, 2);
      if (!in.TakeAny("./-")) in.Fail();
      const int year = in.Whole(4, 4);
      const bool day_first = format == ClockFormat::kDayMonthYear;
      time_s = Date(in, year, day_first ? second : first, day_first ? first : second);
      in.Take(',');
      while (in.Take(' ')) {
      }
      time_s += TimeOfDay(in, true);
      break;
    }
  }
  if (!in.good() || !in.empty()) return std::nullopt;
  return time_s;
}

}  // namespace taut::trace

namespace taut {

std::string_view ClockFormatName(ClockFormat format) {
  switch (format) {
    case ClockFormat::kTimeOfDay:
      return "hh:mm:ss";
    case ClockFormat::kIso8601:
      return "iso8601";
    case ClockFormat::kDayMonthYear:
      return "dd.mm.yyyy hh:mm:ss";
    case ClockFormat::kMonthDayYear:
      return "mm/dd/yyyy hh:mm:ss";
    case ClockFormat::kNumber:
      break;
  }
  return "number";
}

}  // namespace taut
