// HDF5 files that other programs wrote: what taut takes and what it refuses.
#include <hdf5.h>

#include "trace_fixture.h"

namespace taut::test {
namespace {

/// A file as another program might write it; `change` spoils it.
class ForeignHdf5 : public TraceFolder {
 protected:
  std::string Make(const std::string& format, int version) {
    file_ = H5Fcreate(Path("f.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    hid_t scalar = H5Screate(H5S_SCALAR);
    hid_t text = H5Acreate2(file_, "format", type, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const char* value = format.c_str();
    H5Awrite(text, type, &value);
    H5Aclose(text);
    hid_t number =
        H5Acreate2(file_, "format_version", H5T_STD_I64BE, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(number, H5T_NATIVE_INT, &version);
    H5Aclose(number);
    H5Sclose(scalar);
    H5Tclose(type);
    return Path("f.h5");
  }
  template <class T>
  void Dataset(const char* name, hid_t stored, hid_t given, std::vector<T> data, int rank = 1) {
    const hsize_t size[2] = {data.size(), 1};
    hid_t space = H5Screate_simple(rank, size, nullptr);
    hid_t dataset = H5Dcreate2(file_, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data());
    H5Dclose(dataset);
    H5Sclose(space);
  }
  void Times(std::vector<double> times = {0, 1, 2}) {
    Dataset("time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, times);
  }
  hid_t file_ = -1;
};

TEST_F(ForeignHdf5, FloatsIntegersAndTextOfAnyLengthAreFine) {
  const std::string path = Make("taut trace", 1);
  Times();
  Dataset("b_n", H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE, std::vector<double>{0.5, 1.5, 2.5});
  Dataset("a_count", H5T_STD_I16LE, H5T_NATIVE_INT, std::vector<int>{1, 2, 3, 4});
  H5Fclose(file_);
  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  ASSERT_EQ(trace->channels.size(), 2u);
  EXPECT_EQ(trace->channels[0].name, "a_count");
  EXPECT_EQ(trace->values[0], (std::vector<double>{1, 2, 3})) << "the shortest column counts";
  EXPECT_EQ(trace->values[1], (std::vector<double>{0.5, 1.5, 2.5}));
}

TEST_F(ForeignHdf5, WhatIsNotATraceOfThisVersionIsSaidToBeSo) {
  std::string path = Make("photo", 1);
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path),
            "f.h5: error: is HDF5 but not a trace: no attribute \"format\" that says \"taut "
            "trace\"\n");
  path = Make("taut trace", 2);
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path),
            "f.h5: error: has trace format version 2; this taut reads version 1\n");
  path = Make("taut trace", 1);
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path), "f.h5: error: is damaged: has no column /time_s\n");
  path = Make("taut trace", 1);
  Times();
  Dataset("m", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::vector<double>{1, 2, 3}, 2);
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path), "f.h5: error: /m is not a column of numbers\n");
  path = Make("taut trace", 1);
  Times({0, 2, 2, 3});
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path), "f.h5: error: is damaged: time does not rise at row 2\n");
}

TEST_F(ForeignHdf5, ATraceThatClaimsMoreRowsThanItsSizeAllowsIsDamaged) {
  const std::string path = Make("taut trace", 1);
  const hsize_t rows = hsize_t{1} << 40, chunk = 1024;  // 8 TB of nothing
  hid_t space = H5Screate_simple(1, &rows, nullptr);
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  H5Dclose(H5Dcreate2(file_, "time_s", H5T_IEEE_F64LE, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  H5Pclose(layout);
  H5Sclose(space);
  H5Fclose(file_);
  EXPECT_EQ(Complaint(path),
            "f.h5: error: is damaged: claims 1099511627776 rows, more than its size allows\n");
}

}  // namespace
}  // namespace taut::test
