/// Fixture with a recorded run of 0.5 s of the push test, for tests of replays and reports
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "apps/viewer/replay_session.h"
#include "taut/run.h"
#include "tests/viewer/serving.h"

namespace taut::test {

class ReplayFolder : public testing::Test {
 protected:
  ReplayFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "taut_replay_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    Diagnostics found;
    experiment_ = *LoadExperiment(kPush, {}, found);
    experiment_.duration_s = 0.5;
    Record(trace(), experiment_);
    WriteInputs();
  }
  ~ReplayFolder() override { std::filesystem::remove_all(folder_); }

  /// Runs an experiment with its trace at a path.
  static void Record(const std::string& path, const ExperimentSpec& experiment,
                     const TraceMetadata& metadata = {}) {
    Diagnostics found;
    const auto writer = CreateHdf5Trace(path, RunChannels(experiment), metadata, found);
    RunOptions options;
    options.traces = {writer.get()};
    EXPECT_TRUE(RunExperiment(experiment, options, found)) << found.Format();
  }

  std::string trace() const { return (folder_ / "trace.h5").string(); }
  void WriteInputs() const { Write("inputs.yaml", ResolvedYaml(experiment_)); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  static std::unique_ptr<viewer::Recorded> Load(const std::string& path,
                                                const std::vector<std::string>& compare = {}) {
    Diagnostics found;
    auto recorded = viewer::Recorded::Load(path, compare, found);
    EXPECT_TRUE(recorded) << found.Format();
    return recorded;
  }
  std::unique_ptr<viewer::Session> Session() const {
    return std::make_unique<viewer::ReplaySession>(Load(trace()), 1);
  }

  std::filesystem::path folder_;
  ExperimentSpec experiment_;
};

}  // namespace taut::test
