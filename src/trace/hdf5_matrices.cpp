#include "trace/hdf5_matrices.h"

#include <algorithm>

#include "taut/files.h"
#include "trace/hdf5.h"

namespace taut::trace {
namespace {

/// Creates a dataset at `path`, including its groups. Returns null on failure.
Hdf5Id Create(hid_t file, const std::string& path, hid_t type, hid_t space) {
  const Hdf5Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  return {H5Dcreate2(file, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose};
}

bool Put(hid_t file, const std::string& path, std::vector<hsize_t> size, const double* values) {
  const Hdf5Id space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                     H5Sclose);
  const Hdf5Id data = Create(file, path, H5T_IEEE_F64LE, space);
  const bool empty = std::find(size.begin(), size.end(), hsize_t{0}) != size.end();
  if (!data) return false;
  return empty || H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

/// Variable-length strings, which h5py and MATLAB read as text.
bool Put(hid_t file, const std::string& path, const std::vector<std::string>& texts) {
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  if (H5Tset_size(type, H5T_VARIABLE) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0) return false;
  const hsize_t count = texts.size();
  const Hdf5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Id data = Create(file, path, type, space);
  std::vector<const char*> rows;
  for (const std::string& text : texts) rows.push_back(text.c_str());
  if (!data) return false;
  return rows.empty() || H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0;
}

bool Mark(hid_t file, const std::string& name, const std::string& text) {
  const Hdf5Id type = StringType(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute && H5Awrite(attribute, type, text.c_str()) >= 0;
}

bool Mark(hid_t file, const std::string& name, double number) {
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(
      H5Acreate2(file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &number) >= 0;
}

bool Fill(hid_t file, const Hdf5Content& content) {
  bool good = true;
  for (const auto& [name, text] : content.attributes) good = good && Mark(file, name, text);
  for (const auto& [name, number] : content.numbers) good = good && Mark(file, name, number);
  for (const auto& [path, m] : content.matrices) {
    good =
        good && Put(file, path, {static_cast<hsize_t>(m->rows), static_cast<hsize_t>(m->columns)},
                    m->values.data());
  }
  for (const auto& [path, list] : content.lists) {
    good = good && Put(file, path, {list.size()}, list.data());
  }
  for (const auto& [path, texts] : content.texts) good = good && Put(file, path, texts);
  return good;
}

}  // namespace

bool WriteHdf5(const std::string& path, const Hdf5Content& content, Diagnostics& out) {
  NewFile made(path);
  const auto fail = [&](const std::string& why) {
    out.Error("file.not_writable", {path}, "cannot write: " + why);
    return false;
  };
  if (!made.Create()) return fail(made.why());
  {
    const QuietHdf5 quiet;
    Hdf5Id file(H5Fcreate(made.made_at().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                H5Fclose);
    if (!file || !Fill(file, content)) return fail(quiet.why());
    if (!file.Reset()) return fail(quiet.why());
  }
  return made.Publish() || fail(made.why());
}

}  // namespace taut::trace
