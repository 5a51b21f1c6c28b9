/// Past states of a live run, for pages opened later and for looking back.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "frame.h"
#include "node_channels.h"
#include "scene.h"

namespace taut::viewer {

/// Rows at equal intervals of simulated time. When memory is full, every second row is removed and
/// the interval doubles: all times stay covered, at a lower resolution.
class History {
 public:
  static constexpr std::size_t kMaxBytes = 128u << 20;

  /// `period_s`: initial simulated time between rows. `has_set_point`: per cable. `recorded`:
  /// channels of the rows passed to `Take`; only those missing in frames are stored.
  History(const ModelDef& def, const std::vector<bool>& has_set_point, double period_s,
          const std::vector<ChannelInfo>& recorded = {}, std::size_t max_bytes = kMaxBytes);

  /// Removes all rows, for a new run.
  void Clear();
  /// Returns whether the interval since the last row has passed.
  bool IsDue(double time_s) const { return time_s >= due_s_; }
  /// Adds a row; times must increase. `row`: the recorded channels at this time.
  void Take(const Frame& frame, const std::vector<double>& row = {});

  std::size_t size() const { return time_s_.size(); }
  double time_s(std::size_t row) const { return time_s_[row]; }
  /// Returns the last row at or before a time; 0 before the first.
  std::size_t RowAt(double time_s) const;
  /// Returns the row for a past time; nothing if the time is the present, `now_s`.
  std::optional<std::size_t> PastRow(double time_s, double now_s) const;
  /// Returns the row `count` rows after `row`. An empty optional means the present, as argument and
  /// as result.
  std::optional<std::size_t> Step(std::optional<std::size_t> row, int count, double now_s) const;
  /// Sets the state of `frame` to a row, but not its speed, pause and driver.
  void Show(std::size_t row, Frame& frame) const;
  /// Returns the recorded channels of a row, as passed to `Take`.
  std::vector<double> Row(std::size_t row) const;

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// Returns the SeriesData of a channel; null if it does not exist.
  Json SeriesOf(const std::string& channel, double t0, double t1, std::size_t points) const;

 private:
  /// Lists of variable length, one per row.
  template <class T>
  struct Lists {
    std::vector<T> items;
    std::vector<std::size_t> ends;
    void Add(const std::vector<T>& list);
    std::vector<T> Get(std::size_t row) const;
    void Thin();
    std::size_t bytes() const { return items.size() * sizeof(T) + ends.size() * sizeof(ends[0]); }
  };

  /// Returns the index of the present in the rows, whether or not it is stored.
  std::size_t PresentRow(double now_s) const;
  void AddColumn(std::string name, std::string unit, bool is_channel = true);
  void Thin();

  std::vector<ChannelInfo> channels_;
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t bodies_, cables_, max_bytes_;
  double first_period_s_, period_s_, due_s_ = 0;
  std::vector<double> time_s_;
  /// One value per stored row in each column. First the values of a Frame (some are not channels),
  /// then the recorded channels that a Frame lacks; `recorded_` contains their indices in the
  /// argument `row` of Take.
  std::vector<std::vector<double>> columns_;
  std::vector<std::size_t> recorded_, columns_of_row_;
  NodeChannels nodes_;
  Lists<Frame::Contact> contacts_;
  Lists<ExternalForce> pushes_;
  Lists<Frame::Bend> bends_;
  Lists<Frame::Span> spans_;
};

}  // namespace taut::viewer
