/// Wrappers of HDF5's C interface, shared by reader and writer.
#pragma once

#include <hdf5.h>

#include <string>
#include <utility>

namespace taut::trace {

inline constexpr char kFormatName[] = "taut trace";
inline constexpr int kFormatVersion = 1;

/// An HDF5 identifier that closes itself.
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

  /// Closes. Returns false if that failed (HDF5 writes its buffers when it closes).
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
  std::string why;         ///< The system's message if a call to the system failed.
  bool of_system = false;  ///< A call to the system failed ("No space left on device").
};

/// Suppresses HDF5's error output during its lifetime and stores the first error. The destructor
/// restores the setting of the surrounding program.
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

/// Returns the reason why a dataset with this creation property list makes HDF5 open another file:
/// "is a virtual dataset", "stores its numbers in another file"; empty if all of it is in the file
/// itself. To be called before anything is read.
std::string WhyElsewhere(hid_t plan);

/// Opens the dataset of that name if the file itself contains all its numbers. Returns nothing and
/// a sentence in `error` if it is missing or a link, external storage or a virtual layout leads to
/// another file.
Hdf5Id OpenDataset(hid_t file, const std::string& name, std::string& error);

/// A fixed-length string type for `size` characters.
Hdf5Id StringType(std::size_t size);

}  // namespace taut::trace
