/// Which channels a run records, and their values.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plant/timeline.h"
#include "taut/plant.h"
#include "taut/run.h"
#include "taut/trace.h"

namespace taut::plant {

/// What a row is filled from: a lane of a plant.
struct RecordSource {
  const Observation* exact = nullptr;
  const Observation* seen = nullptr;  ///< By the controllers.
  const Commands* commands = nullptr;
  const World* world = nullptr;
  const Timeline* timeline = nullptr;  ///< The lane's.
  int lane = 0;
};

/// A complaint for each of `patterns`, named `what`, that fits no channel of a run of this
/// experiment; false if there was one. `places`: where they stand; may be empty.
bool CheckChannels(const ExperimentSpec& experiment, const std::vector<std::string>& patterns,
                   const std::vector<SourceRef>& places, const std::string& what, Diagnostics& out);

class Recorder {
 public:
  using Fill = std::function<void(const RecordSource&, double*)>;

  /// `plant`: whose rows it will take; null: a simulation's.
  explicit Recorder(const ExperimentSpec& experiment, Plant* plant = nullptr);
  Recorder(const Recorder&) = delete;  // a block of channels may point here
  Recorder& operator=(const Recorder&) = delete;

  const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }

  /// The current row; valid until the next call.
  const std::vector<double>& Row(const RecordSource& source);

  /// Contacts for which rows had no slot.
  const LeftOutContacts& left_out() const noexcept { return left_out_; }

  // --- for what makes channels (plant/channels.h), while this is made ----------------------------
  /// Adds channels `prefix + names[i]` that `fill` computes together; those not asked for are
  /// dropped.
  void Add(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill);
  /// The same for channels that another key than `channels` has asked for: all of them, if
  /// `channels` does not name some.
  void AddAsked(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill);
  /// That a row with `room` slots stands for `count` contacts.
  void CountContacts(std::size_t count, std::size_t room);

 private:
  void AddMotor(const std::string& prefix, int cable);
  void AddSensor(const SensorSpec& sensors, const std::string& prefix, int cable);
  void AddSystem(const ModelDef& def);
  /// Of a block's channels those for which `keeps(name)`.
  template <class Keeps>
  void AddThose(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill,
                const Keeps& keeps);

  struct Block {
    Fill fill;
    std::vector<std::size_t> kept;  ///< Which of the block's values are channels.
    std::size_t size = 0;
  };
  std::vector<std::string> patterns_;
  std::vector<ChannelInfo> channels_;
  std::vector<Block> blocks_;
  std::vector<double> row_, block_values_;
  LeftOutContacts left_out_;
};

}  // namespace taut::plant
