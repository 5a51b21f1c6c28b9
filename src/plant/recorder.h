/// Which channels a run records, and their values.
#pragma once

#include <functional>
#include <vector>

#include "plant/timeline.h"
#include "taut/plant.h"
#include "taut/trace.h"

namespace taut::plant {

/// What a row is filled from: lane 0 of a plant.
struct RecordSource {
  const Observation* exact = nullptr;
  const Observation* seen = nullptr;  ///< By the controllers.
  const Commands* commands = nullptr;
  const World* world = nullptr;
  const Timeline* timeline = nullptr;
};

class Recorder {
 public:
  /// `plant`: whose rows it will take; null: a simulation's.
  explicit Recorder(const ExperimentSpec& experiment, Plant* plant = nullptr);

  const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }

  /// The current row; valid until the next call.
  const std::vector<double>& Row(const RecordSource& source);

 private:
  void AddSystem(const ModelDef& def);
  using Fill = std::function<void(const RecordSource&, double*)>;
  /// Adds channels `prefix + names[i]` that `fill` computes together; those not asked for are
  /// dropped.
  void Add(const std::string& prefix, const std::vector<ChannelInfo>& names, Fill fill);

  struct Block {
    Fill fill;
    std::vector<std::size_t> kept;  ///< Which of the block's values are channels.
    std::size_t size = 0;
  };
  std::vector<std::string> patterns_;
  std::vector<ChannelInfo> channels_;
  std::vector<Block> blocks_;
  std::vector<double> row_, block_values_;
};

}  // namespace taut::plant
