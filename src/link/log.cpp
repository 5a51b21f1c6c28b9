#include "taut/link/log.h"

#include <nlohmann/json.hpp>

#include "base/assert.h"

namespace taut::link {

std::string EventLine(double time_s, const std::string& who, const std::string& what) {
  return nlohmann::ordered_json{{"time_s", time_s}, {"who", who}, {"what", what}}.dump() + "\n";
}

RobotLog::RobotLog(const std::vector<std::string>& cables) : motors_(cables.size()) {
  for (const std::string& name : cables) {
    const std::string cable = "cable/" + name + "/";
    channels_.push_back({cable + "tension_n", "N"});
    channels_.push_back({cable + "setpoint_n", "N"});
    channels_.push_back({cable + "rest_length_m", "m"});
    channels_.push_back({cable + "length_m", "m"});
    channels_.push_back({cable + "encoder_counts", "1"});
    channels_.push_back({cable + "duty", "1"});
    channels_.push_back({cable + "faults", "1"});
    channels_.push_back({cable + "winding_temperature_c", "degC"});
  }
  for (std::size_t b = 0; b < (motors_ + board::kMotors - 1) / board::kMotors; ++b) {
    const std::string board = "board/" + std::to_string(b) + "/";
    channels_.push_back({board + "mode", "1"});
    channels_.push_back({board + "state", "1"});
    channels_.push_back({board + "faults", "1"});
    channels_.push_back({board + "age_s", "s"});
    channels_.push_back({board + "loop_time_s", "s"});
    channels_.push_back({board + "bad_frames", "1"});
    channels_.push_back({board + "stale_frames", "1"});
    channels_.push_back({board + "bad_messages", "1"});
    channels_.push_back({board + "late_ticks", "1"});
    channels_.push_back({board + "missed_broadcasts", "1"});
    channels_.push_back({board + "bus_recoveries", "1"});
    channels_.push_back({board + "reset_cause", "1"});
  }
  for (const char* const name : {"link/commanded_mode", "link/late_cycles", "link/silent_transfers",
                                 "link/unheard_broadcasts", "link/adapter_resets",
                                 "link/failed_group_reads", "link/reconnections"}) {
    channels_.push_back({name, "1"});
  }
  channels_.push_back({"link/cycle_s", "s"});
  channels_.push_back({"link/lateness_s", "s"});
  row_.resize(channels_.size());
}

const double* RobotLog::Row(const State& state) {
  TAUT_ASSERT(state.motors.size() == motors_);
  double* at = row_.data();
  for (const MotorView& motor : state.motors) {
    *at++ = motor.tension_n;
    *at++ = motor.set_point_n;
    *at++ = motor.rest_length_m;
    *at++ = motor.length_m;
    *at++ = static_cast<double>(motor.encoder_counts);
    *at++ = motor.duty;
    *at++ = motor.faults;
    *at++ = motor.temperature_c;
  }
  for (const BoardView& board : state.boards) {
    const board::Status& status = board.status;
    *at++ = static_cast<double>(status.mode);
    *at++ = (status.referenced ? 1 : 0) + (status.faulty ? 2 : 0) + (status.timeout ? 4 : 0) +
            (status.overrun ? 8 : 0) + (status.was_reset ? 16 : 0) + (board.there ? 0 : 32);
    *at++ = board.faults;
    *at++ = board.heard_s < 0 ? -1 : state.time_s - board.heard_s;
    *at++ = board.loop_time_s;
    *at++ = static_cast<double>(board.bad_frames);
    *at++ = static_cast<double>(board.stale_frames);
    *at++ = board.bad_messages;
    *at++ = board.late_ticks;
    *at++ = board.missed_broadcasts;
    *at++ = board.bus_recoveries;
    *at++ = board.reset_cause;
  }
  const LinkView& link = state.link;
  *at++ = static_cast<double>(state.stopping ? board::Mode::kStopped : state.commanded);
  *at++ = static_cast<double>(link.late_cycles);
  *at++ = static_cast<double>(link.silent_transfers);
  *at++ = static_cast<double>(link.unheard_broadcasts);
  *at++ = static_cast<double>(link.adapter_resets);
  *at++ = static_cast<double>(link.failed_group_reads);
  *at++ = static_cast<double>(link.reconnections);
  *at++ = link.cycle_s;
  *at++ = link.lateness_s;
  TAUT_ASSERT(at == row_.data() + row_.size());
  return row_.data();
}

}  // namespace taut::link
