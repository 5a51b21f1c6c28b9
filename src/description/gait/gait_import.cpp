// Importer of NTRT gaits: learned parameters (.nnw) and hand-tuned ones (controlVars.json). NTRT's
// code is the only definition of these formats; comments below cite it.
#include <algorithm>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "base/input_file.h"
#include "description/gait/gait_import.h"
#include "description/gait/gait_parts.h"
#include "description/yaml/reader.h"

namespace taut {
namespace description {
namespace {

namespace fs = std::filesystem;

// BaseSpineCPGControl::Config of LearningSpineJSON. Learned numbers from 0 to 1 map to: frequencies
// 0 to 30 Hz, amplitudes 0 to 30 cm/s, weights 0 to 1 per cm/s and second, phases -pi to pi.
constexpr double kHighestHz = 30.0, kHighestAmplitude = 30.0;
// NTRT's descending command is 2. Frequency and amplitude are offset + 2 scale with offset = scale.
constexpr double kCommandFactor = 3.0;
constexpr double kConvergencePerS = 20.0;
/// With this step, commands agree with NTRT within 2e-6 m/s over a minute. For walking, steps of 2
/// ms would suffice: the error of the commands is then 4e-3 m/s (docs/theory/gaits.md).
constexpr double kIntegratorStepS = 0.00025;
constexpr int kEdges = 57;
/// Nodes whose sign LearningSpineJSON inverts "for hardware comparison".
constexpr int kInverted[] = {2, 4, 5, 6, 7, 8};

/// Cables of three segments in the order of NTRT's nodes: at the commit of the paper, and since
/// 2016.
const std::vector<std::string> kOrder2015{"outer_top_1",   "inner_top_1",   "outer_top_2",
                                          "inner_top_2",   "outer_left_1",  "inner_left_1",
                                          "outer_left_2",  "inner_left_2",  "outer_right_1",
                                          "inner_right_1", "outer_right_2", "inner_right_2"};
const std::vector<std::string> kOrder2016{
    "outer_right_1", "outer_left_1", "outer_top_1", "inner_right_1", "inner_left_1", "inner_top_1",
    "outer_right_2", "outer_left_2", "outer_top_2", "inner_right_2", "inner_left_2", "inner_top_2"};

/// Reads two numbers from 0 to 1: "0.5036,0.9295".
std::pair<double, double> ReadNnw(const fs::path& path, Diagnostics& out) {
  auto text = base::ReadInputFile(path.string(), kMaxFileBytes, "", out);
  if (!text) return {};
  std::replace(text->begin(), text->end(), ',', ' ');
  std::istringstream words(*text);
  double numbers[2] = {0, 0};
  bool good = true;
  for (double& number : numbers) {
    std::string word;
    words >> word;
    good = good && ToNumber(word, number);
    good = good && number >= 0.0 && number <= 1.0;
  }
  std::string more;
  if (!good || words >> more) {
    out.Error("ntrt.bad_parameters", {path.string(), 1, 1},
              "the file must contain two numbers within 0..1, such as 0.5036,0.9295");
  }
  return {numbers[0], numbers[1]};
}

/// Returns "bestParameters-9" for "bestParameters-9_edge-0.nnw". Reports an error and returns
/// nothing unless the folder contains exactly one such set.
std::optional<std::string> FindSet(const std::string& folder, Diagnostics& out) {
  std::vector<std::string> sets;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const std::string ending = "_node-0.nnw";
    if (name.ends_with(ending)) sets.push_back(name.substr(0, name.size() - ending.size()));
  }
  if (sets.size() == 1) return sets[0];
  out.Error("ntrt.parameter_files", {folder, 0, 0},
            sets.empty() ? "the folder has no file ..._node-0.nnw"
                         : "the folder has several sets of learned parameters",
            "expected a folder with bestParameters-9_node-0.nnw and bestParameters-9_edge-0.nnw to "
            "-56.nnw");
  return std::nullopt;
}

std::optional<GaitSpec> ImportLearned(const std::string& folder, NtrtCableOrder order,
                                      Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const auto set = FindSet(folder, out);
  if (!set) return std::nullopt;
  const auto [frequency, amplitude] = ReadNnw(fs::path(folder) / (*set + "_node-0.nnw"), out);
  CpgGait cpg;
  cpg.frequency_hz = kCommandFactor * (kHighestHz * frequency);
  cpg.amplitude = kMetre * kCommandFactor * (kHighestAmplitude * amplitude);
  cpg.convergence_per_s = kConvergencePerS;
  cpg.integrator_step_s = kIntegratorStepS;
  cpg.symmetry = CpgSymmetry::kIndex;
  cpg.order = order == NtrtCableOrder::kPaper2015 ? kOrder2015 : kOrder2016;
  for (const int node : kInverted) {
    cpg.inverted.push_back({cpg.order[static_cast<std::size_t>(node)]});
  }
  const std::vector<std::string> names = IndexGroups(6);
  for (int i = 0; i < kEdges; ++i) {
    // NTRT takes actions from the end of the list, so the last file contains the first group.
    const std::string file = *set + "_edge-" + std::to_string(kEdges - 1 - i) + ".nnw";
    const auto [weight, phase] = ReadNnw(fs::path(folder) / file, out);
    cpg.groups.push_back({names[static_cast<std::size_t>(i)], weight / kMetre,
                          -std::numbers::pi + 2.0 * std::numbers::pi * phase, SourceRef{}});
  }
  if (out.items().size() != errors_before) return std::nullopt;
  GaitSpec gait;
  gait.name = "ntrt_learned";
  gait.description = "Learned by NTRT, imported from " + *set + "_*.nnw.";
  gait.cpg = std::move(cpg);
  return gait;
}

/// Imports a .json file: the parameters of htSpineSine, or a controller with feedback. In
/// htSpineSine, V0 = A cos(2 pi f t + phi) - A, with the same A for left and right cables.
std::optional<GaitSpec> ImportJson(const std::string& path, Diagnostics& out) {
  auto text = base::ReadInputFile(path, kMaxFileBytes, "", out);
  if (!text) return std::nullopt;
  std::replace(text->begin(), text->end(), '\t', ' ');  // JSON allows tabs, YAML does not
  const std::size_t errors_before = out.items().size();
  const ValuePtr root = ParseYaml(*text, path, out);
  if (!root) return std::nullopt;
  if (root->Find("nodeVals")) return ImportFeedback(*root, path, out);
  const NameTable no_names;
  const Scope scope{no_names, out};
  MapReader map(*root, "controlVars", scope);
  for (const Entry& entry : root->entries) map.Know(entry.key);
  map.RefuseOthers();
  SineGait sine;
  sine.frequency_hz = map.Number("cpg_frequency", Bound::kPositive);
  for (int segment = 1; segment <= 2; ++segment) {
    const bool front = segment == 1;
    const double phase_rad = map.Number(front ? "front_offset" : "back_offset", Bound::kAny);
    for (const bool inner : {true, false}) {
      for (const bool top : {true, false}) {
        const std::string key = std::string(inner ? "in_" : "out_") + (top ? "top" : "bottom") +
                                "_amp_" + (front ? "a" : "b");
        const std::string end = "_" + std::to_string(segment), side = inner ? "inner" : "outer";
        const double A = kMetre * map.Number(key, Bound::kAny);
        SineWave wave;
        wave.name = "seg" + std::to_string(segment) + "_" + side + (top ? "_top" : "_bottom");
        wave.cables = top ? CableMatch{{side + "_top" + end}}
                          : CableMatch{{side + "_left" + end}, {side + "_right" + end}};
        wave.amplitude = A;
        wave.phase_rad = phase_rad;
        wave.offset = -A;
        sine.waves.push_back(std::move(wave));
      }
    }
  }
  if (out.items().size() != errors_before) return std::nullopt;
  GaitSpec gait;
  gait.name = "ntrt_hand_tuned";
  gait.description =
      "Hand-tuned for NTRT, imported from " + fs::path(path).filename().string() + ".";
  gait.sine = std::move(sine);
  return gait;
}

}  // namespace

std::vector<std::string> IndexGroups(int roles) {
  std::vector<std::string> names;
  for (int rp = 0; rp < 3; ++rp) {
    for (int j = 0; j < roles; ++j) {
      for (int k = j; k < roles; ++k) {
        if (rp == 1 && j == k) continue;
        names.push_back("rp" + std::to_string(rp) + "." + std::to_string(j) + "." +
                        std::to_string(k));
      }
    }
  }
  return names;
}

}  // namespace description

std::optional<GaitSpec> ImportNtrtGait(const std::string& path, NtrtCableOrder order,
                                       Diagnostics& out) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return description::ImportLearned(path, order, out);
  if (std::filesystem::is_regular_file(path, ignored)) return description::ImportJson(path, out);
  out.Error("file.missing", {path, 0, 0}, "there is no such file or folder");
  return std::nullopt;
}

}  // namespace taut
