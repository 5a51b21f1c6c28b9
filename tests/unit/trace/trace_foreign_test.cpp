// HDF5 files written by other programs: accepted and rejected ones
#include <hdf5.h>
#include <sys/resource.h>
#include <zlib.h>

#include <fstream>

#include "tests/unit/trace/trace_fixture.h"
#include "trace/mat_variables.h"

namespace taut::test {
namespace {

/// A file as written by another program; `change` makes it invalid.
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
  /// Creates a column without numbers.
  hid_t Column(const char* name, hsize_t rows, hid_t layout) {
    hid_t space = H5Screate_simple(1, &rows, nullptr);
    hid_t dataset =
        H5Dcreate2(file_, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    H5Sclose(space);
    columns_.push_back(dataset);
    return dataset;
  }
  void Close() {
    for (const hid_t column : columns_) H5Dclose(column);
    columns_.clear();
    H5Fclose(file_);
  }
  void Times(std::vector<double> times = {0, 1, 2}) {
    Dataset("time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, times);
  }
  hid_t file_ = -1;
  std::vector<hid_t> columns_;
};

TEST_F(ForeignHdf5, FloatsIntegersAndTextOfAnyLengthAreFine) {
  const std::string path = Make("taut trace", 1);
  Times();
  Dataset("b_n", H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE, std::vector<double>{0.5, 1.5, 2.5});
  Dataset("a_count", H5T_STD_I16LE, H5T_NATIVE_INT, std::vector<int>{1, 2, 3});
  Close();
  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  ASSERT_EQ(trace->channels.size(), 2u);
  EXPECT_EQ(trace->channels[0].name, "a_count");
  EXPECT_EQ(trace->values[0], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(trace->values[1], (std::vector<double>{0.5, 1.5, 2.5}));
}

TEST_F(ForeignHdf5, TextsOfMoreThan64MebibytesAreLeftOut) {
  const std::string path = Make("taut trace", 1);
  Times();
  const hid_t type = H5Tcopy(H5T_C_S1), scalar = H5Screate(H5S_SCALAR);
  H5Tset_size(type, H5T_VARIABLE);
  const auto add = [&](const char* name, const std::string& text) {
    const hid_t attribute = H5Acreate2(file_, name, type, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const char* const value = text.c_str();
    H5Awrite(attribute, type, &value);
    H5Aclose(attribute);
  };
  add("large", std::string((64 << 20) + 1, 'x'));
  add("small", "as it is");
  H5Sclose(scalar);
  H5Tclose(type);
  Close();
  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->metadata, (TraceMetadata{{"small", "as it is"}}));
}

TEST_F(ForeignHdf5, WhatIsNotATraceOfThisVersionIsSaidToBeSo) {
  std::string path = Make("photo", 1);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: the file is HDF5 but not a trace: it has no attribute \"format\" with "
            "the value \"taut "
            "trace\"\n");
  path = Make("taut trace", 2);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: the trace has the format version 2; this taut reads version 1\n");
  path = Make("taut trace", 1);
  Close();
  EXPECT_EQ(Complaint(path), "f.h5: error: the trace is damaged: it has no column /time_s\n");
  path = Make("taut trace", 1);
  Times();
  Dataset("m", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::vector<double>{1, 2, 3}, 2);
  Close();
  EXPECT_EQ(Complaint(path), "f.h5: error: /m is not a column of numbers\n");
  path = Make("taut trace", 1);
  Times({0, 2, 2, 3});
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: the trace is damaged: time does not increase at row 2\n");
}

TEST_F(ForeignHdf5, ColumnsOfUnequalLengthAreAnError) {
  const std::string path = Make("taut trace", 1);
  Times();
  Dataset("a", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::vector<double>{1, 2});
  Close();
  EXPECT_EQ(Complaint(path), "f.h5: error: the trace is damaged: a has 2 rows, but time_s has 3\n");
}

TEST_F(ForeignHdf5, NumbersThatWereNeverWrittenAreAnError) {
  // HDF5 would substitute zeros.
  const hsize_t rows = 3000, chunk = 1000;
  for (const bool chunked : {true, false}) {
    const std::string path = Make("taut trace", 1);
    hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    if (chunked) H5Pset_chunk(layout, 1, &chunk);
    Column("time_s", rows, layout);
    H5Pclose(layout);
    Close();
    EXPECT_EQ(Complaint(path),
              "f.h5: error: the trace is damaged: time_s declares 3000 rows, but contains 0\n");
  }
}

TEST_F(ForeignHdf5, OtherFilesAreNotRead) {
  const std::string secret = WriteFile("secret", std::string(24, '\x3f'));
  const hsize_t rows = 3;
  std::string path = Make("taut trace", 1);
  Times();
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(layout, secret.c_str(), 0, 24);
  Column("a", rows, layout);
  H5Pclose(layout);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: /a stores its numbers in another file; a trace must be a single file\n");

  std::filesystem::rename(path, Path("other.h5"));
  path = Make("taut trace", 1);
  Times();
  layout = H5Pcreate(H5P_DATASET_CREATE);
  hid_t space = H5Screate_simple(1, &rows, nullptr);
  H5Pset_virtual(layout, space, Path("other.h5").c_str(), "time_s", space);
  H5Sclose(space);
  Column("a", rows, layout);
  H5Pclose(layout);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: /a is a virtual dataset; a trace must be a single file\n");

  path = Make("taut trace", 1);
  Times();
  H5Lcreate_external("other.h5", "time_s", file_, "a", H5P_DEFAULT, H5P_DEFAULT);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: /a is a link to another file; a trace must be a single file\n");

  path = Make("taut trace", 1);
  Times();
  H5Lcreate_soft("time_s", file_, "again", H5P_DEFAULT, H5P_DEFAULT);
  Close();
  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_TRUE(trace->channels.empty()) << "another name of the same";
}

TEST_F(ForeignHdf5, ATraceThatClaimsMoreRowsThanItsSizeAllowsIsDamaged) {
  const std::string path = Make("taut trace", 1);
  const hsize_t rows = hsize_t{1} << 40, chunk = 1024;  // 8 TB without data
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  Column("time_s", rows, layout);
  H5Pclose(layout);
  Close();
  EXPECT_EQ(Complaint(path),
            "f.h5: error: the trace is damaged or compressed too strongly: its numbers take "
            "8388608 MiB, more than 256 MiB and more than 100 times its size; if this size is "
            "intended, unpack it with `h5repack -f NONE` first\n");
}

TEST_F(ForeignHdf5, AFewPackedBytesDoNotBecomeGigabytes) {
  // 8 MiB of zeros in 8 kB, as often as the limit allows, and once more.
  const hsize_t chunk = 1 << 20;
  const std::vector<double> zeros(chunk);
  uLong packed_bytes = compressBound(chunk * sizeof(double));
  std::vector<Bytef> packed(packed_bytes);
  compress2(packed.data(), &packed_bytes, reinterpret_cast<const Bytef*>(zeros.data()),
            chunk * sizeof(double), 1);
  for (const hsize_t chunks : {31, 32}) {
    const std::string path = Make("taut trace", 1);
    Times();
    hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, 1, &chunk);
    H5Pset_deflate(layout, 1);
    hid_t dataset = Column("a", chunks * chunk, layout);
    for (hsize_t i = 0; i < chunks; ++i) {
      const hsize_t from = i * chunk;
      H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, &from, packed_bytes, packed.data());
    }
    H5Pclose(layout);
    Close();
    // All other checks precede unpacking and follow this check.
    EXPECT_EQ(Complaint(path),
              chunks == 31
                  ? "f.h5: error: the trace is damaged: a has 32505856 rows, but time_s has 3\n"
                  : "f.h5: error: the trace is damaged or compressed too strongly: its numbers "
                    "take 256 MiB, more than 256 MiB and more than 100 times its size; if this "
                    "size is intended, unpack it with `h5repack -f NONE` first\n");
  }
}

TEST_F(ForeignHdf5, LargePackedChunksAreReadWhole) {
  const std::string path = Make("taut trace", 1);
  const hsize_t rows = 150'000, chunk = 100'000;  // larger than a single transfer
  std::vector<double> times(rows);
  for (hsize_t i = 0; i < rows; ++i) times[i] = 0.5 * static_cast<double>(i);
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  H5Pset_deflate(layout, 1);
  H5Dwrite(Column("time_s", rows, layout), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
           times.data());
  H5Pclose(layout);
  Close();
  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->time_s, times);
}

