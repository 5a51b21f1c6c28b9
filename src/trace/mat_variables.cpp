// Content of the pipe: error as length and bytes (empty: none) | number of variables | for each:
// length of the name, name, rows, columns, values. Numbers have the machine's binary format.
#include "trace/mat_variables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/input_file.h"
#include "trace/child_process.h"
#include "trace/hdf5_links.h"
#include "trace/table_budget.h"

namespace taut::trace {
namespace {

constexpr double kMostNumbers = 1e8;
constexpr std::uint64_t kMostTextBytes = 1 << 16, kMostVariables = 100'000;
constexpr std::size_t kMostFileBytes = std::size_t{1} << 32;

/// Returns the first bytes of a file; fewer if it is shorter.
std::string FirstBytes(const std::string& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

/// Returns the attribute MATLAB_class, such as "double"; empty if there is none.
std::string ClassOf(hid_t object) {
  if (H5Aexists(object, "MATLAB_class") <= 0) return {};
  const Hdf5Id attribute(H5Aopen(object, "MATLAB_class", H5P_DEFAULT), H5Aclose);
  const Hdf5Id type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  constexpr std::size_t kLongest = 64;
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 ||
      H5Tget_size(type) > kLongest || H5Sget_simple_extent_npoints(space) != 1) {
    return {};
  }
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

/// State of the visit of all links.
struct MatWalk {
  double file_bytes = 0, numbers = 0;
  std::vector<MatVariable> found;
  std::string error;
};

/// Reads one dataset. Leaves `into` empty if the dataset is not a real matrix. Returns false and
/// sets an error on failure.
bool ReadOne(hid_t set, MatWalk& walk, MatVariable& into) {
  const Hdf5Id type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type);
  const bool empty = H5Aexists(set, "MATLAB_empty") > 0;
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || empty || ClassOf(set) == "char" ||
      H5Sget_simple_extent_ndims(space) != 2) {
    return true;
  }
  const Hdf5Id plan(H5Dget_create_plist(set), H5Pclose);
  if (const std::string why = WhyElsewhere(plan); !why.empty()) {
    walk.error = into.name + " " + why + "; the file must contain all numbers";
    return false;
  }
  hsize_t size[2] = {0, 0};
  H5Sget_simple_extent_dims(space, size, nullptr);
  const double count = static_cast<double>(size[0]) * static_cast<double>(size[1]);
  walk.numbers += count;
  const TableBudget budget(kMostNumbers);
  if (walk.numbers > kMostNumbers) {
    walk.error = fmt::format("the variables up to {} have {:.0f} numbers{}", into.name,
                             walk.numbers, budget.MoreThan());
    return false;
  }
  if (!budget.Unpacks(walk.numbers * sizeof(double), walk.file_bytes)) {
    walk.error = fmt::format("the variables up to {} unpack to {:.0f} MiB, {}", into.name,
                             walk.numbers * sizeof(double) / (1 << 20), budget.UnpackedMoreThan());
    return false;
  }
  // HDF5 lists the dimensions of MATLAB's column-major matrices in reverse order.
  into.rows = size[1], into.columns = size[0];
  into.values.resize(into.size());
  if (into.values.empty() ||
      H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, into.values.data()) >= 0) {
    return true;
  }
  walk.error = "the file is damaged: " + into.name + " cannot be read";
  return false;
}

Hdf5Visit VisitVariable(Hdf5Link& link, MatWalk& walk) {
  // "#refs#" and "#subsystem#" contain the parts of cells and objects.
  if (link.type != H5L_TYPE_HARD || link.path[0] == '#') return Hdf5Visit::kSkipGroup;
  if (H5Iget_type(link.object) != H5I_DATASET) {
    // Names below this group would be longer than any that is read.
    return link.path.size() < kMostTextBytes ? Hdf5Visit::kContinue : Hdf5Visit::kSkipGroup;
  }
  if (walk.found.size() >= kMostVariables) return Hdf5Visit::kContinue;
  MatVariable variable;
  variable.name = link.path;
  std::replace(variable.name.begin(), variable.name.end(), '/', '.');
  if (!ReadOne(link.object, walk, variable)) return Hdf5Visit::kFail;
  if (!variable.values.empty() && variable.name.size() < kMostTextBytes) {
    walk.found.push_back(std::move(variable));
  }
  return Hdf5Visit::kContinue;
}

