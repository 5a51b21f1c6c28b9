/// Recorder: selects the channels of a trace and computes their values.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plant/timeline.h"
#include "taut/plant.h"
#include "taut/run.h"
#include "taut/trace.h"

namespace taut::plant {

/// Sources of a row, for one lane of a plant.
struct RecordSource {
  const Observation* exact = nullptr;
  const Observation* seen = nullptr;  ///< Observation that the controllers use.
  const Commands* commands = nullptr;
  const World* world = nullptr;
  const Timeline* timeline = nullptr;  ///< Timeline of the lane.
  int lane = 0;
};

/// Reports an error for each pattern that matches no channel of a run of this experiment. Returns
/// false if there is any. `what`: key of the patterns, for messages. `places`: their file
/// positions; may be empty.
bool CheckChannels(const ExperimentSpec& experiment, const std::vector<std::string>& patterns,
                   const std::vector<SourceRef>& places, const std::string& what, Diagnostics& out);

class Recorder {
 public:
  using Fill = std::function<void(const RecordSource&, double*)>;

  /// `plant`: plant to record. Null: a simulation.
  explicit Recorder(const ExperimentSpec& experiment, Plant* plant = nullptr);
  Recorder(const Recorder&) = delete;  // functions of blocks may hold pointers to this object
  Recorder& operator=(const Recorder&) = delete;

  const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }

  /// Returns the current row, which is valid until the next call.
  const std::vector<double>& Row(const RecordSource& source);

  /// Returns the contacts that did not fit into rows.
  const LeftOutContacts& left_out() const noexcept { return left_out_; }

  // --- for the functions of plant/channels.h, during construction --------------------------------
  /// Adds channels `prefix + names[i]` that `fill` computes together. Ignores channels that were
  /// not requested.
  void Add(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill);
  /// Adds channels that a separate key of `record` requests. If the key `channels` lists some of
  /// them, adds only these.
  void AddAsked(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill);
  /// Records that a row had `room` slots for `count` contacts.
  void CountContacts(std::size_t count, std::size_t room);

 private:
  void AddMotor(const std::string& prefix, int cable);
  void AddSensor(const SensorSpec& sensors, const std::string& prefix, int cable);
  void AddSystem(const ModelDef& def);
  /// Adds the channels of a block for which `keeps(name)` returns true.
  template <class Keeps>
  void AddThose(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill,
                const Keeps& keeps);

  struct Block {
    Fill fill;
    std::vector<std::size_t> kept;  ///< Indices of the block's values that are recorded.
    std::size_t size = 0;
  };
  std::vector<std::string> patterns_;
  std::vector<ChannelInfo> channels_;
  std::vector<Block> blocks_;
  std::vector<double> row_, block_values_;
  LeftOutContacts left_out_;
};

}  // namespace taut::plant
