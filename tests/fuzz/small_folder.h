/// Folder with the smallest files that fuzz inputs of studies, fits and gaits refer to (small/).
///
/// Shipped files would do as well, but loading an experiment with a whole robot takes a hundred
/// times as long as reading the input.
#pragma once

#include "fuzz/fuzz_folder.h"

namespace taut::fuzz {

class SmallFolder : public Folder {
 public:
  SmallFolder() {
    std::filesystem::copy(TAUT_SOURCE_DIR "/tests/fuzz/small", Path(""),
                          std::filesystem::copy_options::recursive);
  }
};

}  // namespace taut::fuzz
