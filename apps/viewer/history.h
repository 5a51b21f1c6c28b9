/// What a live run has shown so far, for plots of the time before a page came and for a look back.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "frame.h"
#include "node_channels.h"
#include "scene.h"

namespace taut::viewer {

/// Rows of equal distance in simulated time. When there are too many, every second one goes and
/// the distance doubles: the whole run stays, more coarsely the longer it lasts.
class History {
 public:
  static constexpr std::size_t kMaxBytes = 128u << 20;

  /// `period_s`: simulated time between rows, for a start. `has_set_point`: by cable. `recorded`:
  /// the channels of the rows that `Take` gets; kept are those that frames do not have.
  History(const ModelDef& def, const std::vector<bool>& has_set_point, double period_s,
          const std::vector<ChannelInfo>& recorded = {}, std::size_t max_bytes = kMaxBytes);

  /// Of the run that begins now.
  void Clear();
  /// Whether the moment is far enough from the last one taken.
  bool IsDue(double time_s) const { return time_s >= due_s_; }
  /// Times rise. `row`: of the recorded channels at that time.
  void Take(const Frame& frame, const std::vector<double>& row = {});

  std::size_t size() const { return time_s_.size(); }
  double time_s(std::size_t row) const { return time_s_[row]; }
  /// The last row at or before a time; 0 before the first.
  std::size_t RowAt(double time_s) const;
  /// The row to look at for a time that is past: nothing where `now_s`, the present, is meant.
  std::optional<std::size_t> PastRow(double time_s, double now_s) const;
  /// So many rows on from a row, or from the present (nothing); nothing: that is the present.
  std::optional<std::size_t> Step(std::optional<std::size_t> row, int count, double now_s) const;
  /// Of `frame` stays what is no history: speed, pause, driver.
  void Show(std::size_t row, Frame& frame) const;
  /// Of the recorded channels, as `Take` got it.
  std::vector<double> Row(std::size_t row) const;

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// SeriesData of a channel; null if there is none.
  Json SeriesOf(const std::string& channel, double t0, double t1, std::size_t points) const;

 private:
  /// Lists of any length, one a row.
  template <class T>
  struct Lists {
    std::vector<T> items;
    std::vector<std::size_t> ends;
    void Add(const std::vector<T>& list);
    std::vector<T> Get(std::size_t row) const;
    void Thin();
    std::size_t bytes() const { return items.size() * sizeof(T) + ends.size() * sizeof(ends[0]); }
  };

  /// The row that the present is, or would be.
  std::size_t PresentRow(double now_s) const;
  void AddColumn(std::string name, std::string unit, bool is_channel = true);
  void Thin();

  std::vector<ChannelInfo> channels_;
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t bodies_, cables_, max_bytes_;
  double first_period_s_, period_s_, due_s_ = 0;
  std::vector<double> time_s_;
  /// All that a frame holds, channel or not; then the recorded channels at `recorded_` of a row.
  std::vector<std::vector<double>> columns_;
  std::vector<std::size_t> recorded_, columns_of_row_;
  NodeChannels nodes_;
  Lists<Frame::Contact> contacts_;
  Lists<OutsideForce> pushes_;
  Lists<Frame::Bend> bends_;
  Lists<Frame::Span> spans_;
};

}  // namespace taut::viewer
