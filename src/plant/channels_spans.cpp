#include "plant/channels.h"

namespace taut::plant {

void AddSpanChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const auto& cables = experiment.robot.def.cables;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    int slips = 0, wheels = 0;
    for (const AttachmentDef& at : cables[c].attachments) {
      slips += at.friction > 0;
      wheels += at.wheel.has_value();
    }
    const std::string prefix = "cable/" + cables[c].name + "/";
    const int cable = static_cast<int>(c);
    for (int i = 0; i < wheels; ++i) {
      recorder.Add(
          prefix, {{"wheel_" + std::to_string(i + 1) + "_angle_rad", "rad"}},
          [=](const RecordSource& s, double* out) { *out = s.world->WheelAngle(0, cable, i); });
    }
    if (slips == 0) continue;
    for (int i = 0; i <= slips; ++i) {
      recorder.Add(prefix, {{"span_" + std::to_string(i + 1) + "_tension_n", "N"}},
                   [=](const RecordSource& s, double* out) {
                     *out = s.world->CableSpan(0, cable, i).tension_n;
                   });
    }
    recorder.Add(prefix, {{"friction_loss_j", "J"}}, [=](const RecordSource& s, double* out) {
      *out = s.world->CableFrictionLoss(0, cable);
    });
  }
}

}  // namespace taut::plant
