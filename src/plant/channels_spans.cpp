#include <algorithm>
#include <limits>

#include "math/vec.h"
#include "plant/channels.h"

namespace taut::plant {
namespace {

/// Adds the bend points of a wrapping cable (the middle of each arc).
void AddBendChannels(const std::string& prefix, int cable, Recorder& recorder) {
  std::vector<ChannelInfo> names{{"bends", "1"}};
  for (int i = 1; i <= CableDef::kMostBends; ++i) {
    const std::string bend = "bend_" + std::to_string(i) + "_";
    for (const char* axis : {"x_m", "y_m", "z_m"}) names.push_back({bend + axis, "m"});
  }
  recorder.Add(prefix, names, [=](const RecordSource& s, double* out) {
    const std::vector<Vec3> bends = s.world->CableBendPlaces(s.lane, cable);
    *out++ = static_cast<double>(bends.size());
    std::fill_n(out, 3 * CableDef::kMostBends, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < bends.size(); ++i) Put(bends[i], out + 3 * i);
  });
}

}  // namespace

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
      recorder.Add(prefix, {{"wheel_" + std::to_string(i + 1) + "_angle_rad", "rad"}},
                   [=](const RecordSource& s, double* out) {
                     *out = s.world->WheelAngle(s.lane, cable, i);
                   });
    }
    if (cables[c].touches != CableTouches::kNone) AddBendChannels(prefix, cable, recorder);
    if (wheels > 0 || cables[c].touches != CableTouches::kNone) {
      recorder.Add(prefix, {{"wrap_rad", "rad"}}, [=](const RecordSource& s, double* out) {
        *out = s.world->CableWrap(s.lane, cable);
      });
    }
    if (cables[c].touch_friction > 0) slips = CableDef::kMostBends;
    if (slips == 0) continue;
    std::vector<ChannelInfo> spans;
    for (int i = 0; i <= slips; ++i) {
      spans.push_back({"span_" + std::to_string(i + 1) + "_tension_n", "N"});
    }
    recorder.Add(prefix, spans, [=](const RecordSource& s, double* out) {
      const std::vector<double> tensions = s.world->CableSpanTensions(s.lane, cable);
      std::fill_n(std::copy(tensions.begin(), tensions.end(), out),
                  slips + 1 - static_cast<int>(tensions.size()),
                  std::numeric_limits<double>::quiet_NaN());
    });
    recorder.Add(prefix, {{"friction_loss_j", "J"}}, [=](const RecordSource& s, double* out) {
      *out = s.world->CableFrictionLoss(s.lane, cable);
    });
  }
}

}  // namespace taut::plant
