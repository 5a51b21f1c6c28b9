/// What a run records, kept in memory.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "taut/run.h"
#include "taut/trace.h"

namespace taut {

/// By the names of channels; the rows' times are "time_s".
using Columns = std::map<std::string, std::vector<double>>;

class Rows final : public TraceWriter {
 public:
  explicit Rows(const ExperimentSpec& experiment) : channels_(RunChannels(experiment)) {}
  bool Append(double time_s, const double* values) override {
    columns["time_s"].push_back(time_s);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      columns[channels_[i].name].push_back(values[i]);
    }
    return true;
  }
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return none_; }
  Columns columns;

 private:
  std::vector<ChannelInfo> channels_;
  std::string none_;
};

}  // namespace taut
