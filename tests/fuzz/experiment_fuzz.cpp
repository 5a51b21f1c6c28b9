// Fuzz target of experiment files, next to the shipped models.
#include "fuzz/reader_targets.h"

namespace {

struct Folders {
  taut::fuzz::Folder folder;
  Folders() {
    namespace fs = std::filesystem;
    fs::create_directory(folder.Path("experiments"));
    for (const char* name : {"models", "mappings"}) {
      fs::copy(fs::path(TAUT_SOURCE_DIR) / "share" / name, folder.Path(name));
    }
    // Base experiments, under the names of the shipped files.
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
