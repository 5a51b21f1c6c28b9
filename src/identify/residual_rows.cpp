#include "identify/residual_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/pattern.h"
#include "compare/gaps.h"
#include "compare/orientation.h"
#include "compare/wrapped_angle.h"
#include "report/reference.h"

namespace taut::identify {
namespace {

/// Time window on both clocks, of the data and of the experiment.
struct Window {
  std::string where;
  double data_from_s = 0, data_to_s = 0;
  double from_s = 0, to_s = 0;  ///< Times on the experiment's clock if the data had no delay.
  std::size_t number = 0;
  double moment_s = 0;  ///< Time of the window's set point on the experiment's clock.
};

std::vector<Window> Windows(const FitSpec& spec, const FitResidual& residual,
                            std::size_t experiment, const Measured* measured) {
  const FitExperiment& one = spec.experiments[experiment];
  const double late_s = StartDelay(spec, experiment), duration_s = one.experiment.duration_s;
  std::vector<Window> out;
  if (residual.after_setpoint_s) {
    const std::vector<double> ours = measured ? measured->ours_s : SetPoints(one.experiment);
    const std::vector<double>& theirs = measured ? measured->setpoint_s : ours;
    const auto [after_s, until_s] = *residual.after_setpoint_s;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      out.push_back({fmt::format("set point {}", i + 1), theirs[i] + after_s, theirs[i] + until_s,
                     ours[i] + after_s, ours[i] + until_s, i, ours[i]});
    }
    return out;
  }
  Window window{"all", late_s, duration_s + late_s, late_s, duration_s + late_s, 0, 0};
  std::optional<std::pair<double, double>> span = residual.span_s;
  if (span) window.where = fmt::format("{:g}..{:g} s", span->first, span->second);
  if (residual.phase) {
    for (const PhaseSpec& phase : one.experiment.phases) {
      if (phase.name == *residual.phase) span = {phase.from_s, phase.to_s};
    }
    window.where = *residual.phase;
  }
  if (span) {
    window.from_s = window.data_from_s = span->first + late_s;
    window.to_s = window.data_to_s = span->second + late_s;
  }
  if (!span && measured) {
    const std::vector<double>& times = measured->trace.time_s;
    window.from_s = window.data_from_s = std::max(window.data_from_s, times.front());
    window.to_s = window.data_to_s = std::min(window.data_to_s, times.back());
  }
  return {window};
}

/// Data of one channel.
struct Column {
  const std::vector<double>* values = nullptr;
  /// All four components if the channel belongs to a quaternion, otherwise null.
  std::array<const std::vector<double>*, 4> quaternion{};

  bool HasQuaternion() const { return quaternion[0] != nullptr; }
  std::array<double, 4> QuaternionAt(std::size_t row) const {
    return {(*quaternion[0])[row], (*quaternion[1])[row], (*quaternion[2])[row],
            (*quaternion[3])[row]};
  }
  /// Returns whether a row is finite, including all components of its quaternion.
  bool Finite(std::size_t row) const {
    if (!std::isfinite((*values)[row])) return false;
    if (!HasQuaternion()) return true;
    const auto q = QuaternionAt(row);
    return std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
  }
};

/// Returns the indices of the finite data rows in a window.
std::vector<std::size_t> Inside(const Measured& measured, const Window& window,
                                const Column& column) {
  std::vector<std::size_t> out;
  const std::vector<double>& times = measured.trace.time_s;
  const auto first = std::lower_bound(times.begin(), times.end(), window.data_from_s - 1e-9);
  for (auto t = first; t != times.end() && *t <= window.data_to_s + 1e-9; ++t) {
    const auto row = static_cast<std::size_t>(t - times.begin());
    if (column.Finite(row)) out.push_back(row);
  }
  return out;
}

/// Returns the statistic of the rows. The mean is weighted by the duration of each row.
double Of(FitStatistic statistic, const std::vector<double>& values,
          const std::vector<std::size_t>& rows, const std::vector<double>& weights) {
  std::vector<double> inside;
  for (const std::size_t row : rows) inside.push_back(values[row]);
  if (statistic == FitStatistic::kMax) return *std::max_element(inside.begin(), inside.end());
  if (statistic == FitStatistic::kMin) return *std::min_element(inside.begin(), inside.end());
  return compare::WeightedMean(inside, weights);
}

Row::How HowOf(FitStatistic statistic) {
  if (statistic == FitStatistic::kMax) return Row::How::kMax;
  return statistic == FitStatistic::kMin ? Row::How::kMin : Row::How::kMean;
}

/// Builds the rows of one residual for one experiment.
class Maker {
 public:
  Maker(const FitSpec& spec, const FitResidual& residual, std::size_t experiment,
        const Measured* measured)
      : residual_(residual),
        one_(spec.experiments[experiment]),
        experiment_(experiment),
        measured_(measured),
        windows_(Windows(spec, residual, experiment, measured)),
        late_s_(StartDelay(spec, experiment)) {}

