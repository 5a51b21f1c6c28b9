/// Wrappers of HDF5's C interface for reader and writer.
#pragma once

#include <hdf5.h>

#include <string>
#include <utility>

namespace taut::trace {

inline constexpr char kFormatName[] = "taut trace";
inline constexpr int kFormatVersion = 1;

/// HDF5 identifier that is closed by its destructor.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Id() = default;
  Hdf5Id(hid_t id, Close close) noexcept : id_(id), close_(close) {}
  Hdf5Id(Hdf5Id&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Id() { Reset(); }

  /// Closes the identifier. Returns false if this failed (HDF5 writes its buffers when it closes).
  bool Reset() noexcept {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || close_(id) >= 0;
  }
  /// Releases the identifier without closing it.
  void Abandon() noexcept { id_ = H5I_INVALID_HID; }
  explicit operator bool() const noexcept { return id_ >= 0; }
  operator hid_t() const noexcept { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

struct Hdf5Failure {
  std::string why;         ///< Message; from the operating system if a system call failed.
  bool of_system = false;  ///< Whether a system call failed ("No space left on device").
};

/// Suppresses HDF5's error output and stores the first error. The destructor restores the previous
/// output setting.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

  /// Returns the reason of the first failed call.
  Hdf5Failure first() const { return {why(), first_.of_system}; }
  std::string why() const { return first_.why.empty() ? "unknown HDF5 error" : first_.why; }
  /// Clears an error that was expected.
  void Forget() { first_ = {}; }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
  Hdf5Failure first_;
};

/// Returns the reason why HDF5 would open another file for a dataset with this creation property
/// list: "is a virtual dataset", "stores its numbers in another file". Returns an empty text if all
/// data are in the file. Call this before reading any data.
std::string WhyElsewhere(hid_t plan);

/// Opens a dataset. Returns nothing and sets `error` if it is missing, or if a link, external
/// storage or a virtual layout leads to another file.
Hdf5Id OpenDataset(hid_t file, const std::string& name, std::string& error);

/// Returns a fixed-length string type for `size` characters.
Hdf5Id StringType(std::size_t size);

}  // namespace taut::trace
