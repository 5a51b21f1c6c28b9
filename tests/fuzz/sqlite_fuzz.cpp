// Fuzz target of study logs with damage, or any bytes.
//
// Input: as for `Damaged`. Bases: a log of this version, and of version 1, which has no checksums.
#include "fuzz/fuzz_folder.h"
#include "tests/unit/learn/study_log_files.h"

namespace {

using taut::fuzz::Folder;
using taut::fuzz::Must;

std::vector<std::string> Bases(const Folder& folder) {
  const std::string now = folder.Path("now"), old = folder.Path("old");
  Must(taut::test::WriteLog(now).empty() && taut::test::WriteOldLog(old).empty(), "bases");
  return {taut::fuzz::ReadAll(now), taut::fuzz::ReadAll(old)};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const std::vector<std::string> bases = Bases(folder);
  if (size == 0) return 0;
  const std::string file = taut::fuzz::Damaged(bases, data, size);
  taut::Diagnostics out;
  const auto log = taut::test::ReadLog(folder.Path("study.sqlite"), file, out);
  Must(log.has_value() == out.ok(), "contents or complaints");
  if (log && data[0] == 0) Must(taut::test::IsTrue(*log), "nothing lost or changed without a word");
  return 0;
}
