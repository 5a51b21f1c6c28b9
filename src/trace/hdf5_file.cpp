#include "trace/hdf5_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <climits>

namespace taut::trace {
namespace {

constexpr std::size_t kMaxTextBytes = 64 << 20;

/// How often HDF5 looks again when a live file does not add up. It waits twice as long each time,
/// from 1 ns: about 30 ms in all (its own 100 attempts take more than a minute).
constexpr unsigned kReadAttempts = 25;

/// The attribute as text; nothing if there is none or it is not text.
std::optional<std::string> TextAttribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return std::nullopt;
  const Hdf5Id attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Id type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute), H5Sclose);
  if (!type || H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) {
    return std::nullopt;
  }
  if (H5Tis_variable_str(type) > 0) {  // as other programs write them
    char* text = nullptr;
    const Hdf5Id memory(H5Tcopy(type), H5Tclose);
    if (H5Aread(attribute, memory, &text) < 0 || text == nullptr) return std::nullopt;
    std::string copy = text;
    H5free_memory(text);
    return copy;
  }
  const std::size_t size = H5Tget_size(type);
  if (size > kMaxTextBytes) return std::nullopt;
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return std::nullopt;
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

std::optional<int> NumberAttribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return std::nullopt;
  const Hdf5Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Id space(H5Aget_space(attribute), H5Sclose);
  int number = 0;
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, H5T_NATIVE_INT, &number) < 0) {
    return std::nullopt;
  }
  return number;
}

herr_t AddMetadata(hid_t object, const char* name, const H5A_info_t*, void* out) {
  const std::string key = name;
  if (key == "format" || key == "format_version") return 0;
  if (auto text = TextAttribute(object, key)) {
    static_cast<TraceMetadata*>(out)->emplace_back(key, std::move(*text));
  }
  return 0;
}

/// Attributes in the order in which they were made if the file knows it, else by name.
TraceMetadata ReadMetadata(hid_t file) {
  TraceMetadata metadata;
  if (H5Aiterate2(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, AddMetadata, &metadata) < 0) {
    metadata.clear();
    H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, AddMetadata, &metadata);
  }
  return metadata;
}

struct Walk {
  Hdf5File& found;
  std::string& error;
};

/// Takes the dataset behind a link. Links to other files are not followed: a trace is one file.
herr_t AddColumn(hid_t group, const char* name, const H5L_info_t* link, void* context) {
  const Walk& walk = *static_cast<Walk*>(context);
  if (link->type != H5L_TYPE_HARD) return 0;
  Hdf5Id object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (!object) return -1;
  if (H5Iget_type(object) == H5I_GROUP) return 0;

  Hdf5Column column;
  column.name = name;
  const Hdf5Id type(H5Dget_type(object), H5Tclose);
  const Hdf5Id space(H5Dget_space(object), H5Sclose);
  const H5T_class_t kind = type ? H5Tget_class(type) : H5T_NO_CLASS;
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || H5Sget_simple_extent_ndims(space) != 1) {
    walk.error = fmt::format("/{} is not a column of numbers", name);
    return -1;
  }
  H5Sget_simple_extent_dims(space, &column.rows, nullptr);
  column.unit = TextAttribute(object, "unit").value_or("1");
  column.place = NumberAttribute(object, "column").value_or(INT_MAX);
  column.dataset = std::move(object);
  if (column.name == "time_s") {
    walk.found.time = std::move(column);
  } else {
    walk.found.channels.push_back(std::move(column));
  }
  return 0;
}

/// A damaged extent may promise more numbers than any file of this size can hold. Compression
/// (deflate: at most 1032 to 1) is for files of other programs.
bool Holds(const std::string& path, const Hdf5File& trace) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return false;
  double most_bytes = 2.0 * static_cast<double>(info.st_size);
  const Hdf5Id layout(H5Dget_create_plist(trace.time.dataset), H5Pclose);
  if (H5Pget_nfilters(layout) > 0) most_bytes *= 1032.0;
  const double columns = static_cast<double>(trace.channels.size() + 1);
  return columns * static_cast<double>(trace.rows) * sizeof(double) <= most_bytes;
}

}  // namespace

std::optional<Hdf5File> OpenHdf5Trace(const std::string& path, std::string& error) {
  QuietHdf5 quiet;
  Hdf5File trace;
  trace.file = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!trace.file) {  // as a reader beside the writer, which need not live any more
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_metadata_read_attempts(access, kReadAttempts);
    trace.file =
        Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), H5Fclose);
    trace.cut_off = true;
  }
  if (!trace.file) {
    error = fmt::format("is not HDF5 or is damaged: {}", quiet.why());
    return std::nullopt;
  }
  if (TextAttribute(trace.file, "format") != kFormatName) {
    error = fmt::format("is HDF5 but not a trace: no attribute \"format\" that says \"{}\"",
                        kFormatName);
    return std::nullopt;
  }
  const std::optional<int> version = NumberAttribute(trace.file, "format_version");
  if (version != kFormatVersion) {
    error = fmt::format("has trace format version {}; this taut reads version {}",
                        version ? std::to_string(*version) : "none", kFormatVersion);
    return std::nullopt;
  }
  trace.metadata = ReadMetadata(trace.file);
  Walk walk{trace, error};
  if (H5Lvisit(trace.file, H5_INDEX_NAME, H5_ITER_INC, AddColumn, &walk) < 0) {
    if (error.empty()) error = fmt::format("is damaged: {}", quiet.why());
    return std::nullopt;
  }
  if (!trace.time.dataset) {
    error = "is damaged: has no column /time_s";
    return std::nullopt;
  }
  std::stable_sort(trace.channels.begin(), trace.channels.end(),
                   [](const Hdf5Column& a, const Hdf5Column& b) { return a.place < b.place; });
  trace.rows = trace.time.rows;
  for (const Hdf5Column& channel : trace.channels) trace.rows = std::min(trace.rows, channel.rows);
  if (!Holds(path, trace)) {
    error = fmt::format("is damaged: claims {} rows, more than its size allows", trace.rows);
    return std::nullopt;
  }
  return trace;
}

bool ReadHdf5Rows(const Hdf5Column& column, hsize_t from, hsize_t count, double* to,
                  std::string& error) {
  const QuietHdf5 quiet;
  const Hdf5Id memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Id space(H5Dget_space(column.dataset), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr) >= 0 &&
      H5Dread(column.dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, to) >= 0) {
    return true;
  }
  error = fmt::format("is damaged: column {} cannot be read: {}", column.name, quiet.why());
  return false;
}

}  // namespace taut::trace
