// HDF5 writer for traces that are readable at any time (docs/formats/trace.md).
//
// All groups, datasets and attributes are created before the first row. Then the file is switched
// to HDF5's single-writer mode (SWMR), which orders writes so that readers always see a valid
// structure, even after the writer was killed.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "taut/files.h"
#include "taut/trace.h"
#include "trace/channel_names.h"
#include "trace/flush_clock.h"
#include "trace/hdf5.h"

namespace taut::trace {
namespace {

/// Rows per chunk. Chunks of 8 kB waste little space in short runs, and an hour at 1 kHz has only
/// 3500 chunks per channel.
constexpr hsize_t kChunkRows = 1024;

bool WriteText(hid_t object, const std::string& name, const std::string& text) {
  const Hdf5Id type = StringType(text.size());
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute && H5Awrite(attribute, type, text.c_str()) >= 0;
}

bool WriteNumber(hid_t object, const char* name, int number) {
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute && H5Awrite(attribute, H5T_NATIVE_INT, &number) >= 0;
}

/// Creates an empty column of unlimited length at `path`. `column`: its position in a row.
Hdf5Id CreateColumn(hid_t file, const std::string& path, const std::string& unit, int column) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Hdf5Id space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Hdf5Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Hdf5Id layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(layout, 1, &kChunkRows);
  H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER);
  Hdf5Id column_id(
      H5Dcreate2(file, path.c_str(), H5T_IEEE_F64LE, space, links, layout, H5P_DEFAULT), H5Dclose);
  if (!column_id || !WriteText(column_id, "unit", unit) ||
      !WriteNumber(column_id, "column", column)) {
    return {};
  }
  return column_id;
}

class Hdf5Writer final : public TraceWriter {
 public:
  Hdf5Writer(const std::string& path, std::size_t channel_count)
      : path_(path), new_(path), width_(channel_count + 1), rows_(kChunkRows * width_) {}

  ~Hdf5Writer() override {
    if (new_.published()) Finish();
    const QuietHdf5 quiet;  // closes an unpublished file, which is then removed
    columns_.clear();
    file_.Reset();
  }

  /// Creates the file with all its content except the rows.
  bool Start(const std::vector<ChannelInfo>& channels, const TraceMetadata& metadata);

  bool Append(double time_s, const double* values) override {
    if (!file_) return Fail("the trace was already finished");
    if (!error_.empty()) return false;
    double* row = rows_.data() + row_count_ * width_;
    row[0] = time_s;
    std::copy(values, values + (width_ - 1), row + 1);
    ++row_count_;
    // Whole chunks are cheapest to write, so write at the end of each chunk.
    if ((written_ + row_count_) % kChunkRows == 0 && !WriteRows()) return false;
    return FlushOld();
  }

  bool FlushOld() override {
    if (!error_.empty()) return false;
    return !file_ || !clock_.due() || Flush();
  }

  bool Finish() override {
    if (!error_.empty()) return false;
    if (!file_) return true;
    if (!WriteRows()) return false;
    const QuietHdf5 quiet;
    for (Hdf5Id& column : columns_) {
      if (!column.Reset()) return Fail(quiet.first());
    }
    if (!file_.Reset()) return Fail(quiet.first());
    return (new_.Publish() && new_.Sync()) || Fail(new_.why());
  }

  const std::string& error() const override { return error_; }

