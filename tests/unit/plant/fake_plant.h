/// Plant without a robot, of one lane, whose observations are set by the test
#pragma once

#include "plant/command_rows.h"
#include "taut/plant.h"

namespace taut::test {

class FakePlant final : public Plant {
 public:
  explicit FakePlant(std::size_t cables)
      : cables_(cables),
        rows_(7 * cables),
        command_rows_(cables, 1),
        commands_(command_rows_.With(rows_.data() + 6 * cables)) {
    const auto row = [&](int i) { return rows_.data() + static_cast<std::ptrdiff_t>(cables) * i; };
    seen_.time_s = &time_s;
    seen_.cables = {row(0), row(1), row(2), row(3), row(4), row(5)};
  }
  /// Sets the readings of every cable.
  void Show(const CableState& state) {
    const double values[] = {state.rest_length_m, state.length_m,  state.rate_m_per_s,
                             state.tension_n,     state.elastic_n, state.stiffness_n_per_m};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t c = 0; c < cables_; ++c) rows_[i * cables_ + c] = values[i];
    }
  }

  const Observation& Observe() override { return seen_; }
  Commands& commands() override { return commands_; }
  void Advance(const double*, const double* to_s) override { time_s = *to_s; }
  void Restart(int) override { time_s = 0; }
  bool IsRunning(int) const override { return true; }

  double time_s = 0;

 private:
  std::size_t cables_;
  std::vector<double> rows_;
  plant::CommandRows command_rows_;
  Commands commands_;
  Observation seen_;
};

}  // namespace taut::test
