#include "plant/recorder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/pattern.h"
#include "math/vec.h"
#include "plant/body_channels.h"
#include "plant/cable_channels.h"
#include "plant/center_of_mass.h"
#include "plant/channels.h"
#include "plant/set_points.h"
#include "taut/run.h"

namespace taut::plant {

namespace {

void FillEnergies(const RecordSource& s, double* out) {
  const Energy e = s.world->TotalEnergy(s.lane);
  out[0] = e.kinetic_j;
  out[1] = e.gravity_j;
  out[2] = e.elastic_j;
}

}  // namespace

Recorder::Recorder(const ExperimentSpec& experiment, Plant* plant)
    : patterns_(experiment.record.channels) {
  const ModelDef& def = experiment.robot.def;
  const bool has_bodies = plant == nullptr || plant->Observe().bodies != nullptr;
  const bool is_world = plant == nullptr || plant->world() != nullptr;
  const std::vector<int> with_set_point = CablesWithSetPoints(experiment.controllers);
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const bool has_set_point =
        std::binary_search(with_set_point.begin(), with_set_point.end(), static_cast<int>(c));
    std::vector<ChannelInfo> names;
    for (const CableChannel& channel : kCableChannels) {
      if (has_set_point || !channel.with_set_point) names.push_back({channel.name, channel.unit});
    }
    Add("cable/" + def.cables[c].name + "/", names,
        [c, has_set_point](const RecordSource& s, double* out) {
          for (const CableChannel& channel : kCableChannels) {
            if (!has_set_point && channel.with_set_point) continue;
            *out++ = channel.Value(s.exact->cables, *s.commands, c, s.lane);
          }
        });
  }
  for (std::size_t c = 0; is_world && c < def.cables.size(); ++c) {
    if (def.cables[c].actuator.kind != ActuatorDef::Kind::kDcMotor) continue;
    AddMotor("cable/" + def.cables[c].name + "/", static_cast<int>(c));
  }
  const bool has_boards = BoardsOf(experiment.controllers) != nullptr &&
                          (plant == nullptr || plant->commands().duty != nullptr);
  const SensorSpec sensors = experiment.sensors.value_or(SensorSpec{});
  for (std::size_t c = 0; (experiment.sensors || has_boards) && c < def.cables.size(); ++c) {
    AddSensor(sensors, "sensor/" + def.cables[c].name + "/", static_cast<int>(c));
  }
  for (std::size_t b = 0; has_bodies && b < def.bodies.size(); ++b) {
    Add("body/" + def.bodies[b].name + "/", BodyChannels(),
        [b](const RecordSource& s, double* out) {
          PutBody(s.exact->bodies->Body(s.lane, static_cast<int>(b)), out);
        });
  }
  if (is_world) AddSpanChannels(experiment, *this);
  if (is_world) AddJointChannels(experiment, *this);
  if (is_world) AddMotionChannels(experiment, *this);
  for (std::size_t i = 0; is_world && i < experiment.pushes.size(); ++i) {
    Add("push/" + experiment.pushes[i].name + "/", {{"force_n", "N"}},
        [i](const RecordSource& s, double* out) { *out = s.timeline->push_n()[i]; });
  }
  for (std::size_t i = 0; is_world && i < experiment.drags.size(); ++i) {
    Add("drag/" + experiment.drags[i].name + "/", {{"force_n", "N"}},
        [i](const RecordSource& s, double* out) { *out = s.timeline->drag_n()[i]; });
  }
  if (is_world) AddSystem(def);
  const bool on_request = !patterns_.empty();
  if (on_request && has_bodies) AddNodeChannels(experiment, *this);
  if (on_request && is_world) AddLoadChannels(experiment, *this);
  if (is_world) AddContactChannels(experiment, *this);
  row_.resize(channels_.size());
}

void Recorder::AddSensor(const SensorSpec& sensors, const std::string& prefix, int cable) {
  std::vector<ChannelInfo> sensed;
  for (const CableChannel& channel : kCableChannels) {
    if (channel.sensed) sensed.push_back({channel.name, channel.unit});
  }
  Add(prefix, sensed, [cable](const RecordSource& s, double* out) {
    for (const CableChannel& channel : kCableChannels) {
      if (!channel.sensed) continue;
      *out++ = channel.Value(s.seen->cables, *s.commands, static_cast<std::size_t>(cable), s.lane);
    }
  });
  // Also record integer counts if the sensor is quantized.
  if (sensors.load_cell && sensors.load_cell->counts) {
    const LoadCellCounts& counts = *sensors.load_cell->counts;
    Add(prefix, {{"tension_count", "1"}},
        [cable, gain = counts.gain_n_per_count, offset = counts.offset_n](const RecordSource& s,
                                                                          double* out) {
          *out = std::round((s.seen->Cable(cable, s.lane).tension_n - offset) / gain);
        });
  }
  if (sensors.encoder && sensors.encoder->quantum_m > 0) {
    Add(prefix, {{"encoder_count", "1"}},
        [cable, quantum = sensors.encoder->quantum_m](const RecordSource& s, double* out) {
          *out = std::round(s.seen->Cable(cable, s.lane).rest_length_m / quantum);
        });
  }
}

