#include "trace/hdf5_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>

#include "trace/hdf5_links.h"
#include "trace/unpack_limit.h"

namespace taut::trace {
namespace {

/// Longest text of an attribute, the limit of the parent process (hdf5_reader.cpp). Longer texts
/// are omitted.
constexpr std::size_t kMaxTextBytes = 64 << 20;

/// Size of the widest number type of any machine.
constexpr std::size_t kMostNumberBytes = 16;

/// Number of attempts to read consistent metadata while the file is being written. The wait between
/// attempts doubles, from 1 ns to about 30 ms in total. HDF5's default of 100 attempts takes more
/// than a minute.
constexpr unsigned kReadAttempts = 25;

/// Returns an attribute as text. Returns nothing if it is missing or not a text.
std::optional<std::string> TextAttribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return std::nullopt;
  const Hdf5Id attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Id type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute), H5Sclose);
  if (!type || H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) {
    return std::nullopt;
  }
  if (H5Tis_variable_str(type) > 0) {  // variable-length strings, as written by other programs
    char* text = nullptr;
    const Hdf5Id memory(H5Tcopy(type), H5Tclose);
    if (H5Aread(attribute, memory, &text) < 0 || text == nullptr) return std::nullopt;
    std::optional<std::string> copy;
    if (const std::size_t size = std::strlen(text); size <= kMaxTextBytes) copy.emplace(text, size);
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

/// Returns the attributes in order of creation if the file stores this order, otherwise by name.
TraceMetadata ReadMetadata(hid_t file) {
  TraceMetadata metadata;
  if (H5Aiterate2(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, AddMetadata, &metadata) < 0) {
    metadata.clear();
    H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, AddMetadata, &metadata);
  }
  return metadata;
}

/// Returns the reason why a dataset is not a column of a trace; empty if it is one. Checks its
/// layout first, since other calls could make HDF5 open another file. A trace must be a single
/// file.
std::string WhyNoColumn(hid_t dataset, Hdf5Column& column) {
  const Hdf5Id plan(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = plan ? H5Pget_layout(plan) : H5D_LAYOUT_ERROR;
  if (const std::string why = WhyElsewhere(plan); !why.empty())
    return why + "; a trace must be a single file";
  const Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const H5T_class_t kind = type ? H5Tget_class(type) : H5T_NO_CLASS;
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || H5Tget_size(type) > kMostNumberBytes ||
      H5Sget_simple_extent_ndims(space) != 1) {
    return "is not a column of numbers";
  }
  for (int i = 0; i < H5Pget_nfilters(plan); ++i) {
    char name[64] = {};
    unsigned flags = 0;
    std::size_t none = 0;
    const H5Z_filter_t filter = H5Pget_filter2(plan, static_cast<unsigned>(i), &flags, &none,
                                               nullptr, sizeof name, name, nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) > 0) continue;
    return fmt::format("is compressed with filter {} \"{}\", which this HDF5 library does not have",
                       static_cast<int>(filter), name);
  }
  H5Sget_simple_extent_dims(space, &column.rows, nullptr);
  if (layout == H5D_CHUNKED && H5Pget_chunk(plan, 1, &column.chunk_rows) != 1) {
    return "is not a column of numbers";
  }
  return {};
}

/// Adds the dataset of a link. Skips soft links, since the dataset also has a hard link.
Hdf5Visit AddColumn(Hdf5Link& link, Hdf5File& found, std::string& error) {
  const auto fail = [&](std::string why) {
    error = std::move(why);
    return Hdf5Visit::kFail;
  };
  if (link.type == H5L_TYPE_SOFT) return Hdf5Visit::kContinue;
  if (link.type != H5L_TYPE_HARD) {
    return fail(
        fmt::format("/{} is a link to another file; a trace must be a single file", link.path));
  }
  if (H5Iget_type(link.object) == H5I_GROUP) return Hdf5Visit::kContinue;

  Hdf5Column column;
  column.name = link.path;
  const std::string why = H5Iget_type(link.object) == H5I_DATASET ? WhyNoColumn(link.object, column)
                                                                  : "is not a dataset";
  if (!why.empty()) return fail(fmt::format("/{} {}", link.path, why));
  const std::optional<std::string> unit = TextAttribute(link.object, "unit");
  const std::optional<int> place = NumberAttribute(link.object, "column");
  // A missing attribute is valid, but an attribute that cannot be read is an error.
  if ((!unit && H5Aexists(link.object, "unit") != 0) ||
      (!place && H5Aexists(link.object, "column") != 0)) {
    return fail(fmt::format(
        "the trace is damaged: the unit or the column number of /{} cannot be read", link.path));
  }
  column.unit = unit.value_or("1");
  column.place = place.value_or(INT_MAX);
  column.dataset = std::move(link.object);
  if (column.name == "time_s") {
    found.time = std::move(column);
  } else {
    found.channels.push_back(std::move(column));
  }
  return Hdf5Visit::kContinue;
}

/// Returns all columns, time first.
std::vector<const Hdf5Column*> AllColumns(const Hdf5File& trace) {
  std::vector<const Hdf5Column*> all{&trace.time};
  for (const Hdf5Column& channel : trace.channels) all.push_back(&channel);
  return all;
}

