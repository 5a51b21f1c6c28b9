/// What the fuzz targets share: a folder in memory for the files to read, and a check that ends
/// the program.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace taut::fuzz {

/// Ends the program, and so shows the input to the fuzzer.
inline void Must(bool good, const std::string& what) {
  if (good) return;
  std::fprintf(stderr, "this must not be: %s\n", what.c_str());
  std::abort();
}

/// A folder of this process alone; goes away with it.
class Folder {
 public:
  Folder() {
    namespace fs = std::filesystem;
    const fs::path memory = "/dev/shm";
    const bool here = access(memory.c_str(), W_OK) == 0;
    std::string pattern =
        ((here ? memory : fs::temp_directory_path()) / "taut_fuzz_XXXXXX").string();
    const char* const made = mkdtemp(pattern.data());
    Must(made != nullptr, "no folder " + pattern);
    path_ = made;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string Path(const std::string& name) const { return (path_ / name).string(); }

  /// Writes a file and returns its path.
  std::string Write(const std::string& name, const void* data, std::size_t size) const {
    const std::string path = Path(name);
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    Must(file != nullptr && std::fwrite(data, 1, size, file) == size && std::fclose(file) == 0,
         "cannot write " + path);
    return path;
  }

 private:
  std::filesystem::path path_;
};

inline std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace taut::fuzz
