// Fuzz target of NTRT structures, in a folder with structures for their includes. One model file in
// four is also read.
#include "taut/import_ntrt.h"

#include "description/yaml/yaml_tree.h"
#include "fuzz/reader_targets.h"
#include "fuzz/refusals.h"
#include "fuzz/text_input.h"

namespace {

using taut::fuzz::Must;
namespace fs = std::filesystem;

/// Copies of all structures: in the folder of the input, and by the name of their folder in folders
/// next to the input and one level above, so that most relative paths of the seeds are valid.
struct Structures {
  taut::fuzz::Folder folder;
  Structures() {
    const fs::path top = folder.Path("in");
    fs::create_directory(top);
    for (const auto& entry :
         fs::recursive_directory_iterator(TAUT_SOURCE_DIR "/tests/data/ntrt/yaml")) {
      if (entry.path().extension() != ".yaml") continue;
      const fs::path parent = entry.path().parent_path().filename();
      for (const fs::path& to : {top, top / parent, fs::path(folder.Path(parent.string()))}) {
        fs::create_directories(to);
        fs::copy_file(entry.path(), to / entry.path().filename(), fs::copy_options::skip_existing);
      }
    }
  }
};

}  // namespace

/// Inputs of odd size are read with the option `like_ntrt`.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Structures structures;
  const taut::fuzz::Folder& folder = structures.folder;
  taut::Diagnostics out;
  const auto import =
      taut::ImportNtrt(folder.Write("in/input.yaml", data, size), {0.1, size % 2 == 1, {}}, out);
  taut::fuzz::CheckReading(import.has_value(), out);
  if (!import) return 0;
  const std::string& text = import->model_yaml;
  const std::string model = folder.Write("model.yaml", text.data(), text.size());
  taut::Diagnostics of_model;
  Must(taut::description::ParseYaml(text, model, of_model) != nullptr,
       "a model file: " + of_model.Format() + text);
  if (!taut::fuzz::OneIn(4, data, size)) return 0;
  const auto robot = taut::LoadRobot(model, {}, of_model);
  taut::fuzz::CheckReading(robot.has_value(), of_model);
  if (!robot) return 0;
  taut::fuzz::CheckRobot(*robot);
  Must(static_cast<int>(robot->def.cables.size()) == import->counts.cables,
       "as many cables as were counted");
  return 0;
}
