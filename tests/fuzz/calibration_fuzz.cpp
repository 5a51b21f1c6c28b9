// Fuzz target of calibration files. An accepted file is written and read back.
#include "taut/calibration.h"

#include "fuzz/refusals.h"
#include "fuzz/text_input.h"

namespace {

using taut::CableCalibration;
using taut::Calibration;
using taut::fuzz::Must;

void CheckSame(const Calibration& a, const Calibration& b) {
  Must(a.name == b.name && a.description == b.description, "the same head");
  Must(a.cables.size() == b.cables.size(), "the same number of cables");
  for (std::size_t i = 0; i < a.cables.size(); ++i) {
    const CableCalibration &x = a.cables[i], &y = b.cables[i];
    Must(x.cable == y.cable && x.measured == y.measured && x.how == y.how, "the same texts");
    Must(x.load_cell_n_per_count == y.load_cell_n_per_count &&
             x.load_cell_counts_at_zero == y.load_cell_counts_at_zero &&
             x.encoder_m_per_count == y.encoder_m_per_count &&
             x.rest_length_at_reference_m == y.rest_length_at_reference_m &&
             x.stiffness_n_per_m == y.stiffness_n_per_m,
         "the same numbers of " + x.cable);
  }
}

}  // namespace

/// Inputs of odd size are read for a robot with known cables.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  std::vector<std::string> cables;
  if (size % 2 == 1) cables = {"outer_top_1", "outer_left_1", "inner_top_1"};
  taut::Diagnostics out;
  const auto read = LoadCalibration(folder.Write("input.yaml", data, size), cables, out);
  taut::fuzz::CheckReading(read.has_value(), out);
  if (!read) return 0;
  const std::string text = CalibrationYaml(*read);
  taut::Diagnostics again;
  const auto same =
      LoadCalibration(folder.Write("again.yaml", text.data(), text.size()), cables, again);
  Must(same.has_value(), "the written file can be read: " + again.Format() + text);
  CheckSame(*read, *same);
  return 0;
}