/// Checks that the data fit in memory: whole chunks, converted to native numbers. A damaged size
/// may exceed all data that the file can contain.
bool FitsInMemory(double file_bytes, const Hdf5File& trace, std::string& error) {
  double bytes = 0;
  for (const Hdf5Column* column : AllColumns(trace)) {
    const auto rows = static_cast<double>(column->rows);
    const auto chunk = static_cast<double>(std::max<hsize_t>(column->chunk_rows, 1));
    bytes += std::ceil(rows / chunk) * chunk * sizeof(double);
  }
  if (bytes <= MostUnpackedBytes(file_bytes)) return true;
  error = fmt::format(
      "the trace is damaged or compressed too strongly: its numbers take {:.0f} MiB, {}; if this "
      "size is intended, unpack it with `h5repack -f NONE` first",
      bytes / (1 << 20), kUnpackLimit);
  return false;
}

/// Checks that all rows were written and that columns do not share storage. For finished files
/// only: unfinished files may have space for more rows.
bool IsComplete(double file_bytes, const Hdf5File& trace, std::string& error) {
  double stored_bytes = 0;
  for (const Hdf5Column* column : AllColumns(trace)) {
    if (column->rows != trace.time.rows) {
      error = fmt::format("the trace is damaged: {} has {} rows, but time_s has {}", column->name,
                          column->rows, trace.time.rows);
      return false;
    }
    const Hdf5Id type(H5Dget_type(column->dataset), H5Tclose);
    const Hdf5Id space(H5Dget_space(column->dataset), H5Sclose);
    const auto bytes = static_cast<double>(H5Dget_storage_size(column->dataset));
    stored_bytes += bytes;
    auto rows = static_cast<hsize_t>(bytes / static_cast<double>(H5Tget_size(type)));
    if (column->chunk_rows > 0) {
      hsize_t chunks = 0;
      if (H5Dget_num_chunks(column->dataset, space, &chunks) < 0) chunks = 0;
      rows = chunks * column->chunk_rows;
    }
    if (rows >= column->rows) continue;
    error = fmt::format("the trace is damaged: {} declares {} rows, but contains {}", column->name,
                        column->rows, rows);
    return false;
  }
  if (stored_bytes <= file_bytes) return true;
  error = "the trace is damaged: its columns overlap in the file";
  return false;
}

}  // namespace

std::optional<Hdf5File> OpenHdf5Trace(const std::string& path, std::string& error) {
  QuietHdf5 quiet;
  Hdf5File trace;
  // Try twice, so that a single failed read does not mark the trace as unfinished.
  for (int attempt = 0; attempt < 2 && !trace.file; ++attempt) {
    trace.file = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  }
  if (!trace.file) {  // open as SWMR reader: the file is being written, or its writer was killed
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_metadata_read_attempts(access, kReadAttempts);
    trace.file =
        Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), H5Fclose);
    trace.cut_off = true;
  }
  if (!trace.file) {
    error = fmt::format("the file is not HDF5 or is damaged: {}", quiet.why());
    return std::nullopt;
  }
  if (TextAttribute(trace.file, "format") != kFormatName) {
    error = fmt::format(
        "the file is HDF5 but not a trace: it has no attribute \"format\" with the value \"{}\"",
        kFormatName);
    return std::nullopt;
  }
  const std::optional<int> version = NumberAttribute(trace.file, "format_version");
  if (version != kFormatVersion) {
    error = fmt::format("the trace has the format version {}; this taut reads version {}",
                        version ? std::to_string(*version) : "none", kFormatVersion);
    return std::nullopt;
  }
  trace.metadata = ReadMetadata(trace.file);
  const auto visit = [&](Hdf5Link& link) { return AddColumn(link, trace, error); };
  if (!VisitLinks(trace.file, visit, error)) {
    if (error.empty()) error = fmt::format("the trace is damaged: {}", quiet.why());
    return std::nullopt;
  }
  if (!trace.time.dataset) {
    error = "the trace is damaged: it has no column /time_s";
    return std::nullopt;
  }
  std::stable_sort(trace.channels.begin(), trace.channels.end(),
                   [](const Hdf5Column& a, const Hdf5Column& b) { return a.place < b.place; });
  for (std::size_t i = 0; i < trace.channels.size(); ++i) {
    const int place = trace.channels[i].place;
    if (place == INT_MAX || place == static_cast<int>(i) + 1) continue;
    error = fmt::format("the trace is damaged: column {} is missing", i + 1);
    return std::nullopt;
  }
  trace.rows = trace.time.rows;
  for (const Hdf5Column& channel : trace.channels) trace.rows = std::min(trace.rows, channel.rows);
  struct stat info {};
  const double bytes = stat(path.c_str(), &info) == 0 ? static_cast<double>(info.st_size) : 0.0;
  if (!FitsInMemory(bytes, trace, error)) return std::nullopt;
  if (!trace.cut_off && !IsComplete(bytes, trace, error)) return std::nullopt;
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
  error =
      fmt::format("the trace is damaged: column {} cannot be read: {}", column.name, quiet.why());
  return false;
}

}  // namespace taut::trace