 private:
  bool Flush() {
    if (!WriteRows()) return false;
    const QuietHdf5 quiet;
    if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) return Fail(quiet.first());
    clock_.Flushed();
    return new_.Publish() || Fail(new_.why());
  }

  /// Writes buffered rows. Writes time last, so that a row with a time is complete.
  bool WriteRows() {
    if (row_count_ == 0) return true;
    const QuietHdf5 quiet;
    for (std::size_t i = 1; i <= width_; ++i) {
      if (!WriteColumn(i % width_)) return Fail(quiet.first());
    }
    written_ += row_count_;
    row_count_ = 0;
    return true;
  }

  bool WriteColumn(std::size_t column) {
    for (std::size_t row = 0; row < row_count_; ++row) {
      block_[row] = rows_[row * width_ + column];
    }
    const hsize_t from = written_, count = row_count_, total = from + count;
    if (H5Dset_extent(columns_[column], &total) < 0) return false;
    const Hdf5Id memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Hdf5Id space(H5Dget_space(columns_[column]), H5Sclose);
    return space &&
           H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr) >= 0 &&
           H5Dwrite(columns_[column], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, block_) >= 0;
  }

  bool Fail(std::string why) { return Fail(Hdf5Failure{std::move(why), true}); }

  /// Closes the file after a failed write. The file on disk remains readable up to the last flush.
  /// HDF5 cannot close a file that it cannot write. After a system error, its remaining writes are
  /// redirected to /dev/null, which frees memory and disk space. After an internal error of the
  /// library, its identifiers are abandoned.
  bool Fail(const Hdf5Failure& failure) {
    if (error_.empty()) error_ = fmt::format("{}: cannot write: {}", path_, failure.why);
    const bool nowhere = failure.of_system && WriteNowhere();
    if (!nowhere) {
      for (Hdf5Id& column : columns_) column.Abandon();
      file_.Abandon();
    }
    const QuietHdf5 quiet;
    columns_.clear();
    file_.Reset();
    return false;
  }

  /// Redirects all further writes of the library to /dev/null.
  bool WriteNowhere() {
    const QuietHdf5 quiet;
    void* handle = nullptr;
    if (!file_ || H5Fget_vfd_handle(file_, H5P_DEFAULT, &handle) < 0) return false;
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing < 0) return false;
    const bool good = dup3(nothing, *static_cast<int*>(handle), O_CLOEXEC) >= 0;
    close(nothing);
    return good;
  }

  std::string path_, error_;
  NewFile new_;
  std::size_t width_;  ///< Number of values per row: time and channels.
  Hdf5Id file_;
  std::vector<Hdf5Id> columns_;  ///< Columns: time first, then the channels.
  std::vector<double> rows_;     ///< Rows not written yet, row by row; at most one chunk.
  std::size_t row_count_ = 0;    ///< Number of rows in `rows_`.
  hsize_t written_ = 0;          ///< Number of rows in the file.
  double block_[kChunkRows] = {};
  FlushClock clock_;
};

bool Hdf5Writer::Start(const std::vector<ChannelInfo>& channels, const TraceMetadata& metadata) {
  const QuietHdf5 quiet;
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  // Disable the chunk cache, so that data leave the process at once and memory stays small. (The
  // setting of a single dataset is lost when single-writer mode starts.)
  H5Pset_cache(access, 0, 1, 0, 1.0);
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);

  // `NewFile` creates the file; HDF5 opens and truncates it.
  if (!new_.Create()) return Fail(new_.why());
  file_ = Hdf5Id(H5Fcreate(new_.made_at().c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  if (!file_) return Fail(quiet.first());
  bool good = WriteText(file_, "format", kFormatName) &&
              WriteNumber(file_, "format_version", kFormatVersion);
  for (std::size_t i = 0; good && i < metadata.size(); ++i) {
    good = WriteText(file_, metadata[i].first, metadata[i].second);
  }
  for (std::size_t i = 0; good && i <= channels.size(); ++i) {
    columns_.push_back(i == 0 ? CreateColumn(file_, "/time_s", "s", 0)
                              : CreateColumn(file_, "/" + channels[i - 1].name,
                                             channels[i - 1].unit, static_cast<int>(i)));
    good = static_cast<bool>(columns_.back());
  }
  return (good && H5Fstart_swmr_write(file_) >= 0) || Fail(quiet.first());
}

bool CheckMetadata(const std::string& path, const TraceMetadata& metadata, Diagnostics& out) {
  for (std::size_t i = 0; i < metadata.size(); ++i) {
    const std::string& key = metadata[i].first;
    const bool taken = key.empty() || key == "format" || key == "format_version" ||
                       std::any_of(metadata.begin(), metadata.begin() + static_cast<long>(i),
                                   [&](const auto& pair) { return pair.first == key; });
    if (!taken) continue;
    out.Error("trace.bad_metadata", {path},
              fmt::format("metadata key \"{}\" is empty, reserved or occurs twice", key));
    return false;
  }
  return true;
}

}  // namespace
}  // namespace taut::trace

namespace taut {

std::unique_ptr<TraceWriter> CreateHdf5Trace(const std::string& path,
                                             const std::vector<ChannelInfo>& channels,
                                             const TraceMetadata& metadata, Diagnostics& out) {
  if (!trace::CheckChannelNames(path, channels, out) ||
      !trace::CheckMetadata(path, metadata, out)) {
    return nullptr;
  }
  auto writer = std::make_unique<trace::Hdf5Writer>(path, channels.size());
  if (!writer->Start(channels, metadata)) {
    out.Error("trace.not_written", {}, writer->error());
    return nullptr;
  }
  return writer;
}

}  // namespace taut
