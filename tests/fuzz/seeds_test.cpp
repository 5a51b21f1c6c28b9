// Seeds of the fuzz targets of text files: every one is accepted. Mutations of a seed with an error
// would end at this error, and never reach the rest of their reader.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "fuzz/small_folder.h"
#include "taut/calibration.h"
#include "taut/catalogue.h"
#include "taut/fit_spec.h"
#include "taut/gait.h"
#include "taut/mjcf.h"
#include "taut/study.h"

namespace taut {
namespace {

/// Calls `read(path, out)` for each seed of a target, copied to `folder` in the small folder.
template <class Read>
void ExpectAccepted(const std::string& target, const std::string& folder, const Read& read) {
  const fuzz::SmallFolder small;
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(TAUT_SOURCE_DIR "/tests/fuzz/seeds/" + target)) {
    SCOPED_TRACE(entry.path().string());
    const std::string text = fuzz::ReadAll(entry.path().string());
    Diagnostics out;
    EXPECT_TRUE(read(small.Write(folder + "/input.yaml", text.data(), text.size()), out));
    EXPECT_TRUE(out.ok()) << out.Format();
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(FuzzSeeds, OfStudiesAreAccepted) {
  ExpectAccepted("study", "studies", [](const std::string& path, Diagnostics& out) {
    return LoadStudy(path, {}, out).has_value();
  });
}

TEST(FuzzSeeds, OfFitsAreAccepted) {
  ExpectAccepted("fit", "fits", [](const std::string& path, Diagnostics& out) {
    return LoadFit(path, {}, out).has_value();
  });
}

TEST(FuzzSeeds, OfGaitsAreAccepted) {
  ExpectAccepted("gait", "gaits", [](const std::string& path, Diagnostics& out) {
    return LoadGait(path, out).has_value();
  });
}

TEST(FuzzSeeds, OfCataloguesAreAccepted) {
  ExpectAccepted("catalogue", "gaits", [](const std::string& path, Diagnostics& out) {
    return LoadCatalogue(path, out).has_value();
  });
}

TEST(FuzzSeeds, OfCalibrationsAreAccepted) {
  ExpectAccepted("calibration", "gaits", [](const std::string& path, Diagnostics& out) {
    return LoadCalibration(path, {"outer_top_1", "inner_top_1"}, out).has_value();
  });
}

TEST(FuzzSeeds, OfMjcfAreAccepted) {
  ExpectAccepted("mjcf", "gaits", [](const std::string& path, Diagnostics& out) {
    // Without a keyframe the controls are 0, and then the rest length of an actuated cable.
    MjcfImport options;
    if (fuzz::ReadAll(path).find("<keyframe>") != std::string::npos) options.keyframe = "0";
    return ImportMjcf(path, options, out).has_value();
  });
}

}  // namespace
}  // namespace taut
