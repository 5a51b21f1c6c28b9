// Search for shipped files from any folder
#include "taut/shipped.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace taut {
namespace {

namespace fs = std::filesystem;

class Shipped : public testing::Test {
 public:
  ~Shipped() override {
    fs::current_path(before_);
    fs::remove_all(folder_);
  }

 protected:
  Shipped() : before_(fs::current_path()) {
    folder_ = fs::temp_directory_path() / ("taut_shipped_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    Write("tree/share/models/a.yaml");
    Write("tree/build/program");
    fs::create_directories(folder_ / "tree/build/share/taut");
    fs::create_directory_symlink(folder_ / "tree/share/models",
                                 folder_ / "tree/build/share/taut/models");
    Write("tree/build/share/a.yaml");
    Write("usr/share/taut/models/a.yaml");
    Write("usr/bin/taut");
    fs::create_directories(folder_ / "work");
    fs::current_path(folder_ / "work");
  }
  void Write(const fs::path& path) const {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << "text";
  }
  std::string At(const std::string& path) const { return (fs::canonical(folder_) / path).string(); }
  std::string Build() const { return At("tree/build/program"); }

  fs::path before_, folder_;
};

TEST_F(Shipped, TheFolderIsBesideTheProgramOrAboveIt) {
  EXPECT_EQ(ShippedFolder(Build()), At("tree/build/share/taut"));
  EXPECT_EQ(ShippedFolder(At("usr/bin/taut")), At("usr/share/taut"));
  EXPECT_EQ(ShippedFolder(At("work")), std::nullopt);
  EXPECT_EQ(ShippedFolder(At("none")), std::nullopt);
}

TEST_F(Shipped, AFileIsFoundFromAnyFolder) {
  EXPECT_EQ(FindInput("models/a.yaml", Build()), At("tree/share/models/a.yaml"));
  EXPECT_EQ(FindInput("models/a.yaml", At("usr/bin/taut")), At("usr/share/taut/models/a.yaml"));
  fs::current_path(folder_ / "tree");
  EXPECT_EQ(FindInput("models/a.yaml", Build()), "share/models/a.yaml");
}

TEST_F(Shipped, FilesOfTheProgramAreFoundInABuildAnInstallationAndAPackage) {
  const fs::path program = fs::canonical(RunningProgram());
  EXPECT_EQ(FindBesideProgram(program.filename()), program.string());
  EXPECT_EQ(FindBesideProgram("none"), std::nullopt);
  for (const char* const share : {"share/taut", "../share/taut"}) {
    // The installation's folder comes before the package's.
    const fs::path file = (folder_ / "usr/bin" / share / "web/page.html").lexically_normal();
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "page";
    SetRunningProgram(At("usr/bin/taut"));
    EXPECT_EQ(FindBesideProgram("web/page.html"), file.string());
    SetRunningProgram("");
  }
}

TEST_F(Shipped, AFileOfTheCurrentFolderComesFirst) {
  Write("work/models/a.yaml");
  EXPECT_EQ(FindInput("models/a.yaml", Build()), "models/a.yaml");
}

TEST_F(Shipped, WhatIsNotThereStaysAsItIs) {
  for (const char* const path : {"", "models/b.yaml", "models", "/models/a.yaml", "../a.yaml"}) {
    EXPECT_EQ(FindInput(path, Build()), path);
  }
  EXPECT_EQ(FindInput("models/a.yaml", At("none")), "models/a.yaml");
  EXPECT_EQ(FindInput("models/a.yaml", ""), "models/a.yaml");
}

TEST_F(Shipped, AMisspelledFileGetsAHint) {
  Write("tree/share/models/prism.yaml");
  Write("work/mine/robot.yaml");
  EXPECT_EQ(SimilarInput("models/prsim.yaml", Build()), "did you mean \"models/prism.yaml\"?");
  EXPECT_EQ(SimilarInput("prism.yaml", Build()), "did you mean \"models/prism.yaml\"?");
  EXPECT_EQ(SimilarInput("prism", Build()), "did you mean \"models/prism.yaml\"?");
  EXPECT_EQ(SimilarInput("mine/robt.yaml", Build()), "did you mean \"mine/robot.yaml\"?");
  EXPECT_EQ(SimilarInput(At("work/mine/robot"), ""),
            "did you mean \"" + At("work/mine/robot.yaml") + "\"?");
  for (const char* const path :
       {"", "/", "models/elephant.yaml", "none/prism.yaml", "models/prism.csv"}) {
    EXPECT_EQ(SimilarInput(path, Build()), "") << path;
  }
}

}  // namespace
}  // namespace taut