TEST_F(ForeignHdf5, FiltersThatNobodyHasAreNamed) {
  const std::string path = Make("taut trace", 1);
  const hsize_t rows = 10;
  hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &rows);
  H5Pset_filter(layout, 500, H5Z_FLAG_OPTIONAL, 0, nullptr);
  Column("time_s", rows, layout);
  H5Pclose(layout);
  Close();
  EXPECT_EQ(
      Complaint(path),
      "f.h5: error: /time_s is compressed with filter 500 \"\", which this HDF5 library does not "
      "have\n");
}

/// Writes a MATLAB file of version 7.3 with a matrix that occupies no bytes of the file.
std::string MatrixWithoutBytes(const std::string& path, hsize_t rows, hsize_t columns) {
  hid_t create = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(create, 512);  // contains MATLAB's header
  hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create, H5P_DEFAULT);
  const hsize_t size[2] = {columns, rows}, chunk[2] = {1, 1000};
  hid_t space = H5Screate_simple(2, size, nullptr), plan = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(plan, 2, chunk);
  hid_t set = H5Dcreate2(file, "force", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan, H5P_DEFAULT);
  H5Dclose(set), H5Sclose(space), H5Pclose(plan), H5Fclose(file), H5Pclose(create);
  std::fstream header(path, std::ios::in | std::ios::out | std::ios::binary);
  header << "MATLAB 7.3 MAT-file";
  return path;
}

