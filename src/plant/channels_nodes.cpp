#include "plant/channels.h"

namespace taut::plant {

void AddNodeChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const auto& nodes = experiment.robot.def.nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    recorder.Add("node/" + nodes[n].name + "/",
                 {{"position_x_m", "m"},
                  {"position_y_m", "m"},
                  {"position_z_m", "m"},
                  {"velocity_x_m_per_s", "m/s"},
                  {"velocity_y_m_per_s", "m/s"},
                  {"velocity_z_m_per_s", "m/s"}},
                 [node = static_cast<int>(n)](const RecordSource& s, double* out) {
                   Put(s.exact->bodies->NodePosition(s.lane, node), out);
                   Put(s.exact->bodies->NodeVelocity(s.lane, node), out + 3);
                 });
  }
}

}  // namespace taut::plant
