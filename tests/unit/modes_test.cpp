/// Frequencies against those of structural programs and of simulated robots.

#include <gtest/gtest.h>

#include <vector>

#include "taut/analysis.h"
#include "tests/unit/structural_files.h"

namespace taut::test {
namespace {

/// Of all modes, ascending; 0 of those as a whole and of mechanisms [Hz].
std::vector<double> Frequencies(const ModelDef& def) {
  const Modes modes = FindModes(def);
  EXPECT_EQ(modes.why, "");
  std::vector<double> hz;
  for (const Mode& mode : modes.modes) hz.push_back(mode.frequency_hz);
  return hz;
}

void Expect(const std::vector<double>& hz, const std::vector<double>& known, double relative) {
  ASSERT_GE(hz.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_NEAR(hz[i], known[i], relative * known[i] + 1e-7) << i;
  }
}

struct Known {
  const char* file;
  MemberMass mass;
  std::vector<double> hz;
};

TEST(Modes, AreThoseOfStructuralFiles) {
  const Known all[] = {
      {"tsgfem_static_half_Tbar", MemberMass::kConsistent, {167.7479388, 1380.2545229}},
      {"tsgfem_static_3d_Dbar_folding",
       MemberMass::kConsistent,
       {0, 2.6176315, 2.6176315, 4.5355272}},
      {"tsgfem_static_tower_2prism",
       MemberMass::kConsistent,
       {0.0108886697, 0.0195394550, 0.0339645423, 0.0339645423}},
      {"ctsfem_cable_net_TTS_static", MemberMass::kConsistent, {0.6939147, 0.9801662, 0.9801662}},
      {"ctsfem_cable_net_TTS_static",
       MemberMass::kLumped,
       {0.6486321, 0.9015406, 0.9015406, 1.3725456, 1.3725456, 1.8294915}},
  };
  for (const Known& known : all) {
    SCOPED_TRACE(known.file);
    const auto file = StructuralFile(known.file);
    if (!file) GTEST_SKIP() << "no reference structures beside the checkout";
    const std::vector<double> hz = Frequencies(TrussOf(*file, known.mass));
    Expect(hz, known.hz, 1e-7);
    if (known.mass == MemberMass::kConsistent) {
      Expect(hz, Numbers((*file)["freq_Hz_recomputed"]), 1e-6);
    }
  }
}

}  // namespace
}  // namespace taut::test