  /// Adds the rows of a channel. `column`: measured data; null for a design.
  void Channel(const ChannelInfo& channel, const Column* column) {
    if (one_.forward == FitForward::kLoadCases) {
      for (std::size_t i = 0; i < one_.experiment.load_cases.size(); ++i) {
        if (column && !column->Finite(i)) continue;
        Row row = Begin(channel, "load case " + one_.experiment.load_cases[i].name, i);
        if (column && column->HasQuaternion()) row.orientation = column->QuaternionAt(i);
        row.row = i;
        row.point.time_s = static_cast<double>(i + 1);
        Add(std::move(row), column ? (*column->values)[i] : 0.0);
      }
      return;
    }
    for (const Window& window : windows_) {
      ++asked;
      if (one_.forward == FitForward::kDynamic && Beyond(window)) continue;
      std::vector<std::size_t> inside;
      if (column) {
        inside = Inside(*measured_, window, *column);
        if (inside.empty()) continue;
      }
      ++met;
      OfWindow(channel, window, column, inside);
    }
  }
  std::vector<Row> rows;
  std::size_t asked = 0, met = 0;  ///< Number of windows, and of those with data.

 private:
  bool Beyond(const Window& window) const {
    return window.from_s - late_s_ < -1e-9 || window.to_s < window.from_s ||
           window.to_s - late_s_ > one_.experiment.duration_s + 1e-9;
  }
  Row Begin(const ChannelInfo& channel, const std::string& where, std::size_t window) const {
    Row row;
    row.experiment = row.point.experiment = experiment_;
    row.channel = row.point.channel = channel.name;
    row.point.unit = channel.unit;
    row.period = channel.period;
    row.point.where = where;
    row.window = window;
    return row;
  }
  void Add(Row row, double measured) {
    row.point.measured = measured;
    row.point.sd = std::max(residual_.sd, residual_.relative_sd * std::fabs(measured));
    rows.push_back(std::move(row));
  }
  /// Returns the time of a data row on the experiment's clock if the data had no delay [s].
  double TimeOf(const Window& window, std::size_t row) const {
    return measured_->trace.time_s[row] - window.data_from_s + window.from_s;
  }
  Samples SamplesOf(const Window& window, const Column& column, double period,
                    const std::vector<std::size_t>& inside) const {
    Samples samples;
    for (const std::size_t i : inside) {
      samples.time_s.push_back(TimeOf(window, i));
      if (column.HasQuaternion()) samples.orientation.push_back(column.QuaternionAt(i));
      if (period > 0) samples.measured.push_back((*column.values)[i]);
    }
    samples.weight = compare::TimeWeights(samples.time_s, compare::FindGaps(samples.time_s));
    return samples;
  }
  void OfStatistic(Row row, const Column* column, const std::vector<std::size_t>& inside,
                   const Window& window) {
    const bool rest = one_.forward == FitForward::kStatic;
    row.how = rest ? Row::How::kRest : HowOf(residual_.statistic);
    if (rest) row.from_s = row.point.time_s = window.moment_s;
    if (!column) return Add(std::move(row), 0.0);
    auto samples = std::make_shared<Samples>(SamplesOf(window, *column, row.period, inside));
    const double measured = Of(residual_.statistic, *column->values, inside, samples->weight);
    if (rest && column->HasQuaternion()) {
      auto& sum = row.orientation.emplace();
      for (std::size_t k = 0; k < 4; ++k) {
        sum[k] = Of(FitStatistic::kMean, *column->quaternion[k], inside, samples->weight);
      }
    }
    if (!rest) row.samples = std::move(samples);
    Add(std::move(row), measured);
  }
  void OfWindow(const ChannelInfo& channel, const Window& window, const Column* column,
                const std::vector<std::size_t>& inside) {
    Row row = Begin(channel, window.where, window.number);
    row.from_s = window.from_s, row.to_s = window.to_s;
    row.point.time_s = 0.5 * (window.from_s + window.to_s) - late_s_;
    if (residual_.statistic != FitStatistic::kRows) {
      return OfStatistic(std::move(row), column, inside, window);
    }
    const bool rest = one_.forward == FitForward::kStatic;
    for (const std::size_t i : inside) {
      Row each = row;
      each.how = rest ? Row::How::kRest : Row::How::kAt;
      each.from_s = each.to_s = TimeOf(window, i);
      each.point.time_s = each.from_s - late_s_;
      if (rest) each.from_s = window.moment_s;
      each.point.where = fmt::format("at {:g} s", each.point.time_s);
      if (column->HasQuaternion()) each.orientation = column->QuaternionAt(i);
      Add(std::move(each), (*column->values)[i]);
    }
  }

