// Loads model, experiment, gait, study, fit and fault files and prints their errors, for tests in
// other languages: spec_probe [--set name=value]... [--resolved] [--schema FORMAT] FILE... Exit
// status 1 if there are errors.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "taut/faults.h"
#include "taut/fit_spec.h"
#include "taut/schema.h"
#include "taut/spec.h"
#include "taut/study.h"

namespace {

bool IsOfKind(const std::string& kind, const std::string& path) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.find("kind: " + kind) == 0 ||
        line.find("\"kind\": \"" + kind + "\"") != std::string::npos) {
      return true;
    }
  }
  return false;
}

/// Returns the cables named in shipped scripts, and one used by the schema's tests.
std::vector<std::string> CablesOfTetraspine3() {
  std::vector<std::string> names{"a"};
  for (const char* joint : {"1", "2"}) {
    for (const char* name : {"outer_right_", "outer_left_", "outer_top_", "inner_right_",
                             "inner_left_", "inner_top_"}) {
      names.push_back(std::string(name) + joint);
    }
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  taut::Overrides overrides;
  taut::Diagnostics out;
  bool resolved = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--resolved") {
      resolved = true;
    } else if (argument == "--schema" && i + 1 < argc) {
      std::cout << taut::FormatSchema(argv[++i]).value_or("");
    } else if (argument == "--set" && i + 1 < argc) {
      const std::string pair = argv[++i];
      overrides.emplace_back(pair.substr(0, pair.find('=')), pair.substr(pair.find('=') + 1));
    } else if (IsOfKind("model", argument)) {
      taut::LoadRobot(argument, overrides, out);
    } else if (IsOfKind("gait", argument)) {
      taut::LoadGait(argument, out);
    } else if (IsOfKind("study", argument)) {
      taut::LoadStudy(argument, overrides, out);
    } else if (IsOfKind("fit", argument)) {
      taut::LoadFit(argument, overrides, out);
    } else if (IsOfKind("faults", argument)) {
      taut::LoadFaults(argument, CablesOfTetraspine3(), out);
    } else if (const auto experiment = taut::LoadExperiment(argument, overrides, out)) {
      if (resolved) std::cout << taut::ResolvedYaml(*experiment);
    }
  }
  std::cout << out.Format();
  return out.ok() ? 0 : 1;
}
