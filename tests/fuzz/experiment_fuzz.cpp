// Any bytes as an experiment file, the shipped models beside it.
#include "fuzz/readers.h"

namespace {

struct Folders {
  taut::fuzz::Folder folder;
  Folders() {
    namespace fs = std::filesystem;
    fs::create_directory(folder.Path("experiments"));
    for (const char* name : {"models", "mappings"}) {
      fs::copy(fs::path(TAUT_SOURCE_DIR) / "share" / name, folder.Path(name));
    }
    // Bases of experiments, under the names by which the shipped ones are known.
    for (const auto& entry : fs::directory_iterator(TAUT_SOURCE_DIR "/share/experiments")) {
      fs::copy(entry.path(), folder.Path("experiments/" + entry.path().filename().string()));
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folders folders;
  taut::fuzz::CheckExperimentFile(folders.folder.Write("experiments/input.yaml", data, size),
                                  folders.folder);
  return 0;
}
