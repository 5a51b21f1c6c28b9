#include "plant/channels.h"

namespace taut::plant {

void AddMotionChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const auto& motions = experiment.robot.def.motions;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    recorder.Add("motion/" + motions[i].name + "/",
                 {{"slide_m", "m"},
                  {"slide_rate_m_per_s", "m/s"},
                  {"turn_rad", "rad"},
                  {"turn_rate_rad_per_s", "rad/s"},
                  {"force_x_n", "N"},
                  {"force_y_n", "N"},
                  {"force_z_n", "N"},
                  {"torque_x_n_m", "N m"},
                  {"torque_y_n_m", "N m"},
                  {"torque_z_n_m", "N m"},
                  {"work_j", "J"}},
                 [motion = static_cast<int>(i)](const RecordSource& s, double* out) {
                   const MotionState now = s.world->Motion(s.lane, motion);
                   out[0] = now.slide_m;
                   out[1] = now.slide_rate_m_per_s;
                   out[2] = now.turn_rad;
                   out[3] = now.turn_rate_rad_per_s;
                   Put(now.force_n, out + 4);
                   Put(now.torque_n_m, out + 7);
                   out[10] = now.work_j;
                 });
  }
}

}  // namespace taut::plant
