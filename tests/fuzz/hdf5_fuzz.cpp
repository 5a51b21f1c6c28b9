// Fuzz target of HDF5 traces: valid ones with damage, or any bytes. HDF5 may crash on them: its
// caller must not.
//
// Input: as for `Damaged`. Bases: a finished trace, a trace with an interrupted writer, a trace in
// HDF5's old layout, which has no checksums.
#include "fuzz/fuzz_folder.h"
#include "tests/unit/trace/hdf5_old_layout.h"

namespace {

using taut::fuzz::Folder;
using taut::fuzz::Must;

constexpr std::size_t kRows = 300;

std::vector<taut::ChannelInfo> Columns() {
  return {{"cable/a/tension_n", "N"}, {"cable/b/tension_n", "N"}};
}

/// Returns the file after `kRows` rows, finished or not.
std::string Written(const std::string& path, bool finish) {
  taut::Diagnostics out;
  const auto writer = CreateHdf5Trace(path, Columns(), {{"seed", "0"}}, out);
  Must(writer != nullptr, out.Format());
  for (std::size_t row = 0; row < kRows; ++row) {
    const double values[] = {1.0, static_cast<double>(row)};
    Must(writer->Append(static_cast<double>(row), values), "a row");
  }
  if (finish) writer->Finish();
  return taut::fuzz::ReadAll(path);
}

std::vector<std::string> Bases(const Folder& folder) {
  std::vector<std::string> bases{Written(folder.Path("finished.h5"), true),
                                 Written(folder.Path("cut.h5"), false)};
  taut::test::WriteOldLayout(folder.Path("old.h5"), Columns(), kRows);
  bases.push_back(taut::fuzz::ReadAll(folder.Path("old.h5")));
  return bases;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const std::vector<std::string> bases = Bases(folder);
  if (size == 0) return 0;
  const std::string file = taut::fuzz::Damaged(bases, data, size);
  taut::Diagnostics out;
  const auto trace = taut::ReadTrace(folder.Write("t.h5", file.data(), file.size()), out);
  Must(trace.has_value() == out.ok(), "a trace or complaints");
  if (!trace) return 0;
  Must(trace->values.size() == trace->channels.size(), "a column a channel");
  for (const auto& column : trace->values) {
    Must(column.size() == trace->time_s.size(), "as many values as times");
  }
  return 0;
}
