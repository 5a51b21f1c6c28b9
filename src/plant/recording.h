/// Recording of a running experiment: appends rows to traces at `record.rate_hz`.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "plant/loop.h"
#include "plant/recorder.h"

namespace taut::plant {

/// Returns the sources of a lane's current row.
inline RecordSource SourceOf(const Loop& loop, int lane = 0) {
  return {&loop.exact(),        &loop.seen(),         &loop.commands(),
          loop.plant().world(), &loop.timeline(lane), lane};
}

/// Recording of one lane.
class Recording {
 public:
  /// `from_s`: time of the first row.
  Recording(const ExperimentSpec& experiment, std::vector<TraceWriter*> writers, double from_s = 0)
      : experiment_(experiment), writers_(std::move(writers)), from_s_(from_s) {}

  /// Returns whether a row is due. Recording does not affect step lengths.
  bool IsDue(double time_s) const {
    const double rate_hz = experiment_.record.rate_hz;
    return rate_hz <= 0 || time_s >= from_s_ + static_cast<double>(rows_) / rate_hz - 1e-9 ||
           (time_s >= experiment_.duration_s && !has_end_);
  }

  /// Appends a row. Returns the writer that failed; null if none.
  const TraceWriter* Append(double time_s, const std::vector<double>& row) {
    ++rows_;
    has_end_ = time_s >= experiment_.duration_s;
    for (TraceWriter* writer : writers_) {
      if (!writer->Append(time_s, row.data())) return writer;
    }
    return nullptr;
  }
  /// Flushes rows that have been in memory longer than `TraceWriter::FlushOld` permits. Returns the
  /// writer that failed; null if none.
  const TraceWriter* FlushOld() {
    for (TraceWriter* writer : writers_) {
      if (!writer->FlushOld()) return writer;
    }
    return nullptr;
  }

  std::int64_t rows() const noexcept { return rows_; }
  const std::vector<TraceWriter*>& writers() const noexcept { return writers_; }

 private:
  const ExperimentSpec& experiment_;
  std::vector<TraceWriter*> writers_;
  double from_s_;
  std::int64_t rows_ = 0;
  bool has_end_ = false;  ///< Whether the row at the end of the experiment was appended.
};

}  // namespace taut::plant
