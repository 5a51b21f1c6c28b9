/// Serialization of numbers, texts and lists between processes of the same build on the same kind
/// of machine.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace taut::base {

class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void Put(T x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); }
  void Put(const std::string& text) {
    Put(text.size());
    bytes += text;
  }
  template <class T>
  void Put(const std::vector<T>& items) {
    Put(items.size());
    for (const T& item : items) Put(item);
  }
  std::string bytes;
};

/// Reader of serialized data. Values past the end are zeros.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  void Get(T& x) {
    x = T{};
    if (sizeof x > bytes_.size() - at_) return;
    std::memcpy(&x, bytes_.data() + at_, sizeof x);
    at_ += sizeof x;
  }
  void Get(std::string& text) {
    const std::size_t size = Size();
    text.assign(bytes_, at_, size);
    at_ += size;
  }
  template <class T>
  void Get(std::vector<T>& items) {
    items.resize(Size());
    for (T& item : items) Get(item);
  }
  /// Reads the size of a list that follows. Returns 0 if it exceeds the number of remaining bytes,
  /// since every item has at least one byte.
  std::size_t Size() {
    std::size_t size = 0;
    Get(size);
    return size > bytes_.size() - at_ ? 0 : size;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace taut::base
