// Fuzz target of height tables in HDF5, with damage, or any bytes.
//
// Input: as for `Damaged`. Bases: doubles in compressed chunks, 16-bit integers in one piece,
// big-endian floats in the new layout, which has checksums. For one input in 16, the table becomes
// ground of an experiment, onto which a rod falls.
#include <hdf5.h>

#include "fuzz/on_ground.h"
#include "trace/hdf5_table.h"

namespace {

using taut::fuzz::Folder;
using taut::fuzz::Must;

/// Returns a file with a table /z of 9 rows and 12 columns of this type.
std::string Table(const std::string& path, hid_t type, bool chunked, bool new_layout) {
  const hsize_t size[2] = {9, 12}, chunk[2] = {4, 5};
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS), plan = H5Pcreate(H5P_DATASET_CREATE);
  if (new_layout) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  if (chunked) {
    H5Pset_chunk(plan, 2, chunk);
    H5Pset_deflate(plan, 4);
  }
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  const hid_t space = H5Screate_simple(2, size, nullptr);
  const hid_t set = H5Dcreate2(file, "z", type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
  std::vector<double> values;
  for (int i = 0; i < 108; ++i) values.push_back(0.1 * (i * i % 7) - 0.6);
  const bool written =
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  H5Dclose(set), H5Sclose(space), H5Fclose(file);
  H5Pclose(plan), H5Pclose(access);
  Must(written, "a table");
  return taut::fuzz::ReadAll(path);
}

std::vector<std::string> Bases(const Folder& folder) {
  const std::string path = folder.Path("base.h5");
  return {Table(path, H5T_IEEE_F64LE, true, false), Table(path, H5T_STD_I16LE, false, false),
          Table(path, H5T_IEEE_F32BE, false, true)};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const std::vector<std::string> bases = Bases(folder);
  if (size == 0) return 0;
  const std::string file = taut::fuzz::Damaged(bases, data, size);
  const std::string path = folder.Write("hills.h5", file.data(), file.size());
  taut::Diagnostics of_table, out;
  taut::trace::TableBudget budget(1e8);
  const auto table = taut::trace::ReadHdf5Table(path, "/z", budget, of_table);
  taut::fuzz::CheckReading(table.has_value(), of_table);
  if (!table) return 0;
  Must(table->values.size() ==
           static_cast<std::size_t>(table->columns) * static_cast<std::size_t>(table->rows),
       "a height for each corner");
  if (!taut::fuzz::OneIn(16, data, size)) return 0;
  const auto read = taut::fuzz::ReadTerrain(
      folder, "{name: g, height_field: {file: 'hills.h5:/z', cell_m: 0.1}}", out);
  if (!read) return 0;
  taut::ModelDef def = taut::fuzz::HeightsOf(*read);
  for (const double height_m : def.height_fields.at(0).height_m)
    Must(std::isfinite(height_m), "a finite height");
  taut::fuzz::DropARod(std::move(def), 5);
  return 0;
}
