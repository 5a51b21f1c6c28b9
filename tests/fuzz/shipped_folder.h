/// Copies of folders of the source tree, for fuzz inputs that refer to files in them.
#pragma once

#include <initializer_list>

#include "fuzz/fuzz_folder.h"

namespace taut::fuzz {

class ShippedFolder : public Folder {
 public:
  /// Copies these folders, of share/ or of the source tree. `own` is created for the inputs.
  ShippedFolder(const std::string& own, std::initializer_list<const char*> shipped) {
    namespace fs = std::filesystem;
    fs::create_directories(Path(own));
    for (const char* name : shipped) {
      fs::create_directories(fs::path(Path(name)).parent_path());
      const fs::path shared = fs::path(TAUT_SOURCE_DIR) / "share" / name;
      fs::copy(fs::exists(shared) ? shared : fs::path(TAUT_SOURCE_DIR) / name, Path(name),
               fs::copy_options::recursive);
    }
  }
};

}  // namespace taut::fuzz
