#include "apps/virtual_robot/stand.h"

#include <utility>

namespace taut::virtual_robot {

Stand::Stand(MotorPlant& plant, const Robot& robot, LogSink log)
    : plant_(plant), robot_(robot), log_(std::move(log)) {
  plant_.SetHeld(true);
}

bool Stand::AllDriversOn() const {
  for (int motor = 0; motor < plant_.motor_count(); ++motor) {
    if (!robot_.Drive(motor).enabled) return false;
  }
  return true;
}

void Stand::Step(Time now) {
  if (!plant_.held()) return;
  if (!AllDriversOn()) {
    driven_since_ = -1;
    return;
  }
  if (driven_since_ < 0) driven_since_ = now;
  // Keep holding: motor drivers that are on only briefly, as in a self-test, would not hold the
  // robot.
  if (now - driven_since_ < kDrivenFor) return;
  plant_.SetHeld(false);
  if (log_) log_(now, "stand", "released: the drivers of all boards have been on for 0.1 s");
}

}  // namespace taut::virtual_robot
