#include <algorithm>
#include <cmath>

#include "plant/player_kinds.h"
#include "plant/schedule.h"

namespace taut::plant {
namespace {

/// Returns the last row at or before `time_s`. `time_s` must not be before the first row.
std::size_t RowAt(const std::vector<double>& times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s + kTimeToleranceS);
  return static_cast<std::size_t>(after - times_s.begin()) - 1;
}

/// Player of a table's rows, held or interpolated linearly.
class TablePlayer final : public GaitPlayer {
 public:
  explicit TablePlayer(const GaitSetup& setup) : GaitPlayer(setup) {
    for (const GaitSpec* gait : setup.gaits) tables_.push_back(*gait->table);
  }

  void Tick(const GaitTick& tick, const Observation&) override {
    for (int j = 0; j < lanes(); ++j) {
      if (!Has(tick.due, j)) continue;
      const TableGait& table = tables_[static_cast<std::size_t>(j)];
      const double t = TimeIn(table, tick.since_s[j]);
      const std::size_t row = RowAt(table.time_s, t);
      const bool straight = table.linear && row + 1 < table.rows.size();
      const double part =
          straight
              ? std::max(0.0, (t - table.time_s[row]) / (table.time_s[row + 1] - table.time_s[row]))
              : 0.0;
      for (std::size_t i = 0; i < cables().size(); ++i) {
        double& out = signal_[At(i, j)];
        out = table.rows[row][i];
        if (straight) out += part * (table.rows[row + 1][i] - out);
      }
    }
  }

  void Restart(int lane, const GaitSpec& gait) override {
    tables_[static_cast<std::size_t>(lane)] = *gait.table;
  }
  void Retune(int, const GaitSpec&) override {}  // tables have no tunable parameters

 private:
  static double TimeIn(const TableGait& table, double time_s) {
    const double end_s = table.time_s.back();
    if (!table.repeat_from_s || time_s < end_s) return time_s;
    // fmod is exact, so the result has the same bits on all platforms
    const double from_s = *table.repeat_from_s;
    return from_s + std::fmod(time_s - from_s, end_s - from_s);
  }

  std::vector<TableGait> tables_;  ///< One per lane.
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeTable(const GaitSetup& setup) {
  if (!setup.gaits[0]->table) return nullptr;
  return std::make_unique<TablePlayer>(setup);
}

}  // namespace taut::plant
