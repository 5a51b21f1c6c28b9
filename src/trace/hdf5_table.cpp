// Content of the pipe: error as length and bytes (empty: none) | rows | columns | numbers, in the
// machine's binary format.
#include "trace/hdf5_table.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <utility>

#include "base/input_file.h"
#include "trace/child_process.h"
#include "trace/hdf5.h"

namespace taut::trace {
namespace {

constexpr std::uint64_t kMostErrorBytes = 1 << 16;

/// Opens the dataset. Returns an error message if it is not a table.
std::string OpenTable(const std::string& path, const std::string& name, const TableBudget& budget,
                      double file_bytes, Hdf5Id& file, Hdf5Id& set, hsize_t size[2]) {
  const QuietHdf5 quiet;
  file = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return "the file is not HDF5 or is damaged: " + quiet.why();
  std::string error;
  set = OpenDataset(file, name, error);
  if (!set) return error;
  const Hdf5Id type(H5Dget_type(set), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) return name + " contains no numbers";
  const Hdf5Id space(H5Dget_space(set), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (dimensions != 2) {
    return fmt::format("{} has {} dimensions instead of 2", name, dimensions);
  }
  H5Sget_simple_extent_dims(space, size, nullptr);
  const double count = static_cast<double>(size[0]) * static_cast<double>(size[1]);
  if (count > budget.left()) {
    return fmt::format("{} has {} x {} numbers{}", name, size[0], size[1], budget.MoreThan());
  }
  const double bytes = sizeof(double) * count;
  if (!budget.Unpacks(bytes, file_bytes)) {
    return fmt::format(
        "the file has too high a compression ratio: {} unpacks to {:.0f} MiB, {}; unpack it "
        "with `h5repack -f NONE` first",
        name, bytes / (1 << 20), budget.UnpackedMoreThan());
  }
  return "";
}

/// Child process: reads the file and sends its content.
void SendTable(const std::string& path, const std::string& name, const TableBudget& budget,
               double file_bytes, const ChildOutput& to) {
  Hdf5Id file, set;
  hsize_t size[2] = {0, 0};
  std::string error = OpenTable(path, name, budget, file_bytes, file, set, size);
  std::vector<double> values;
  if (error.empty()) {
    const QuietHdf5 quiet;
    values.resize(size[0] * size[1]);
    if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      error = "the file is damaged: " + name + " cannot be read: " + quiet.why();
    }
  }
  const std::uint64_t head[3] = {error.size(), size[0], size[1]};
  to.Write(head, sizeof head);
  to.Write(error.data(), error.size());
  if (error.empty()) to.Write(values.data(), values.size() * sizeof(double));
}

}  // namespace

std::optional<Hdf5Table> ReadHdf5Table(const std::string& path, const std::string& name,
                                       TableBudget& budget, Diagnostics& out) {
  // Read the file first, to report the system's message if the file cannot be opened.
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  const auto bytes = base::ReadInputFile(path, kMostBytes, "use fewer numbers", out);
  if (!bytes) return std::nullopt;
  const auto file_bytes = static_cast<double>(bytes->size());
  ChildProcess child([&](const ChildOutput& to) { SendTable(path, name, budget, file_bytes, to); },
                     static_cast<std::size_t>(budget.most()) * 2 * sizeof(double), kChildPatience);
  std::uint64_t head[3] = {};
  std::string error;
  Hdf5Table table;
  bool good = child.Read(head, sizeof head) && head[0] <= kMostErrorBytes;
  if (good) {
    error.resize(head[0]);
    good = child.Read(error.data(), error.size());
  }
  if (good && error.empty()) {
    good = static_cast<double>(head[1]) * static_cast<double>(head[2]) <= budget.left();
    if (good) {
      table.rows = static_cast<int>(head[1]);
      table.columns = static_cast<int>(head[2]);
      table.values.resize(head[1] * head[2]);
      good = child.Read(table.values.data(), table.values.size() * sizeof(double));
    }
  }
  if (!good) {
    const std::string how = child.End();
    error = "the file is damaged: reading it " + (how.empty() ? "returned invalid data" : how);
  }
  if (!error.empty()) {
    out.Error("hdf5.bad_table", {path}, error);
    return std::nullopt;
  }
  budget.AddPacked(static_cast<double>(table.values.size()), file_bytes);
  return table;
}

}  // namespace taut::trace
