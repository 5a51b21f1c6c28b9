/// Recorded rows of a run, kept in memory
#pragma once

#include <map>
#include <string>
#include <vector>

#include "taut/run.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {

/// Values by channel name; times under "time_s"
using Columns = std::map<std::string, std::vector<double>>;

class Rows final : public test::RowWatch {
 public:
  explicit Rows(const ExperimentSpec& experiment) : channels_(RunChannels(experiment)) {}
  bool Append(double time_s, const double* values) override {
    columns["time_s"].push_back(time_s);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      columns[channels_[i].name].push_back(values[i]);
    }
    return true;
  }
  Columns columns;

 private:
  std::vector<ChannelInfo> channels_;
};

}  // namespace taut
