/// Fixture of the tests of traces: a temporary folder, and a trace with a known pattern
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::test {

class TraceFolder : public testing::Test {
 protected:
  TraceFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "taut_trace_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~TraceFolder() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  std::string WriteFile(const std::string& name, const std::string& content) const {
    std::ofstream(Path(name), std::ios::binary) << content;
    return Path(name);
  }

  static std::string ReadFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Returns the names of all files in the folder.
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Returns the diagnostics of reading `path`, which must fail; without the folder's name.
  std::string Complaint(const std::string& path) const {
    Diagnostics out;
    EXPECT_FALSE(ReadTrace(path, out));
    return WithoutFolder(out.Format());
  }

  std::string WithoutFolder(std::string text) const {
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != text.npos;) text.erase(at, folder.size());
    return text;
  }

  std::filesystem::path folder_;
};

inline std::vector<ChannelInfo> Channels(int count) {
  std::vector<ChannelInfo> channels;
  for (int i = 0; i < count; ++i) {
    channels.push_back({"cable/c_" + std::to_string(i) + "/tension_n", "N"});
  }
  return channels;
}

/// Returns the value of row `row` of channel `channel` in every test file.
inline double Value(std::size_t row, std::size_t channel) {
  return 0.1 * static_cast<double>(row) + static_cast<double>(channel) / 3.0;
}

inline bool AppendRow(TraceWriter& writer, std::size_t row, std::size_t channel_count,
                      double time_s) {
  std::vector<double> values(channel_count);
  for (std::size_t i = 0; i < channel_count; ++i) values[i] = Value(row, i);
  return writer.Append(time_s, values.data());
}

/// Expects that every value of every complete row equals the written one.
inline void ExpectPattern(const Trace& trace, std::size_t channel_count) {
  ASSERT_EQ(trace.values.size(), channel_count);
  for (std::size_t i = 0; i < channel_count; ++i) {
    ASSERT_EQ(trace.values[i].size(), trace.time_s.size());
    for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
      ASSERT_EQ(trace.values[i][row], Value(row, i)) << "row " << row << " channel " << i;
    }
  }
}

}  // namespace taut::test