TEST_F(ForeignHdf5, SizesOfMatlabVariablesHaveALimit) {
  const auto error = [&](hsize_t rows, hsize_t columns) {
    Diagnostics found;
    EXPECT_FALSE(trace::ReadMatVariables(MatrixWithoutBytes(Path("f.mat"), rows, columns), found));
    return found.items().empty() ? "" : found.items()[0].what;
  };
  EXPECT_NE(
      error(6000, 6000)
          .find("force unpack to 275 MiB, more than 256 MiB and more than 100 times its size"),
      std::string::npos)
      << error(6000, 6000);
  EXPECT_NE(error(100000, 1000000).find("force have 100000000000 numbers"), std::string::npos)
      << error(100000, 1000000);
}

/// Writes a MATLAB file of version 7.3 with a vector inside `depth` nested structs.
std::string NestedStructs(const std::string& path, int depth) {
  hid_t create = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(create, 512);
  hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create, H5P_DEFAULT);
  hid_t group = H5Gopen2(file, "/", H5P_DEFAULT);
  for (int i = 0; i < depth; ++i) {
    const hid_t inner = H5Gcreate2(group, "s", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
    group = inner;
  }
  // A link back to the outermost struct is entered once.
  if (depth > 0) H5Lcreate_hard(file, "/s", group, "back", H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size[2] = {3, 1};
  const double values[3] = {1, 2, 3};
  hid_t space = H5Screate_simple(2, size, nullptr);
  hid_t set = H5Dcreate2(group, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set), H5Sclose(space), H5Gclose(group), H5Fclose(file), H5Pclose(create);
  std::fstream header(path, std::ios::in | std::ios::out | std::ios::binary);
  header << "MATLAB 7.3 MAT-file";
  return path;
}

/// Returns the processor time of child processes that have ended [s].
double ChildSeconds() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

TEST_F(ForeignHdf5, NestedMatlabStructsAreReadInLinearTime) {
  const std::string path = NestedStructs(Path("f.mat"), 900);
  const double before_s = ChildSeconds();
  Diagnostics found;
  const auto variables = trace::ReadMatVariables(path, found);
  ASSERT_TRUE(variables) << found.Format();
  ASSERT_EQ(variables->size(), 1u);
  EXPECT_EQ((*variables)[0].name.size(), 900 * std::string("s.").size() + 1);
  EXPECT_EQ((*variables)[0].values, (std::vector<double>{1, 2, 3}));
  EXPECT_LT(ChildSeconds() - before_s, 1);  // 0.02 s; opening each by its path takes seconds
}

TEST_F(ForeignHdf5, TheDepthOfMatlabStructsHasALimit) {
  Diagnostics found;
  EXPECT_FALSE(trace::ReadMatVariables(NestedStructs(Path("f.mat"), 2000), found));
  EXPECT_EQ(WithoutFolder(found.Format()), "f.mat: error: more than 1000 groups are nested\n");
}

}  // namespace
}  // namespace taut::test