/// Child process: reads the file and sends its content.
void SendVariables(const std::string& path, double file_bytes, const ChildOutput& to) {
  MatWalk walk;
  walk.file_bytes = file_bytes;
  {
    const QuietHdf5 quiet;
    const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const auto visit = [&](Hdf5Link& link) { return VisitVariable(link, walk); };
    const bool readable = file && VisitLinks(file, visit, walk.error);
    if (!readable && walk.error.empty()) walk.error = "the file is damaged: " + quiet.why();
  }
  const auto number = [&](std::uint64_t n) { to.Write(&n, sizeof n); };
  walk.error.resize(std::min<std::size_t>(walk.error.size(), kMostTextBytes));
  number(walk.error.size());
  to.Write(walk.error.data(), walk.error.size());
  if (!walk.error.empty()) return;
  number(walk.found.size());
  for (const MatVariable& v : walk.found) {
    number(v.name.size());
    to.Write(v.name.data(), v.name.size());
    number(v.rows), number(v.columns);
    to.Write(v.values.data(), v.values.size() * sizeof(double));
  }
}

bool ReceiveNumber(ChildProcess& child, std::uint64_t most, std::uint64_t& n) {
  return child.Read(&n, sizeof n) && n <= most;
}

bool ReceiveText(ChildProcess& child, std::string& text) {
  std::uint64_t size = 0;
  if (!ReceiveNumber(child, kMostTextBytes, size)) return false;
  text.resize(size);
  return child.Read(text.data(), size);
}

/// Receives the variables. Returns false if the child ended early or sent invalid data.
bool Receive(ChildProcess& child, std::string& error, std::vector<MatVariable>& variables) {
  if (!ReceiveText(child, error)) return false;
  if (!error.empty()) return true;
  std::uint64_t count = 0;
  if (!ReceiveNumber(child, kMostVariables, count)) return false;
  double numbers = 0;
  const auto most = static_cast<std::uint64_t>(kMostNumbers);
  for (std::uint64_t i = 0; i < count; ++i) {
    MatVariable& v = variables.emplace_back();
    std::uint64_t rows = 0, columns = 0;
    if (!ReceiveText(child, v.name) || !ReceiveNumber(child, most, rows) ||
        !ReceiveNumber(child, most, columns)) {
      return false;
    }
    numbers += static_cast<double>(rows) * static_cast<double>(columns);
    if (numbers > kMostNumbers) return false;
    v.rows = rows, v.columns = columns;
    v.values.resize(v.size());
    if (!child.Read(v.values.data(), v.values.size() * sizeof(double))) return false;
  }
  return true;
}

}  // namespace

bool IsMatFile(const std::string& path) {
  // Reading a pipe would take its bytes away from other readers.
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && FirstBytes(path, 7) == "MATLAB ";
}

std::optional<std::vector<MatVariable>> ReadMatVariables(const std::string& path,
                                                         Diagnostics& out) {
  // Read the file first, to report the system's message if the file cannot be opened.
  const auto bytes = base::ReadInputFile(path, kMostFileBytes, "save fewer variables", out);
  if (!bytes) return std::nullopt;
  if (!bytes->starts_with("MATLAB 7.3 MAT-file")) {
    out.Error("mat.other_version", {path}, "the file is not a MATLAB file of version 7.3",
              "save it with save(\"log.mat\", \"-v7.3\")");
    return std::nullopt;
  }
  const auto file_bytes = static_cast<double>(bytes->size());
  ChildProcess child([&](const ChildOutput& to) { SendVariables(path, file_bytes, to); },
                     static_cast<std::size_t>(kMostNumbers) * 2 * sizeof(double), kChildPatience);
  std::string error;
  std::vector<MatVariable> variables;
  if (!Receive(child, error, variables)) {
    const std::string how = child.End();
    error = "the file is damaged: reading it " + (how.empty() ? "returned invalid data" : how);
  }
  if (!error.empty()) {
    out.Error("mat.damaged", {path}, error);
    return std::nullopt;
  }
  return variables;
}

MatColumns ColumnsOf(const std::vector<MatVariable>& variables, std::size_t rows) {
  if (rows == 0) {
    std::map<std::size_t, std::size_t> counts;
    for (const MatVariable& v : variables) {
      if (v.size() > 1) ++counts[v.IsVector() ? v.size() : std::max(v.rows, v.columns)];
    }
    std::size_t most = 0;
    for (const auto& [size, count] : counts) {
      if (count >= most) most = count, rows = size;
    }
  }
  MatColumns out;
  for (const MatVariable& v : variables) {
    if (rows > 0 && v.IsVector() && v.size() == rows) {
      out.names.push_back(v.name);
      out.values.push_back(v.values);
      continue;
    }
    const bool transposed = v.rows != rows;
    if (v.IsVector() || rows == 0 || (transposed && v.columns != rows)) continue;
    const std::size_t columns = transposed ? v.rows : v.columns;
    for (std::size_t j = 0; j < columns; ++j) {
      out.names.push_back(fmt::format("{}_{}", v.name, j + 1));
      std::vector<double>& column = out.values.emplace_back(rows);
      for (std::size_t i = 0; i < rows; ++i) {
        column[i] = v.values[transposed ? j + i * v.rows : i + j * v.rows];
      }
    }
  }
  return out;
}

}  // namespace taut::trace
