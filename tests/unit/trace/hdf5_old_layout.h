/// Traces in a format that taut does not write but must read
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::test {

/// Writes a trace like other programs: in HDF5's old layout, which has no checksums. Every value is
/// its row's number.
inline void WriteOldLayout(const std::string& path, std::vector<ChannelInfo> columns,
                           std::size_t rows) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t text = H5Tcopy(H5T_C_S1), scalar = H5Screate(H5S_SCALAR);
  H5Tset_size(text, 10);
  const hid_t format = H5Acreate2(file, "format", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(format, text, "taut trace");
  H5Aclose(format);
  const hid_t version =
      H5Acreate2(file, "format_version", H5T_NATIVE_INT, scalar, H5P_DEFAULT, H5P_DEFAULT);
  const int one = 1;
  H5Awrite(version, H5T_NATIVE_INT, &one);
  H5Aclose(version);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE), links = H5Pcreate(H5P_LINK_CREATE);
  const hsize_t count = rows, chunk = 256;
  H5Pset_chunk(layout, 1, &chunk);
  H5Pset_deflate(layout, 4);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i) values[i] = static_cast<double>(i);
  columns.push_back({"time_s", "s"});
  for (const ChannelInfo& column : columns) {
    const hid_t dataset =
        H5Dcreate2(file, column.name.c_str(), H5T_IEEE_F64LE, space, links, layout, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
  }
  for (const hid_t id : {layout, links}) H5Pclose(id);
  for (const hid_t id : {scalar, space}) H5Sclose(id);
  H5Tclose(text);
  H5Fclose(file);
}

}  // namespace taut::test
