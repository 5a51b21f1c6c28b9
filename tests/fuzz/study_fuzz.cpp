// Fuzz target of study files, in a folder with a small experiment.
#include "taut/study.h"

#include "fuzz/refusals.h"
#include "fuzz/small_folder.h"
#include "fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::SmallFolder folder;
  const std::string path = folder.Write("studies/input.yaml", data, size);
  taut::Diagnostics out;
  const auto study = LoadStudy(path, {}, out);
  taut::fuzz::CheckReading(study.has_value(), out);
  if (!study) return 0;
  for (const taut::StudyParameter& one : study->parameters) {
    Must(one.low <= one.high && !one.targets.empty(), "bounds of " + one.name);
  }
  for (const taut::SearchSpec& one : study->searches) {
    Must(one.evaluations > 0 && one.batch > 0, "evaluations of a search");
  }
  if (!taut::fuzz::OneIn(8, data, size)) return 0;
  taut::Diagnostics ignored;
  const auto again = LoadStudy(path, {}, ignored);
  Must(again && StudyText(*again) == StudyText(*study), "the same text twice");
  return 0;
}