  const FitResidual& residual_;
  const FitExperiment& one_;
  std::size_t experiment_;
  const Measured* measured_;
  std::vector<Window> windows_;
  double late_s_;
};

std::vector<Row> OfReferences(const FitExperiment& one, const FitResidual& residual,
                              std::size_t experiment) {
  std::vector<Row> out;
  const auto& references = one.experiment.references;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const ReferenceSpec& reference = references[i];
    if (residual.references && reference.statistic != *residual.references) continue;
    for (std::size_t v = 0; v < reference.values.size(); ++v) {
      const ReferenceSpec::Value& value = reference.values[v];
      Row& row = out.emplace_back();
      row.how = Row::How::kReference;
      row.experiment = row.point.experiment = experiment;
      row.reference = i;
      row.value = v;
      const std::string& cable =
          one.experiment.robot.def.cables[static_cast<std::size_t>(value.cable)].name;
      row.channel = "cable/" + cable + "/" + report::QuantityName(reference) + "_n";
      row.point.channel = row.channel;
      row.point.unit = "N";
      row.point.where = report::StatisticName(reference) + " of " +
                        (reference.phase.empty() ? "the run" : reference.phase);
      row.point.measured = value.force_n;
      row.point.sd = std::max(residual.sd, residual.relative_sd * std::fabs(value.force_n));
    }
  }
  return out;
}

Column ColumnOf(const Trace& trace, std::size_t channel) {
  Column column{&trace.values[channel], {}};
  const auto names = compare::QuaternionNames(trace.channels[channel].name);
  std::array<const std::vector<double>*, 4> found{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = trace.Find(names[i]);
    if (!at) return column;
    found[i] = &trace.values[*at];
  }
  column.quaternion = found;
  return column;
}

std::vector<std::string> Names(const std::vector<ChannelInfo>& channels) {
  std::vector<std::string> out;
  for (const ChannelInfo& channel : channels) out.push_back(channel.name);
  return out;
}

/// Suggests the closest name. Otherwise lists the first four, since the full list would be too
/// long.
std::string Hint(const std::string& name, const std::vector<ChannelInfo>& channels) {
  const auto names = Names(channels);
  const std::string_view close = ClosestMatch(name, names);
  if (!close.empty()) return "did you mean \"" + std::string(close) + "\"?";
  std::string hint = "expected";
  for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 4); ++i) {
    hint += (i == 0 ? " " : ", ") + names[i];
  }
  return names.empty() ? "there are no channels" : names.size() > 4 ? hint + ", ..." : hint;
}

