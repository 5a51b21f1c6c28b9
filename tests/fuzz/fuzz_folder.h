/// Common helpers of the fuzz targets: a folder in memory for input files, a check that ends the
/// program, and damage to valid files.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace taut::fuzz {

/// Ends the program if `good` is false, which reports the input to the fuzzer.
inline void Must(bool good, const std::string& what) {
  if (good) return;
  std::fprintf(stderr, "this must not be: %s\n", what.c_str());
  std::abort();
}

/// A folder of this process, deleted by the destructor.
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

/// Returns a number from 0 to `n - 1` that depends on all bytes of an input. It selects parts of a
/// target that take much longer than the reader it tests; a saved input repeats the same parts.
inline unsigned Pick(unsigned n, const std::uint8_t* data, std::size_t size) {
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ data[i]) * 16777619U;
  return (hash >> 8) % n;
}
inline bool OneIn(unsigned n, const std::uint8_t* data, std::size_t size) {
  return Pick(n, data, size) == 0;
}

inline std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the file that an input encodes. Its first byte selects a base, patches of four bytes
/// follow: place (3), value (1). If there is no such base, the rest of the input is the file.
inline std::string Damaged(const std::vector<std::string>& bases, const std::uint8_t* data,
                           std::size_t size) {
  if (data[0] >= bases.size()) return {data + 1, data + size};
  std::string file = bases[data[0]];
  for (std::size_t i = 1; i + 3 < size; i += 4) {
    const std::size_t place = data[i] | data[i + 1] << 8 | data[i + 2] << 16;
    file[place % file.size()] = static_cast<char>(data[i + 3]);
  }
  return file;
}

}  // namespace taut::fuzz
