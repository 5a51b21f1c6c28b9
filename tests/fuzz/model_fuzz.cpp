// Fuzz target of model files.
#include "fuzz/reader_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  taut::fuzz::CheckModelFile(folder.Write("model.yaml", data, size));
  return 0;
}