void Recorder::AddMotor(const std::string& prefix, int cable) {
  Add(prefix,
      {{"duty", "1"},
       {"current_a", "A"},
       {"supply_voltage_v", "V"},
       {"rotor_angle_rad", "rad"},
       {"rotor_speed_rad_per_s", "rad/s"},
       {"winding_temperature_c", "degC"},
       {"energy_from_supply_j", "J"},
       {"energy_to_cable_j", "J"}},
      [cable](const RecordSource& s, double* out) {
        const MotorState m = s.world->Motor(s.lane, cable);
        const double values[] = {m.duty,
                                 m.current_a,
                                 m.supply_voltage_v,
                                 m.rotor_angle_rad,
                                 m.rotor_speed_rad_per_s,
                                 m.winding_temperature_c,
                                 m.energy_from_supply_j,
                                 m.energy_to_cable_j};
        std::copy(std::begin(values), std::end(values), out);
      });
}

void Recorder::AddSystem(const ModelDef& def) {
  // In separate blocks, so that observing the center of mass does not gather all contacts.
  Add("system/", {{"kinetic_j", "J"}, {"gravity_j", "J"}, {"elastic_j", "J"}}, FillEnergies);
  Add("system/", {{"contact_count", "1"}}, [](const RecordSource& s, double* out) {
    *out = static_cast<double>(s.world->Contacts(s.lane).size());
  });
  Add("system/", {{"residual_m_per_s", "m/s"}},
      [](const RecordSource& s, double* out) { *out = s.world->Status(s.lane).residual_m_per_s; });
  Add("system/", {{"com_x_m", "m"}, {"com_y_m", "m"}, {"com_z_m", "m"}},
      [count = def.bodies.size()](const RecordSource& s, double* out) {
        Put(CenterOfMass(*s.world, s.lane, count), out);
      });
}

void Recorder::Add(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill) {
  AddThose(prefix, names, std::move(fill),
           [&](const std::string& name) { return base::FitsAny(patterns_, name); });
}

void Recorder::AddAsked(const std::string& prefix, const std::vector<ChannelInfo>& names,
                        Fill fill) {
  const bool some = std::any_of(names.begin(), names.end(), [&](const ChannelInfo& channel) {
    return base::FitsAny(patterns_, prefix + channel.name);
  });
  AddThose(prefix, names, std::move(fill),
           [&](const std::string& name) { return !some || base::FitsAny(patterns_, name); });
}

void Recorder::CountContacts(std::size_t count, std::size_t room) {
  left_out_.most_touching = std::max(left_out_.most_touching, static_cast<std::int64_t>(count));
  if (count <= room) return;
  ++left_out_.rows;
  left_out_.contacts += static_cast<std::int64_t>(count - room);
}

template <class Keeps>
void Recorder::AddThose(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill,
                        const Keeps& keeps) {
  Block block;
  block.size = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = prefix + names[i].name;
    if (!keeps(name)) continue;
    block.kept.push_back(i);
    channels_.push_back({name, names[i].unit});
  }
  if (block.kept.empty()) return;
  block.fill = std::move(fill);
  block_values_.resize(std::max(block_values_.size(), block.size));
  blocks_.push_back(std::move(block));
}

const std::vector<double>& Recorder::Row(const RecordSource& source) {
  std::size_t column = 0;
  for (const Block& block : blocks_) {
    block.fill(source, block_values_.data());
    for (std::size_t i : block.kept) row_[column++] = block_values_[i];
  }
  return row_;
}

bool CheckChannels(const ExperimentSpec& experiment, const std::vector<std::string>& patterns,
                   const std::vector<SourceRef>& places, const std::string& what,
                   Diagnostics& out) {
  if (patterns.empty()) return true;
  ExperimentSpec all = experiment;
  all.record.channels = {"*"};
  std::vector<std::string> names, known;
  for (const ChannelInfo& channel : RunChannels(all)) {
    names.push_back(channel.name);
    const std::size_t first = channel.name.find('/'), last = channel.name.rfind('/');
    std::string general = channel.name;
    if (first < last) general.replace(first + 1, last - first - 1, "*");
    if (std::find(known.begin(), known.end(), general) == known.end()) known.push_back(general);
  }
  known.insert(known.end(), names.begin(), names.end());
  bool good = true;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const std::string& pattern = patterns[i];
    const auto fits = [&](const std::string& name) { return base::Fits(pattern, name); };
    if (std::any_of(names.begin(), names.end(), fits)) continue;
    good = false;
    const bool contact = experiment.record.contacts == 0 && pattern.starts_with("contact/");
    out.Error("record.no_channel", i < places.size() ? places[i] : SourceRef{},
              what + ": no channel matches \"" + pattern + "\"",
              contact ? "record.contacts is 0: set it to the number of contacts to record"
                      : DidYouMean(pattern, known));
  }
  return good;
}

}  // namespace taut::plant

namespace taut {

std::vector<ChannelInfo> RunChannels(const ExperimentSpec& experiment, Plant* plant) {
  return plant::Recorder(experiment, plant).channels();
}

bool CheckRecord(const ExperimentSpec& experiment, Diagnostics& out) {
  const RecordSpec& record = experiment.record;
  return plant::CheckChannels(experiment, record.channels, record.channel_sources,
                              "record.channels", out);
}

}  // namespace taut
