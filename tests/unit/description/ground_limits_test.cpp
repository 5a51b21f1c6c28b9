// Size limits of ground files: larger files are rejected before they are parsed.
#include <hdf5.h>

#include <filesystem>

#include "description/assets/height_csv.h"
#include "description/assets/height_image.h"
#include "trace/hdf5_table.h"
#include "unit/description/ground_fixture.h"

namespace taut::test {
namespace {

class GroundLimits : public GroundText {
 protected:
  /// Writes hills.h5 with a dataset /z of this size, without its numbers.
  void WriteEmptyTable(hsize_t rows, hsize_t columns) const {
    const hsize_t size[2] = {rows, columns};
    const hid_t file = H5Fcreate(Path("hills.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(2, size, nullptr);
    const hid_t set =
        H5Dcreate2(file, "z", H5T_NATIVE_UCHAR, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(set), H5Sclose(space), H5Fclose(file);
  }
  std::string SaidOfField(const std::string& keys) {
    return Without(Path(""), Said("- {name: hills, height_field: {cell_m: 0.1, " + keys + "}}"));
  }
};

/// Returns a 16-bit PNG image without its samples.
std::string PngHead(const std::string& columns_and_rows, const std::string& crc) {
  return std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + columns_and_rows +
         std::string("\x10\0\0\0\0", 5) + crc + std::string("\0\0\0\1IDAT", 8);
}

TEST_F(GroundLimits, FilesHaveAGibibyteAtMost) {
  const std::string larger = ": error: the file is larger than 1073 MB (use fewer, larger cells)\n";
  for (const char* const name : {"hills.csv", "hills.png", "hills.h5", "rock.obj", "rock.stl"}) {
    Write(name, "");
    std::filesystem::resize_file(Path(name), (std::size_t{1} << 30) + 1);  // sparse
  }
  EXPECT_EQ(SaidOfField("file: hills.csv"), "hills.csv" + larger);
  EXPECT_EQ(SaidOfField("file: hills.png, height_range_m: [0, 1]"), "hills.png" + larger);
  EXPECT_EQ(SaidOfField("file: 'hills.h5:/z'"),
            "hills.h5: error: the file is larger than 1073 MB (use fewer numbers)\n");
  for (const std::string name : {"rock.obj", "rock.stl"}) {
    const std::string said = Said("- {name: rock, mesh: {scale_m: 1, file: " + name + "}}");
    EXPECT_NE(said.find(name + ": error: the file is larger than 1073 MB"), said.npos) << said;
  }
}

TEST_F(GroundLimits, HeightsInAFileAre100MillionAtMost) {
  Write("hills.png", PngHead(std::string("\0\0\x27\x11\0\0\x27\x10", 8), "\x20\x77\x8a\x86"));
  EXPECT_EQ(SaidOfField("file: hills.png, height_range_m: [0, 1]"),
            "hills.png: error: the image has 10001 x 10000 samples, more than 1e+08 (use fewer, "
            "larger cells)\n");
  WriteEmptyTable(10'001, 10'000);
  EXPECT_EQ(SaidOfField("file: 'hills.h5:/z'"),
            "hills.h5: error: /z has 10001 x 10000 numbers, more than 1e+08\n");
  // Text of 100 million numbers takes too long for a test; a smaller limit works the same way.
  Write("hills.csv", "1,2\n3,4\n5,6\n");
  Diagnostics out;
  trace::TableBudget six(6), five(5);
  const auto table = description::ReadHeightCsv(Path("hills.csv"), six, out);
  ASSERT_TRUE(table) << out.Format();
  EXPECT_EQ(table->height_m, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(table->rows, 3);
  EXPECT_FALSE(description::ReadHeightCsv(Path("hills.csv"), five, out));
  EXPECT_EQ(Without(Path(""), out.Format()),
            "hills.csv:3: error: the file has 6 heights up to this line, more than 5 (use fewer, "
            "larger cells)\n");
}

TEST_F(GroundLimits, AFormulaHas4MillionCornersAtMost) {
  EXPECT_NE(SaidOfField("height_m: 0, columns: 2001, rows: 2000")
                .find("error: a height field by formula can have at most 4 000 000 corners (use "
                      "fewer, larger cells, or a file)\n"),
            std::string::npos);
}

TEST_F(GroundLimits, HeightsOfAnExperimentAre100MillionAtMostInAllItsFields) {
  const std::string formula =
      "- {name: hills, height_field: {cell_m: 0.1, height_m: 0, columns: 1000, rows: 1000}}\n";
  const auto field = [](const std::string& file) {
    return "  - {name: more, height_field: {cell_m: 0.1, file: '" + file + "'}}";
  };
  const auto said = [&](const std::string& terrain) {
    return Without(Path(""), Said(formula + terrain));
  };
  // A file of 10^8 heights alone is below the limit. The image has no samples: nothing is read.
  Write("hills.png", PngHead(std::string("\0\0\x27\x10\0\0\x27\x10", 8), "\xcf\xb5\xe1\xb8"));
  EXPECT_EQ(said("  - {name: more, height_field: {cell_m: 0.1, file: hills.png, "
                 "height_range_m: [0, 1]}}"),
            "hills.png: error: the image has 10000 x 10000 samples and the other height fields "
            "1e+06, together more than 1e+08 (use fewer, larger cells)\n");
  WriteEmptyTable(10'000, 10'000);
  EXPECT_EQ(said(field("hills.h5:/z")),
            "hills.h5: error: /z has 10000 x 10000 numbers and the other height fields 1e+06, "
            "together more than 1e+08\n");
  Write("hills.csv", "1,2\n3,4\n");
  Diagnostics out;
  trace::TableBudget nearly(1e8);
  nearly.Add(1e8 - 3);
  EXPECT_FALSE(description::ReadHeightCsv(Path("hills.csv"), nearly, out));
  EXPECT_EQ(Without(Path(""), out.Format()),
            "hills.csv:2: error: the file has 4 heights up to this line and the other height "
            "fields 1e+08, together more than 1e+08 (use fewer, larger cells)\n");
  std::string formulas;
  for (int i = 0; i < 25; ++i) {
    formulas += std::string(i == 0 ? "" : "  ") + "- {name: hill" + std::to_string(i) +
                ", height_field: {cell_m: 0.1, height_m: 0, columns: 2000, rows: 2000}}\n";
  }
  const std::string more = Said(formulas + "  " + formula);
  EXPECT_NE(more.find("error: this height field has 1e+06 heights and the other height fields "
                      "1e+08, together more than 1e+08 (use fewer, larger cells)"),
            more.npos)
      << more;
}

TEST_F(GroundLimits, PackedFilesOfAnExperimentUnpackTo256MebibytesTogether) {
  // Each of the tables unpacks to 128.3 MiB; none of their numbers is stored.
  WriteEmptyTable(4'100, 4'100);
  const auto field = [](const std::string& name) {
    return "- {name: " + name + ", height_field: {cell_m: 0.1, file: 'hills.h5:/z'}}";
  };
  const std::string said = Said(field("one") + "\n  " + field("two"));
  EXPECT_NE(said.find("hills.h5: error: the file has too high a compression ratio: /z unpacks to "
                      "128 MiB, more than 256 MiB and more than 100 times its size, with the other "
                      "files"),
            said.npos)
      << said;
}

}  // namespace
}  // namespace taut::test
