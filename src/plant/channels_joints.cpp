#include "plant/channels.h"

namespace taut::plant {

void AddJointChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const auto& joints = experiment.robot.def.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const bool angle = IsAngle(joints[j].kind);
    recorder.Add("joint/" + joints[j].name + "/",
                 {{angle ? "angle_rad" : "position_m", angle ? "rad" : "m"},
                  {angle ? "rate_rad_per_s" : "rate_m_per_s", angle ? "rad/s" : "m/s"},
                  {"force_x_n", "N"},
                  {"force_y_n", "N"},
                  {"force_z_n", "N"},
                  {"torque_x_n_m", "N m"},
                  {"torque_y_n_m", "N m"},
                  {"torque_z_n_m", "N m"}},
                 [joint = static_cast<int>(j)](const RecordSource& s, double* out) {
                   const JointState now = s.world->Joint(s.lane, joint);
                   out[0] = now.coordinate;
                   out[1] = now.rate;
                   Put(now.force_n, out + 2);
                   Put(now.torque_n_m, out + 5);
                 });
  }
}

}  // namespace taut::plant