void WarnOfWrap(const Measured& measured, std::size_t channel, const FitExperiment& one,
                const FitResidual& residual, Diagnostics& out) {
  const Trace& trace = measured.trace;
  const auto row = compare::FindWrap(trace.channels[channel], trace.values[channel]);
  if (!row) return;
  out.Warning(
      "residual.angle_jumps", residual.at,
      fmt::format("residuals: {} in the data of {} jumps by a turn at {:g} s",
                  trace.channels[channel].name, one.name, trace.time_s[*row]),
      "if the angle wraps, add \"wrap\": \"turn\" to the rule of this channel in the mapping "
      "file given by `map`");
}

}  // namespace

double StartDelay(const FitSpec& spec, std::size_t experiment) {
  for (const FitEstimate& e : spec.estimates) {
    if (e.kind != FitEstimate::Kind::kDelay) continue;
    if (std::find(e.experiments.begin(), e.experiments.end(), experiment) != e.experiments.end()) {
      return e.range.start;
    }
  }
  return 0.0;
}

std::vector<Row> MakeRows(const FitSpec& spec, const FitResidual& residual, std::size_t experiment,
                          const Measured* measured, const std::vector<ChannelInfo>& channels,
                          Diagnostics& out) {
  const FitExperiment& one = spec.experiments[experiment];
  if (residual.channels.empty()) return OfReferences(one, residual, experiment);
  Maker maker(spec, residual, experiment, measured);
  const std::vector<ChannelInfo>& offered = measured ? measured->trace.channels : channels;
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    out.Error("residual.bad_channels", residual.at, "residuals: " + what, hint);
  };
  bool any = false, good = true;
  std::set<std::string> sign_unknown;
  for (std::size_t c = 0; c < offered.size(); ++c) {
    if (!base::Fits(residual.channels, offered[c].name)) continue;
    any = true;
    const auto ours = std::find_if(channels.begin(), channels.end(),
                                   [&](const ChannelInfo& x) { return x.name == offered[c].name; });
    if (ours == channels.end()) {
      wrong("there is no computed channel \"" + offered[c].name + "\" of " + one.name,
            Hint(offered[c].name, channels));
      good = false;
    } else if (ours->unit != offered[c].unit) {
      wrong(fmt::format("\"{}\" of {} is in {} in the data, but computed in {}", offered[c].name,
                        one.name, offered[c].unit, ours->unit),
            "convert it by `unit` and `scale` of a mapping");
      good = false;
    } else {
      if (!measured) {
        maker.Channel(offered[c], nullptr);
        continue;
      }
      WarnOfWrap(*measured, c, one, residual, out);
      const Column column = ColumnOf(measured->trace, c);
      const auto names = compare::QuaternionNames(offered[c].name);
      if (!names.empty() && !column.HasQuaternion() && sign_unknown.insert(names[0]).second) {
        const std::string all = names[0].substr(0, names[0].size() - 1) + "{w,x,y,z}";
        out.Warning("residual.partial_quaternion", residual.at,
                    fmt::format("residuals: the data of {} have only some of {}, so their sign "
                                "cannot be aligned with that of the run",
                                one.name, all),
                    "q and -q are the same orientation: record all four components");
      }
      maker.Channel(offered[c], &column);
    }
  }
  if (!any) {
    wrong("the data of " + one.name + " have no channel \"" + residual.channels + "\"",
          Hint(residual.channels, offered) + "; `map` can translate names");
  } else if (good && maker.rows.empty()) {
    const std::string of_data =
        measured ? fmt::format("the data of {} cover {:g}..{:g} s", one.name,
                               measured->trace.time_s.front(), measured->trace.time_s.back())
                 : one.name;
    wrong(
        fmt::format("no window of \"{}\" contains data of {}", residual.channels, one.name),
        fmt::format("{}, the experiment 0..{:g} s; if their clocks differ, relate them by `clock`, "
                    "`setpoints` or `window`",
                    of_data, one.experiment.duration_s));
  } else if (good && maker.met < maker.asked) {
    out.Warning("residual.windows_without_data", residual.at,
                fmt::format("residuals: {} of {} windows of \"{}\" have no data in {}",
                            maker.asked - maker.met, maker.asked, residual.channels, one.name));
  }
  return std::move(maker.rows);
}

}  // namespace taut::identify
